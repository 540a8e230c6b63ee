# SPDX-License-Identifier: Apache-2.0
import unittest
from pathlib import Path

from dtof_synth import activity, liberty, sram_model
from dtof_synth.activity import OTHER, STREAMING
from dtof_synth.errors import FlowError
from dtof_synth.library import Library
from dtof_synth.sram_model import Size


def cell(kind: str, inputs: dict[str, list], outputs: dict[str, list]) -> dict:
    return {"type": kind, "parameters": {}, "attributes": {},
            "port_directions": {**dict.fromkeys(inputs, "input"), **dict.fromkeys(outputs, "output")},
            "connections": {**inputs, **outputs}}


def module(ports: dict[str, tuple[str, list[int]]], cells: dict[str, dict], top: str = "0") -> dict:
    return {"attributes": {"top": top}, "cells": cells, "netnames": {},
            "ports": {name: {"direction": direction, "bits": bits} for name, (direction, bits) in ports.items()}}


def design() -> dict:
    """A column of an inverter and an SRAM below an array that has one inverter of its own."""
    column = module({"clk_i": ("input", [2]), "a_i": ("input", [3, 4]), "y_o": ("output", [5])},
                    {"inverter": cell("INV", {"A": [3]}, {"Y": [5]}), "second": cell("INV", {"A": [5]}, {"Y": [6]}),
                     "memory": cell("sram_1rw_160x14", {"clk_i": [2], "en_i": [4], "we_i": [6]}, {"rdata_o": [7]})})
    array = module({"clk_i": ("input", [2]), "go_i": ("input", [3]), "y_o": ("output", [4])},
                   {"g[0].column": cell("column", {"clk_i": [2], "a_i": [3, "1"]}, {"y_o": [8]}),
                    "out": cell("INV", {"A": [8]}, {"Y": [4]})}, "1")
    return {"modules": {"array": array, "column": column}}


def library() -> Library:
    return Library(Path("x"), "x", {"INV": 1.0}, set(), set(), {"INV": {"A": 2.0}}, {}, [], "INV", {}, 1.0, 1.0, 1.1,
                   "", 0.5)


# Time by time: the clock rises with go_i low, falls, go_i rises, the clock rises with go_i high, and so on.
VCD = """$scope module bench $end
$scope module dut $end
$var wire 1 ! clk_i $end
$var wire 1 " go_i $end
$var wire 1 # y_o $end
$var wire 1 $ n8 $end
$scope module p0 $end
$var wire 1 ! clk_i $end
$var wire 2 % a_i [1:0] $end
$var wire 1 $ y_o $end
$var wire 1 & n6 $end
$var wire 1 ' n7 $end
$upscope $end
$upscope $end
$upscope $end
$enddefinitions $end
#0
$dumpvars
0!
0"
x#
1$
b10 %
0&
0'
$end
#1
1!
1#
#2
0!
#3
1"
b11 %
0$
0#
1&
#4
1!
#5
0!
0"
b10 %
1$
1#
0&
#6
1!
"""


def counted(text: str = VCD) -> tuple[dict, activity.Activity]:
    netlist = design()
    activity.name_for_counting(netlist)
    return netlist, activity.count(text.splitlines(), netlist, "bench.dut", lambda ports: ports["go_i"] == 1)


class Names(unittest.TestCase):
    def test_nets_and_instances_have_plain_names(self):
        netlist = design()
        activity.name_for_counting(netlist)
        array, column = netlist["modules"]["array"], netlist["modules"]["column"]
        self.assertEqual(set(array["netnames"]), {"n8"})
        self.assertEqual(set(column["netnames"]), {"n6", "n7"})
        self.assertEqual(list(array["cells"]), ["p0", "out"])
        self.assertEqual(activity.scopes_of(netlist), {"": "array", "p0": "column"})


