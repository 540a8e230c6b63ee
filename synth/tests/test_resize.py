# SPDX-License-Identifier: Apache-2.0
"""Gates of other drive strengths, and buffers that are not needed: which are grown, which shrunk and which taken out, and that
nothing else changes."""

import re
import tempfile
import unittest
from dataclasses import astuple
from pathlib import Path

from dtof_synth import library, netlist, standard_cells, timing, tools, verilog
from dtof_synth.errors import FlowError, found_in
from dtof_synth.library import Library

from .small_netlists import cell, module

ROOT = Path(__file__).resolve().parents[2]
COPIES = 100
LOADS = 12
CHAIN = 4


def design() -> dict:
    """Two pairs, each a register, an inverter that drives many, one of these in front of a register; of the second pair a chain
    goes on from there to a register outside, so that it has the slowest path."""
    gates = {"start": cell("DFF_X1", {"D": 3, "CK": 2}, {"Q": 5}), "driver": cell("INV_X1", {"A": 5}, {"Y": 6}),
             "end": cell("DFF_X1", {"D": 10, "CK": 2}, {"Q": 4}), "idle": cell("INV_X4", {"A": 4}, {"Y": 7})}
    gates |= {f"load{index}": cell("INV_X1", {"A": 6}, {"Y": 10 + index}) for index in range(LOADS)}
    pair = module({"clk_i": ("input", 2), "a": ("input", 3), "q": ("output", 4), "y": ("output", 10)}, gates)
    chain = {f"chain{index}": cell("INV_X1", {"A": 8 + index}, {"Y": 9 + index}) for index in range(CHAIN)}
    array = module({"clk_i": ("input", 2), "result_tready_i": ("input", 3), "q": ("output", 5)}, {
        "u_pair": cell("a_pair", {"clk_i": 2, "a": 3}, {"q": 4, "y": 6}), "v_pair": cell("a_pair", {"clk_i": 2, "a": 4}, {"q": 5, "y": 8}),
        "last": cell("DFF_X1", {"D": 8 + CHAIN, "CK": 2}, {"Q": 7}), **chain}, top=True)
    return {"modules": {"a_pair": pair, "t": array}}


