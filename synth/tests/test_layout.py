# SPDX-License-Identifier: Apache-2.0
"""The layout's figures from what its tools write, and that what they complain about is a failure. Needs none of the tools."""

import io
import tempfile
import unittest
from collections import Counter
from pathlib import Path
from unittest import mock

from dtof_synth import resizing
from dtof_synth.errors import FlowError
from dtof_synth.layout import block, command, flow, picture, pins, repair, report, results, tools, wires
from dtof_synth.run import OtherWires

ROUTED = """Progress: Stage 2 total routes completed: 5507
Failed net routes: 2
*** Running stage3 routing with options mask none
Final: No failed routes!
"""
UNROUTED = """Final: Failed net routes: 2
List of failed nets follows:
 clk_i
 sram_rdata_o_0

----------------------------------------------
"""
CLEAN = "Extracting t into t.ext:\nDTOF_DRC 0\n   Writing cell t\nDTOF_MAGIC_OK\n"
BROKEN = CLEAN.replace("DTOF_DRC 0\n", "DTOF_DRC 2\nDTOF_BOX 1190 548 1194 552 Metal1 area < 20 (Mosis #+++)\n"
                       "DTOF_BOX 10 20 14 24 Metal2 spacing < 3 (Mosis #7.2)\n")
MATCH = "Circuit 1 contains 446 devices, Circuit 2 contains 446 devices.\nResult: Circuits match uniquely.\nLVS Done.\n"
MISMATCH = MATCH.replace("Circuits match uniquely.", "Netlists do not match.")
DEF = """UNITS DISTANCE MICRONS 100 ;
DIEAREA ( 0 -300 ) ( 16000 700 ) ;
COMPONENTS 3 ;
- INVX1_1 INVX1 + PLACED ( 4000 50 ) FS ;
- INVX1_2 INVX1 + PLACED ( 12000 50 ) N ;
- FILL_0_0_1 FILL + PLACED ( 15920 50 ) S ;
END COMPONENTS
PINS 4 ;
- vdd + NET vdd
  + LAYER metal6 ( -80 -40 ) ( 80 40 )
  + PLACED ( 8000 -260 ) N ;
- a + NET a
  + LAYER metal2 ( -15 -15 ) ( 15 15 )
  + PLACED ( 16080 9500 ) N ;
- sram_q_0 + NET sram_q_0
  + LAYER metal2 ( -15 -15 ) ( 15 15 )
  + PLACED ( 4400 -200 ) N ;
- y + NET y
  + LAYER metal3 ( -15 -15 ) ( 15 15 )
  + PLACED ( 4400 600 ) N ;
END PINS
NETS 2 ;
- sram_q_0
  ( INVX1_1 A )
+ ROUTED metal2 ( 4400 -200 ) ( * 300 ) M3_M2
  NEW metal3 ( 4400 300 ) ( 4800 * ) ( * 400 ) ;
- y
  ( INVX1_2 Y )
+ ROUTED metal2 ( 12000 600 ) ( * 700 ) M2_M1
  NEW metal1 ( 11920 5500 ) M2_M1
  NEW metal2 ( 12000 700 ) ( 12100 * ) ;
END NETS
"""
MODULE = {
    "ports": {"clk_i": {"direction": "input", "bits": [2]}, "a_i": {"direction": "input", "bits": [3, 4]},
              "q_o": {"direction": "output", "bits": [6]}, "same_o": {"direction": "output", "bits": [6]},
              "through_o": {"direction": "output", "bits": [4]}},
    "cells": {
        "u_gate": {"type": "NAND2", "port_directions": {"A": "input", "B": "input", "Y": "output"},
                   "connections": {"A": [3], "B": ["1"], "Y": [5]}},
        "u_register": {"type": "DFF", "port_directions": {"D": "input", "CLK": "input", "Q": "output"},
                       "connections": {"D": [7], "CLK": [2], "Q": [6]}},
        "u_sram": {"type": "sram", "port_directions": {"clk_i": "input", "addr_i": "input", "d_o": "output"},
                   "connections": {"clk_i": [2], "addr_i": [5, 4], "d_o": [7]}},
    }}


