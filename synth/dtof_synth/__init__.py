# SPDX-License-Identifier: Apache-2.0
"""Synthesis, timing, power and area of the named configurations (docs/reference/synthesis.md)."""
