# SPDX-License-Identifier: Apache-2.0
"""Mutants of the RTL, the C++ models and the synthesis flow, and which of them the tests kill (`make mutate`)."""