def library():
    found = mock.Mock()
    found.area = {"NAND2": 2.0, "DFF": 5.0}
    found.input_ff = {"NAND2": {"A": 1, "B": 1}, "DFF": {"D": 1, "CLK": 1}}
    found.max_load_ff = {"NAND2": {"Y": 9}, "DFF": {"Q": 9}}
    return found


class Parsers(unittest.TestCase):
    def test_router(self) -> None:
        self.assertEqual(results.failed_nets(ROUTED), [])
        self.assertEqual(results.failed_nets(UNROUTED), ["clk_i", "sram_rdata_o_0"])
        with self.assertRaisesRegex(FlowError, "did not come to its end"):
            results.failed_nets("Progress: Stage 2 total routes completed: 5507\n")

    def test_design_rules(self) -> None:
        self.assertEqual(results.violations(CLEAN).total, 0)
        found = results.violations(BROKEN)
        self.assertEqual(found.total, 2)
        self.assertEqual(found.boxes["Metal1 area < 20 (Mosis #+++)"], [(119.0, 54.8, 119.4, 55.2)])
        for unfinished in (CLEAN.replace("DTOF_MAGIC_OK", "DTOF_MAGIC_FAILED no such cell"), ""):
            with self.assertRaisesRegex(FlowError, "end of its script"):
                results.violations(unfinished)

    def test_comparison(self) -> None:
        self.assertEqual(results.lvs_verdict(MATCH), results.UNIQUE)
        self.assertNotEqual(results.lvs_verdict(MISMATCH), results.UNIQUE)
        self.assertNotEqual(results.lvs_verdict(MATCH.replace("uniquely", "with 2 symmetries")), results.UNIQUE)
        with self.assertRaisesRegex(FlowError, "no result"):
            results.lvs_verdict("Reading netlist file t.spice\n")

    def test_routed_def(self) -> None:
        layout = results.read_def(DEF)
        self.assertEqual(layout.die, (0.0, -3.0, 160.0, 7.0))
        self.assertEqual(layout.cells["INVX1_2"], ("INVX1", 120.0, 0.5))
        self.assertAlmostEqual(layout.length("sram_q_0"), 5 + 4 + 1)
        self.assertAlmostEqual(layout.length("y"), 1 + 1)
        with self.assertRaisesRegex(FlowError, "no cells"):
            results.read_def(DEF.replace("PLACED", "UNPLACED"))

    def test_arrivals(self) -> None:
        output = ("DTOF_BARE\nEndpoint  Delay  Delay   Slack\nDFF_1/D (DFF)  49.8  2.1  47.7000 (MET)\n"
                  "q_o (output)  50.0  52.0  -2.0000 (VIOLATED)\nDTOF_END\n")
        found = results.arrivals(output, "DTOF_BARE", 50.0)
        self.assertAlmostEqual(found.longest, 52.0)
        self.assertAlmostEqual(found.mean, (52.0 + 2.3) / 2)
        self.assertEqual(found.end, "q_o")
        with self.assertRaisesRegex(FlowError, "no paths"):
            results.arrivals(output, "DTOF_ROUTED", 50.0)

    def test_a_net_in_which_the_router_lost_its_way(self) -> None:
        text = "n1 1 U_1/Y 1 ( 2.4 0.1 U_2/A )\nn2 1 U_1/Y 1 ( 2.4 0.1 ERROR , ( 1.0 0.1 U_3/A ) )\n"
        self.assertEqual(list(results.read_trees(text)), ["n1"])
        column = block.from_module("column", MODULE, library(), {"sram"})
        tree = results.Tree("NAND2_1/Y", [results.Branch(2.0, 0.1, ["sram_addr_i_0"])])
        spef = wires.spef(column, library(), {"sram_addr_i_0": tree}, {"sram_addr_i_0": 4.0, "q_o": 6.0})
        # All of its capacitance at the end of 3 ohm, for the other net has 2 ohm of 4 fF.
        for line in ("*D_NET q_o 6", "*I DFF_1:Q O", "*P q_o O", "1 q_o:1 6", "1 DFF_1:Q q_o:1 3"):
            self.assertIn(f"{line}\n", spef)

    def test_a_net_without_a_description_beside_one_with_a_fork(self) -> None:
        column = block.from_module("column", MODULE, library(), {"sram"})
        tree = results.Tree("NAND2_1/Y", [results.Branch(2.0, 0.1, [], [results.Branch(4.0, 0.1, ["sram_addr_i_0"])])])
        spef = wires.spef(column, library(), {"sram_addr_i_0": tree}, {"sram_addr_i_0": 4.0, "q_o": 6.0})
        self.assertIn("1 DFF_1:Q q_o:1 9\n", spef)  # (2 + 4) ohm of 4 fF, and the net has 6 fF

    def test_a_net_of_thousands_of_pieces(self) -> None:
        deep = 5000
        trees = results.read_trees("n1 1 U_1/Y 1 " + "( 1.0 0.1 " * deep + "U_2/A" + " )" * deep + "\n")
        branch, pieces = trees["n1"].branches[0], 1
        while branch.branches:
            branch, pieces = branch.branches[0], pieces + 1
        self.assertEqual((pieces, branch.pins), (deep, ["U_2/A"]))

    def test_resistances(self) -> None:
        trees = results.read_trees("n1 1 U_1/Y 2 ( 2.4 0.1 U_2/A , ( 1.5 0.3 PIN/q_o ) ) \n")
        branch = trees["n1"].branches[0]
        self.assertEqual((trees["n1"].driver, branch.ohm, branch.pins), ("U_1/Y", 2.4, ["U_2/A"]))
        self.assertEqual((branch.branches[0].weight, branch.branches[0].pins), (0.3, ["q_o"]))
        with self.assertRaisesRegex(FlowError, "line 2"):
            results.read_trees("n1 1 U_1/Y 1 ( 2.4 0.1 U_2/A )\nn2 1 U_1/Y 1 ( 2.4 0.1 U_2/A\n")


