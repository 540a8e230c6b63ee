# SPDX-License-Identifier: Apache-2.0
"""Gates of other drive strengths: which are grown and which shrunk, and that only the drive changes."""

import re
import tempfile
import unittest
from pathlib import Path

from dtof_synth import library, netlist, standard_cells, timing, tools, verilog
from dtof_synth.errors import FlowError

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
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = Path(cls.scratch.name)
        (cls.folder / "slow.lib").write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
        (cls.folder / "t.sdc").write_text("create_clock -name clk -period $period [get_ports clk_i]\n", encoding="utf-8")
        (cls.folder / "none.sdc").write_text("", encoding="utf-8")
        cls.library = library.read(cls.folder / "slow.lib")

    def sta(self, circuit: dict, period: float, step: str, shrinkable: list | None = None) -> timing.Report:
        (self.folder / "t.v").write_text(verilog.write(circuit), encoding="utf-8")
        tools.write_settings(self.folder / "settings.tcl", {
            "liberty_files": [self.folder / "slow.lib"], "netlist": self.folder / "t.v", "wires": "", "top": "t",
            "wire_load": self.library.wire_load, "constraints": self.folder / "t.sdc", "margins": self.folder / "none.sdc",
            "target_period": f"{period}", "steps": [step], "tight": "0", "guard": "0.0",
            "blocks": ["a_pair", ["u_pair", "v_pair"], COPIES], "drives": self.library.drives,
            "cell_areas": self.library.area, "shrinkable": shrinkable or []})
        return timing.Report(tools.run_sta(ROOT / "synth/sta/timing.tcl", self.folder / "settings.tcl",
                                           self.folder / "log", "t"), {})

    def slack(self, circuit: dict, period: float) -> float:
        return float(re.search(r"^DTOF_MARGIN_SLACK (\S+)", self.sta(circuit, period, "margins").output, re.MULTILINE).group(1))

    def test_the_gate_that_makes_a_path_late_grows_in_every_block(self):
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

    def test_what_no_gate_mends_is_left(self):
        circuit = design()
        netlist.resize(circuit, self.library, self.sta(circuit, 0.3, "resize").resized)
        self.assertLess(self.slack(circuit, 0.3), 0)

    def test_gates_with_time_to_spare_shrink_and_others_do_not(self):
        circuit = design()
        netlist.resize(circuit, self.library, [("a_pair", "driver", "INV_X4")])
        met = 3.0 - self.slack(circuit, 3.0)
        pairs = [["a_pair", "idle"], ["a_pair", "driver"]]
        self.assertEqual(self.sta(circuit, met + 0.001, "resize", pairs).resized, [("a_pair", "idle", "INV_X2")])
        self.assertEqual(self.sta(circuit, met + 1.0, "resize", pairs).resized,
                         [("a_pair", "idle", "INV_X2"), ("a_pair", "driver", "INV_X2")])

    def test_what_may_shrink(self):
        circuit = design()
        gates = circuit["modules"]["a_pair"]["cells"]
        gates["driver"]["type"] = "INV_X2"
        gates[f"{netlist.TREE_PREFIX}1"] = cell("BUF_X4", {"A": 4}, {"Y": 40})
        gates[f"start{netlist.COPY_SUFFIX}1"] = cell("DFF_X2", {"D": 3, "CK": 2}, {"Q": 41})

        def load(kind: str, pin: str) -> float:
            return self.library.input_ff[kind].get(pin, 0.0)

        self.assertEqual(netlist.shrinkable(circuit, self.library, ["a_pair"], load), [("a_pair", "idle")])
        for index in range(LOADS // 2):
            del gates[f"load{index}"]
        self.assertEqual(netlist.shrinkable(circuit, self.library, ["a_pair"], load), [("a_pair", "idle"), ("a_pair", "driver")])

    def test_another_function_is_refused(self):
        with self.assertRaisesRegex(FlowError, "driver is a INV_X1 and cannot be resized to NAND2_X1"):
            netlist.resize(design(), self.library, [("a_pair", "driver", "NAND2_X1")])

    def test_drives_are_of_one_function(self):
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
