# SPDX-License-Identifier: Apache-2.0
"""Measured figures: where they are kept, what they depend on, and the pages that quote them (docs/reference/figures.md)."""