class Failures(unittest.TestCase):
    """What a step finds ends the flow with one sentence."""

    def project(self, checks: list[str], verdict: str) -> mock.Mock:
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        routed = Path(self.temporary.name) / "t.def"
        routed.write_text(DEF, encoding="utf-8")
        project = mock.Mock()
        project.block.name = "column"
        project.path.return_value = routed
        project.check.side_effect = [results.violations(check) for check in checks]
        project.compare.return_value = results.lvs_verdict(verdict)
        return project

    def test_clean(self) -> None:
        self.assertEqual(flow._checked(self.project([CLEAN], MATCH), Path()), (0, 0, results.UNIQUE))

    def test_lone_via_is_removed(self) -> None:
        self.assertEqual(flow._checked(self.project([BROKEN, CLEAN], MATCH), Path()), (1, 0, results.UNIQUE))
        self.assertNotIn("11920 5500", (Path(self.temporary.name) / "t.def").read_text(encoding="utf-8"))

    def test_design_rule_errors(self) -> None:
        with self.assertRaisesRegex(FlowError, "2 design rule errors.*Metal2 spacing"):
            flow._checked(self.project([BROKEN, BROKEN], MATCH), Path())

    def test_mismatch(self) -> None:
        with self.assertRaisesRegex(FlowError, "layout and netlist differ: Netlists do not match"):
            flow._checked(self.project([CLEAN], MISMATCH), Path())

    def test_failed_net(self) -> None:
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(flow, "Project") as project:
            project.return_value.route.return_value = results.failed_nets(UNROUTED)
            part = mock.Mock()
            part.name = "column"
            said: list[str] = []
            with self.assertRaisesRegex(FlowError, "2 nets could not be routed, clk_i"):
                flow._sound_layout(Path(folder) / "qflow", part, tools.Cells(), 0.6, Path(), {}, said.append)
            self.assertEqual(project.call_args.args[-2:], (flow.SEEDS[-1], 0.6))
            self.assertEqual(project.return_value.place.call_count, len(flow.SEEDS))
            self.assertEqual(len(said), len(flow.SEEDS) - 1)
            project.return_value.route.side_effect = [["clk_i"], []]
            with mock.patch.object(flow, "_checked", return_value=(0, 0, results.UNIQUE)):
                self.assertEqual(flow._sound_layout(Path(folder) / "qflow", part, tools.Cells(), None, Path(), {}, said.append)[1], flow.SEEDS[1])

    def test_a_net_that_the_router_left_open_asks_for_another_placement(self) -> None:
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(flow, "Project") as project:
            project.return_value = self.project([CLEAN, CLEAN], MATCH)
            project.return_value.route.return_value = []
            project.return_value.compare.side_effect = [results.lvs_verdict(MISMATCH), results.lvs_verdict(MATCH)]
            said: list[str] = []
            made, seed, found = flow._sound_layout(Path(folder) / "qflow", mock.Mock(), tools.Cells(), None, Path(), {}, said.append)
        self.assertEqual((made, seed, found), (project.return_value, flow.SEEDS[1], (0, 0, results.UNIQUE)))
        self.assertEqual(len(said), 1)
        self.assertIn("layout and netlist differ: Netlists do not match", said[0])

    def test_exit_status(self) -> None:
        with mock.patch.object(command, "_run", side_effect=FlowError("column: 2 nets could not be routed")), \
                mock.patch("sys.argv", ["layout.py"]), mock.patch("sys.stderr", io.StringIO()) as said:
            self.assertEqual(command.main(), 1)
        self.assertEqual(said.getvalue(), "error: column: 2 nets could not be routed\n")


