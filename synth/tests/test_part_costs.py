# SPDX-License-Identifier: Apache-2.0
"""Parts are found under the names that the waveform has, and by the names of their instances."""

import unittest

from dtof_synth import activity, part_costs


def module(**cells: str) -> dict:
    return {"attributes": {}, "ports": {}, "netnames": {},
            "cells": {name: {"type": kind, "connections": {}, "port_directions": {}} for name, kind in cells.items()}}


def design() -> dict:
    """An array of a pair, in which an SRAM stands before a column of two parts, and an engine with a part of the same kind."""
    return {"modules": {
        "array": module(u_gate="INV", **{"g[0].u_quad": "dtof_pool_quad", "g[0].u_engine": "dtof_pool_engine"}) | {"attributes": {"top": "1"}},
        "dtof_pool_quad": module(u_sram="sram_1rw_4x4", u_rest="INV", **{"g_column[0].u_column": "column"}),
        "column": module(u_match="match", u_distance="distance", u_own="INV"),
        "dtof_pool_engine": module(u_match="match"), "match": module(u_a="INV"), "distance": module(u_b="INV")}}


class PartCosts(unittest.TestCase):
    def test_every_scope_below_the_top_is_a_part(self):
        found = part_costs._instances(design())
        self.assertEqual(found, {"p0": ("quad", ""), "p0.p1": ("quad", "u_column"), "p0.p1.p0": ("quad", "u_match"),
                                 "p0.p1.p1": ("quad", "u_distance"), "p1": ("engine", ""), "p1.p0": ("engine", "u_match")})

    def test_the_counting_has_the_same_scopes(self):
        counted = design()
        activity.name_for_counting(counted)
        self.assertEqual(set(activity.scopes_of(counted)) - {""}, set(part_costs._instances(design())))


if __name__ == "__main__":
    unittest.main()