class Resize(unittest.TestCase):
    scratch: tempfile.TemporaryDirectory[str]
    folder: Path
    library: Library

    @classmethod
    def setUpClass(cls) -> None:
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = Path(cls.scratch.name)
        (cls.folder / "slow.lib").write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
        (cls.folder / "t.sdc").write_text("create_clock -name clk -period $period [get_ports clk_i]\n", encoding="utf-8")
        (cls.folder / "none.sdc").write_text("", encoding="utf-8")
        cls.library = library.read(cls.folder / "slow.lib")

    def sta(self, circuit: dict, period: float, step: str, shrinkable: list | None = None,
            dispensable: list[netlist.Dispensable] | None = None, margins: str = "none.sdc") -> timing.Report:
        (self.folder / "t.v").write_text(verilog.write(circuit), encoding="utf-8")
        tools.write_settings(self.folder / "settings.tcl", {
            "liberty_files": [self.folder / "slow.lib"], "netlist": self.folder / "t.v", "wires": "", "top": "t",
            "wire_load": self.library.wire_load, "constraints": self.folder / "t.sdc", "margins": self.folder / margins,
            "target_period": f"{period}", "steps": [step], "guard": "0.0",
            "blocks": ["a_pair", ["u_pair", "v_pair"], COPIES], "stand_ins": [], "drives": self.library.drives,
            "cell_areas": self.library.area, "shrinkable": shrinkable or [],
            "buffer_pins": ["A", "Y"], "dispensable": [list(astuple(one)) for one in dispensable or []]})
        return timing.Report(tools.run_sta(ROOT / "synth/sta/timing.tcl", self.folder / "settings.tcl",
                                           self.folder / "log", "t"), {})

    def slack(self, circuit: dict, period: float) -> float:
        return float(found_in("OpenSTA", r"^DTOF_MARGIN_SLACK (\S+)", self.sta(circuit, period, "margins").output)[1])

    def test_the_gate_that_makes_a_path_late_grows_in_every_block(self) -> None:
        circuit = design()
        period = 3.0 - self.slack(circuit, 3.0) - 0.05
        self.assertLess(self.slack(circuit, period), 0)
        report = self.sta(circuit, period, "resize")
        self.assertEqual([(kind, gate) for kind, gate, _ in report.resized], [("a_pair", "driver")])
        netlist.resize(circuit, self.library, report.resized)
        drive = circuit["modules"]["a_pair"]["cells"]["driver"]["type"]
        self.assertNotEqual(drive, "INV_X1")
        # What the step says of its result is what the circuit has when it is read anew.
        self.assertGreaterEqual(report.resized_slack, 0)
        self.assertAlmostEqual(report.resized_slack, self.slack(circuit, period), delta=1e-6)
        self.assertAlmostEqual(report.resized_area, COPIES * (self.library.area[drive] - self.library.area["INV_X1"]), delta=1e-6)

    def test_what_no_gate_mends_is_left(self) -> None:
        circuit = design()
        netlist.resize(circuit, self.library, self.sta(circuit, 0.3, "resize").resized)
        self.assertLess(self.slack(circuit, 0.3), 0)

    def test_gates_that_help_only_at_their_first_trial_do_not_hold_the_step_up(self) -> None:
        # OpenSTA's slack drifts: every first trial of a gate shows a gain, every second one none.
        (self.folder / "drift.sdc").write_text("proc worth {gate args} { expr {[incr ::trials($gate)] % 2} }\n", encoding="utf-8")
        report = self.sta(design(), 0.9, "resize", margins="drift.sdc")
        self.assertLess(report.resized_slack, 0)
        self.assertEqual(report.resized, [])

    def test_gates_with_time_to_spare_shrink_and_others_do_not(self) -> None:
        circuit = design()
        netlist.resize(circuit, self.library, [("a_pair", "driver", "INV_X4")])
        met = 3.0 - self.slack(circuit, 3.0)
        pairs = [["a_pair", "idle"], ["a_pair", "driver"]]
        self.assertEqual(self.sta(circuit, met + 0.001, "resize", pairs).resized, [("a_pair", "idle", "INV_X2")])
        self.assertEqual(self.sta(circuit, met + 1.0, "resize", pairs).resized,
                         [("a_pair", "idle", "INV_X2"), ("a_pair", "driver", "INV_X2")])

    def test_what_may_shrink(self) -> None:
        circuit = design()
        gates = circuit["modules"]["a_pair"]["cells"]
        gates["driver"]["type"] = "INV_X2"
        gates[f"{netlist.TREE_PREFIX}1"] = cell("BUF_X4", {"A": 4}, {"Y": 40})
        gates[f"start{netlist.COPY_SUFFIX}1"] = cell("DFF_X2", {"D": 3, "CK": 2}, {"Q": 41})

        def shrinkable(carried: dict | None = None) -> list[tuple[str, str]]:
            return netlist.shrinkable(circuit, self.library, ["a_pair"], self.load, carried)

        self.assertEqual(shrinkable(), [("a_pair", "idle")])
        for index in range(LOADS // 2):
            del gates[f"load{index}"]
        self.assertEqual(shrinkable(), [("a_pair", "idle"), ("a_pair", "driver")])
        # A driver that may have to carry what a buffer carries now keeps its drive.
        self.assertEqual(shrinkable({"a_pair": {6: 1000.0}}), [("a_pair", "idle")])

    def load(self, kind: str, pin: str) -> float:
        return self.library.input_ff.get(kind, {}).get(pin, 0.0)

    def buffered(self) -> tuple[dict, dict]:
        """The design with a buffer in front of all but one of what the driver drives, and the pair's cells."""
        circuit = design()
        gates = circuit["modules"]["a_pair"]["cells"]
        gates["buffer"] = cell("BUF_X2", {"A": 6}, {"Y": 50})
        for index in range(1, LOADS):
            gates[f"load{index}"]["connections"]["A"] = [50]
        return circuit, gates

    def test_a_buffer_that_no_path_needs_is_taken_out(self) -> None:
        circuit, gates = self.buffered()
        found, carried = netlist.dispensable_buffers(circuit, self.library, ["a_pair"], self.load)
        self.assertEqual([(one.kind, one.buffer, one.driver) for one in found], [("a_pair", "buffer", "driver")])
        all_loads = LOADS * (self.load("INV_X1", "A") + self.library.wire_ff_per_sink)
        self.assertAlmostEqual(carried["a_pair"][6], all_loads, places=6)
        # What the driver is without it carries the load, and no weaker drive does.
        for drive, suffices in ((found[0].drive, True), (self.library.smaller.get(found[0].drive), False)):
            if drive is not None:
                self.assertEqual(all_loads <= self.library.max_load_ff[drive]["Y"] * netlist.TREE_LOAD_SHARE, suffices)
        report = self.sta(circuit, 3.0, "resize", dispensable=found)
        self.assertEqual(report.dropped, [("a_pair", "buffer")])
        saved = self.library.area["BUF_X2"] - (self.library.area[found[0].drive] - self.library.area["INV_X1"])
        self.assertAlmostEqual(report.resized_area, -COPIES * saved, delta=1e-6)
        netlist.resize(circuit, self.library, report.resized)
        netlist.drop_buffers(circuit, self.library, report.dropped)
        self.assertNotIn("buffer", gates)
        for index in range(LOADS):
            self.assertEqual(gates[f"load{index}"]["connections"]["A"], [6])
        # What the step says of its result is what the circuit has when it is read anew.
        self.assertAlmostEqual(report.resized_slack, self.slack(circuit, 3.0), delta=1e-6)

    def test_a_buffer_that_keeps_load_from_a_slow_path_stays(self) -> None:
        circuit, gates = self.buffered()
        found, _ = netlist.dispensable_buffers(circuit, self.library, ["a_pair"], self.load)
        met = 3.0 - self.slack(circuit, 3.0)
        report = self.sta(circuit, met + 0.001, "resize", dispensable=found)
        self.assertEqual((report.dropped, report.resized), ([], []))
        self.assertAlmostEqual(report.resized_slack, self.slack(circuit, met + 0.001), delta=1e-6)

    def test_which_buffers_may_go(self) -> None:
        circuit, gates = self.buffered()

        def found() -> list[str]:
            return [one.buffer for one in netlist.dispensable_buffers(circuit, self.library, ["a_pair"], self.load)[0]]

        gates[f"{netlist.TREE_PREFIX}1"] = cell("BUF_X1", {"A": 4}, {"Y": 60})
        gates[f"{netlist.HOLD_PREFIX}1"] = cell("BUF_X1", {"A": 4}, {"Y": 61})
        gates["behind_port"] = cell("BUF_X1", {"A": 3}, {"Y": 62})
        self.assertEqual(found(), ["buffer"])
        # The second of two is looked at only where the first has to stay.
        gates["second"] = cell("BUF_X1", {"A": 50}, {"Y": 63})
        gates["behind_behind_port"] = cell("BUF_X1", {"A": 62}, {"Y": 64})
        self.assertEqual(found(), ["buffer", "behind_behind_port"])
        # What no drive of the driver could carry needs its buffer.
        gates |= {f"heavy{index}": cell("INV_X16", {"A": 50}, {"Y": 100 + index}) for index in range(40)}
        self.assertEqual(found(), ["behind_behind_port"])

    def test_buffers_in_a_row_are_taken_out(self) -> None:
        circuit, gates = self.buffered()
        gates["second"] = cell("BUF_X1", {"A": 50}, {"Y": 63})
        gates["load1"]["connections"]["A"] = [63]
        netlist.drop_buffers(circuit, self.library, [("a_pair", "buffer"), ("a_pair", "second")])
        self.assertEqual({gates[f"load{index}"]["connections"]["A"][0] for index in range(LOADS)}, {6})

    def test_another_function_is_refused(self) -> None:
        with self.assertRaisesRegex(FlowError, "driver is a INV_X1 and cannot be resized to NAND2_X1"):
            netlist.resize(design(), self.library, [("a_pair", "driver", "NAND2_X1")])

    def test_drives_are_of_one_function(self) -> None:
        families = {tuple(family) for family in self.library.drives}
        self.assertIn(("NAND2_X1", "NAND2_X2", "NAND2_X4"), families)
        self.assertIn(("DFFR_X1", "DFFR_X2"), families)
        # A cell whose name says that it is a larger NAND2, but which is none.
        text = standard_cells.library(standard_cells.SLOW)
        wrong = re.sub(r'(cell *\(NAND2_X4\).*?function *: *)"[^"]*"', r'\1"(A1 * A2)"', text, count=1, flags=re.DOTALL)
        self.assertNotEqual(text, wrong)
        (self.folder / "wrong.lib").write_text(wrong, encoding="utf-8")
        self.assertIn(["NAND2_X1", "NAND2_X2"], library.read(self.folder / "wrong.lib").drives)


if __name__ == "__main__":
    unittest.main()
