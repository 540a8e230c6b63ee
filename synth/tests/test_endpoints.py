# SPDX-License-Identifier: Apache-2.0
"""Numbers of path ends, and constant pins, in a netlist of a few cells."""

import unittest

from dtof_synth import endpoints
from dtof_synth.endpoints import Endpoints
from dtof_synth.errors import FlowError
from dtof_synth.library import Library

from .partial import part_of
from .small_netlists import cell, module

LIBRARY = part_of(Library, tie={"low": ("TIE0", "Y"), "high": ("TIE1", "Y")}, area={"TIE0": 1.0, "AND": 1.0, "BUF": 1.0, "DFF": 2.0},
                  sequential={"DFF"}, latches={"LATCH"}, checked={"DFF": {"D"}})


def design() -> dict:
    """Two columns, each with a register and one-port SRAM; the array has a register and a word of two bits at its port."""
    sram = cell("sram_1rw_4x2", {"clk_i": 2, "en_i": 4, "we_i": "0"}, {"q_o": 7})
    sram["connections"]["addr_i"], sram["port_directions"]["addr_i"] = [4, "1"], "input"
    column = module({"clk_i": ("input", 2), "on_i": ("input", 3), "low_i": ("input", 5)},
                    {"r": cell("DFF", {"CK": 2, "D": 3}, {"Q": 4}), "mem": sram, "b": cell("BUF", {"A": 5}, {"Y": 6}),
                     "late": cell("DFF", {"CK": 2, "D": 6}, {"Q": 8})})
    top = module({"clk_i": ("input", 2), "q_o": ("output", 10)}, {
        "tie": cell("TIE0", {}, {"Y": 20}), "r": cell("DFF", {"CK": 2, "D": 30}, {"Q": 10}), "one": cell("TIE1", {}, {"Y": 21}),
        "and": cell("AND", {"A": 20, "B": 21}, {"Y": 22}), "half": cell("AND", {"A": 20, "B": 10}, {"Y": 23}),
        **{f"c{index}": cell("a_column", {"clk_i": 2, "on_i": 10, "low_i": 22}, {}) for index in range(2)}}, top=True)
    top["ports"]["word_o"] = {"direction": "output", "bits": [20, 10], "offset": 3}
    return {"modules": {"array": top, "a_column": column, "sram_1rw_4x2": {"attributes": {}, "ports": {}, "cells": {}}}}


class Numbers(unittest.TestCase):
    def test_every_checked_pin_of_every_instance_and_every_output_is_an_end(self) -> None:
        # A column: two registers, and en_i, we_i and two address bits of the SRAM. The array: a register, q_o, and word_o's two bits.
        self.assertEqual(endpoints.count(design(), LIBRARY), 2 * (2 + 4) + 1 + 1 + 2)

    def test_what_is_constant(self) -> None:
        constants = endpoints._Constants(design(), LIBRARY)
        for name, constant in (("c0/mem/we_i", True), ("c1/mem/addr_i[1]", True), ("c1/mem/addr_i[0]", False), ("c0/mem/en_i", False),
                               ("c0/late/D", True), ("c0/r/D", False), ("word_o[3]", True), ("word_o[4]", False), ("q_o", False),
                               ("and/A", True), ("half/B", False)):
            self.assertEqual(constants.has(name), constant, name)

    def test_each_reason_is_counted(self) -> None:
        warnings = {"unconstrained endpoints": ["c0/late/D", "c1/late/D", "sram_cfg_o[2]", "c0/r/D"]}
        self.assertEqual(endpoints.judge("t", warnings, design(), LIBRARY, ["c0/r/D"]), Endpoints(15, 12, 2, 1))

    def test_a_warning_without_a_reason_stops_the_flow_and_names_five_pins(self) -> None:
        pins = [f"p{index}/D" for index in range(6)]
        for number, end in ((5, "p4/D$"), (6, "p4/D and others$")):
            with self.assertRaisesRegex(FlowError, f"t: OpenSTA warns of {number} unclocked pins: p0/D, p1/D, p2/D, p3/D, {end}"):
                endpoints.judge("t", {"unclocked pins": pins[:number]}, design(), LIBRARY, [])
        with self.assertRaisesRegex(FlowError, "warns of 1 combinational loops"):
            endpoints.judge("t", {"combinational loops": []}, design(), LIBRARY, [])


if __name__ == "__main__":
    unittest.main()