class Blocks(unittest.TestCase):
    def setUp(self) -> None:
        self.block = block.from_module("column", MODULE, library(), {"sram"})

    def test_ports(self) -> None:
        """One port a net, none without a cell's pin; the SRAM's pins are ports, its clock is the column's."""
        self.assertEqual(self.block.ports, {"clk_i": "input", "a_i_0": "input", "q_o": "output", "sram_addr_i_0": "output",
                                            "sram_d_o": "input"})
        self.assertEqual(self.block.sram_ports, ["sram_addr_i_0", "sram_d_o"])

    def test_cells(self) -> None:
        gate, register = self.block.cells
        self.assertEqual((gate.name, gate.pins), ("NAND2_1", {"A": "a_i_0", "B": "vdd", "Y": "sram_addr_i_0"}))
        self.assertEqual(register.pins, {"D": "sram_d_o", "CLK": "clk_i", "Q": "q_o"})
        self.assertEqual(self.block.sinks(library()), Counter(a_i_0=1, vdd=1, sram_d_o=1, clk_i=1, q_o=1, sram_addr_i_0=1))
        with self.assertRaisesRegex(FlowError, "does not have: sram"):
            block.from_module("column", MODULE, library(), set())

    def test_no_brackets(self) -> None:
        """Post-route timing needs scalar names."""
        for text in (block.blif(self.block), block.verilog(self.block)):
            self.assertNotIn("[", text)
            self.assertIn("NAND2", text)

    def test_density_is_qflow_s_setting(self) -> None:
        for density, said in ((None, ""), (0.6, "set initial_density=0.6\n")):
            with tempfile.TemporaryDirectory() as temporary:
                folder = Path(temporary)
                (folder / "t.par").write_text("random.seed : 1\n", encoding="utf-8")
                tools.Project(folder / "qflow", self.block, tools.Cells(folder, "t"), 7, density)
                self.assertEqual((folder / "qflow" / "project_vars.sh").read_text(encoding="utf-8"), said)
                self.assertIn("random.seed : 7", (folder / "qflow" / "layout" / "column.par").read_text(encoding="utf-8"))

    def test_reference(self) -> None:
        orders = block.pin_orders(".subckt NAND2 A B gnd Y vdd\n.ends\n.subckt DFF CLK D gnd Q vdd\n.ends\n")
        self.assertIn("XNAND2_1 a_i_0 vdd gnd sram_addr_i_0 vdd NAND2\n", block.spice(self.block, orders))
        with self.assertRaisesRegex(FlowError, "the layout's DFF does not have the pins"):
            block.spice(self.block, {**orders, "DFF": ["CLK", "D", "Q", "vdd"]})