class Counting(unittest.TestCase):
    def test_phases_and_transitions(self):
        _, found = counted()
        self.assertEqual(found.clocks, {OTHER: 2, STREAMING: 1})
        column = found.scopes["p0"].transitions
        # Up to the rising edge that streams, changes belong to the phase before; the first values are no changes.
        self.assertEqual({bit: number for bit, number in column[OTHER].items() if bit != 2}, {3: 1, 5: 1, 6: 1})
        self.assertEqual({bit: number for bit, number in column[STREAMING].items() if bit != 2}, {3: 1, 5: 1, 6: 1})
        # Out of X is no transition.
        self.assertEqual(found.scopes[""].transitions[OTHER][4], 1)

    def test_accesses(self):
        _, found = counted()
        column = found.scopes["p0"].accesses
        self.assertEqual(column[OTHER], {("p0", "read"): 2})
        self.assertEqual(column[STREAMING], {("p0", "write"): 1})

    def test_energy_by_hand(self):
        netlist, found = counted()
        internal = {("INV", "Y"): 0.25}
        one = activity.energy(found.scopes["p0"], STREAMING, netlist, library(), internal, 3.0)
        # a_i[0] feeds one inverter, y_o the other one, n6 and a_i[1] the macro; the clock is not counted here.
        inverter, macro = 2.0 + 0.5, 3.0 + 0.5
        self.assertAlmostEqual(one.nets, 0.5 * 1.1**2 * (inverter + inverter + macro))
        self.assertAlmostEqual(one.cells, 0.25 * 2)
        self.assertAlmostEqual(one.sram, 1000 * sram_model.macro(Size(1, 160, 14)).write_energy)
        self.assertEqual(one.sram_reads, 0)
        others = activity.energy(found.scopes["p0"], OTHER, netlist, library(), internal, 3.0)
        self.assertAlmostEqual(others.sram_reads, 2000 * sram_model.macro(Size(1, 160, 14)).read_energy)
        self.assertAlmostEqual(others.sram, others.sram_reads)

    def test_a_write_mask_saves_what_it_leaves_alone(self):
        netlist, _ = counted()
        macro_type = netlist["modules"]["column"]["cells"]["p0"]
        macro_type["type"] = "sram_1rw_160x14_7p"
        accesses = {STREAMING: {("p0", "write"): 3, ("p0", "part"): 5, ("p0", "read"): 2}}
        scope = activity.Scope("column", accesses=accesses)
        found = activity.energy(scope, STREAMING, netlist, library(), {}, 3.0)
        macro = sram_model.macro(Size(1, 160, 14, 7))
        self.assertAlmostEqual(found.sram, 1000 * (2 * macro.read_energy + 3 * macro.read_energy
                                                   + 5 / 7 * (macro.write_energy - macro.read_energy)))
        self.assertAlmostEqual(found.sram + found.sram_saved, 1000 * (2 * macro.read_energy + 3 * macro.write_energy))
        self.assertAlmostEqual(found.sram_reads, 2000 * macro.read_energy)

    def test_what_is_behind_a_clock_gate_is_charged_when_it_ticks(self):
        netlist, found = counted(VCD.replace("#6\n1!", "#6\n1!\n1'"))
        column = netlist["modules"]["column"]
        # The net of bit 7 is the gate's now: it rises once, while the array does not stream.
        column["cells"] = {"clock_gate_0": cell("GATE", {"CK": [2], "E": [4]}, {"GCK": [7]}),
                           "register": cell("DFF", {"CK": [7], "D": [3]}, {"Q": [5]})}
        kinds = library()
        kinds.input_ff |= {"GATE": {"CK": 0.9, "E": 1.1}, "DFF": {"CK": 0.8, "D": 1.0}}
        kinds.clock_energy_fj |= {"DFF": 6.0}
        scope = found.scopes["p0"]
        scope.accesses = {}
        one = activity.energy(scope, OTHER, netlist, kinds, {("GATE", "GCK"): 0.7}, 3.0)
        self.assertAlmostEqual(one.gated_clock, 0.7 + 0.5 * (6.0 + (0.8 + 0.5) * 1.1**2))
        self.assertAlmostEqual(activity.energy(scope, STREAMING, netlist, kinds, {("GATE", "GCK"): 0.7}, 3.0).gated_clock, 0)

    def test_rate(self):
        netlist, found = counted()
        self.assertAlmostEqual(activity.toggle_rate(found.scopes["p0"], STREAMING, netlist, 1), 2 / 3)

    def test_a_waveform_of_something_else_is_refused(self):
        with self.assertRaisesRegex(FlowError, "unknown net q9"):
            counted(VCD.replace(" n8 ", " q9 "))
        with self.assertRaisesRegex(FlowError, "there is no bench.dut.clk_i"):
            counted(VCD.replace("module dut", "module other"))


class Tables(unittest.TestCase):
    def test_internal_energy_is_a_mean(self):
        text = """library (x) { cell (INV) { pin (Y) { direction : output;
          internal_power () { rise_power (scalar) { values ("1"); } fall_power (scalar) { values ("3"); } } } } }"""
        self.assertEqual(activity.internal_energies(liberty.parse(text, "x"), 2.0), {("INV", "Y"): 4.0})


if __name__ == "__main__":
    unittest.main()
