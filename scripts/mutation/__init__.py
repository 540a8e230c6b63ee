# SPDX-License-Identifier: Apache-2.0
"""Mutants of the RTL and of the C++ models, and which of them the tests kill (`make mutate`)."""