class Pins(unittest.TestCase):
    def test_order_and_room(self) -> None:
        self.assertEqual(pins.spread([(90.0, "b"), (10.0, "a"), (95.0, "c")], [0, 20, 40, 60, 80, 100]),
                         {"a": 20, "b": 80, "c": 100})
        self.assertEqual(pins.spread([(500.0, "a"), (500.0, "b")], [0, 20]), {"a": 0, "b": 20})

    def test_edges(self) -> None:
        column = block.Block("t", [block.Cell("INVX1_1", "INVX1", {"A": "sram_q_0", "Y": "n1"}, ""),
                                   block.Cell("INVX1_2", "INVX1", {"A": "a", "Y": "y"}, "")],
                             {"sram_q_0": "input", "a": "input", "y": "output"}, ["sram_q_0"])
        arranged = pins.arrange(DEF, column)
        self.assertNotIn("LAYER metal3", arranged)
        found = results.read_def(arranged).pins
        self.assertEqual(found["sram_q_0"], (41.6, -2.0))
        self.assertEqual({found[name][1] for name in ("a", "y")}, {95.0})
        self.assertEqual(found["vdd"], (80.0, -2.6))
        with self.assertRaisesRegex(FlowError, "do not fit"):
            pins._slots(0, 1000, [], 20)


class Wires(unittest.TestCase):
    LEF = ("LAYER metal2\n  TYPE ROUTING ;\n  WIDTH 0.3 ;\n  CAPACITANCE\tCPERSQDIST 2e-05 ;\n  EDGECAPACITANCE 6e-05 ;\n"
           "END metal2\nMACRO INVX1\n  CLASS CORE ;\n  SIZE 1.6 BY 10.0 ;\nEND INVX1\n")

    def test_capacitance_of_a_layer(self) -> None:
        self.assertAlmostEqual(wires.layer_ff_per_um(self.LEF)["metal2"], 0.126)
        with self.assertRaisesRegex(FlowError, "no routing layer"):
            wires.layer_ff_per_um("VERSION 5.4 ;\n")

    def test_cell_sizes(self) -> None:
        self.assertEqual(picture.cell_sizes(self.LEF), {"INVX1": (1.6, 10.0)})

    def test_parasitics(self) -> None:
        column = block.from_module("column", MODULE, library(), {"sram"})
        trees = results.read_trees("sram_addr_i_0 1 NAND2_1/Y 1 ( 2.0 0.1 PIN/sram_addr_i_0 )\n")
        text = wires.spef(column, library(), trees, {"sram_addr_i_0": 4.0})
        for line in ("*D_NET sram_addr_i_0 4", "*I NAND2_1:Y O", "*P sram_addr_i_0 O", "1 sram_addr_i_0:1 4",
                     "1 NAND2_1:Y sram_addr_i_0:1 2"):
            self.assertIn(f"{line}\n", text)

    def test_lone_vias(self) -> None:
        text, number = repair.mend_lone_vias(DEF, results.violations(BROKEN).boxes)
        self.assertEqual((number, len(DEF.splitlines()) - len(text.splitlines())), (1, 1))
        self.assertEqual(repair.mend_lone_vias(DEF, {"Metal2 area < 20": [(119.0, 54.8, 119.4, 55.2)]}), (DEF, 0))

    def test_a_lone_via_at_the_wrong_end_of_a_path(self) -> None:
        at_the_end: dict[str, list[tuple[float, ...]]] = {"Metal1 area < 20": [(119.8, 6.8, 120.2, 7.2)]}
        text, number = repair.mend_lone_vias(DEF, at_the_end)
        self.assertEqual((text, number), (DEF.replace("( 12000 600 ) ( * 700 ) M2_M1", "( 12000 700 ) ( 12000 600 ) M2_M1"), 1))
        # Neither the beginning of that path, nor another layer's, nor what is not there.
        for box in ((119.8, 5.8, 120.2, 6.2), (43.8, 2.8, 44.2, 3.2), (1.0, 1.0, 1.4, 1.4)):
            self.assertEqual(repair.mend_lone_vias(DEF, {"Metal1 area < 20": [box]}), (DEF, 0))


class Report(unittest.TestCase):
    def test_an_array_that_is_not_resized_has_no_figures_of_resizing(self) -> None:
        self.assertEqual(report._resized(OtherWires(0.1, -resizing.HOPELESS_NS, 0.02, 0.0005)), ["+0.020", "0.0005"])
        self.assertEqual(report._resized(OtherWires(-0.2, -resizing.HOPELESS_NS - 0.001, -0.401, 0.0)), ["-", "-"])


if __name__ == "__main__":
    unittest.main()
