# SPDX-License-Identifier: Apache-2.0
"""The table of slacks with margins, and what the margins do to a circuit whose delay is known."""

import re
import tempfile
import unittest
from pathlib import Path

from dtof_synth import configuration, library, netlist, report, run, standard_cells, timing, tools
from dtof_synth.errors import found_in
from dtof_synth.netlist import Counts
from dtof_synth.power import ClockTree
from dtof_synth.run import Margin, Result
from dtof_synth.timing import TimedPath

ROOT = Path(__file__).resolve().parents[2]
PERIOD_NS = 3.0
NONE = Counts(0, 0, 0.0, 0, 0.0, 0.0, 0.0)


def slacks(text: str) -> tuple[float, float]:
    """Setup and hold, as synth/sta/timing.tcl prints them."""
    found = re.search(r"^DTOF_MARGIN_SLACK (\S+) (\S+)", text, re.MULTILINE)
    assert found is not None
    return float(found.group(1)), float(found.group(2))


class Margins(unittest.TestCase):
    def test_a_negative_slack_anywhere_is_not_met(self) -> None:
        chosen = configuration.load(ROOT / "configurations.toml")["ezpointer"]
        good = Margin(0.2, 0.1, 0.3, "a", "b")

        def verdict(slow: Margin, fast: Margin) -> str:
            result = Result(chosen, NONE, NONE, NONE, ClockTree(1, 1.0, 0.0), 0.8, 2.0, {},
                            margins={"slow": slow, "fast": fast})
            return report._margin_section([result])[-1]

        self.assertIn("| yes | yes | yes |", verdict(good, good))
        for bad, said in ((Margin(-0.001, 0.1, 0.3, "a", "b"), "| **no** | yes | yes |"),
                          (Margin(0.2, -0.001, 0.3, "a", "b"), "| yes | **no** | yes |"),
                          (Margin(0.2, 0.1, -0.001, "a", "b"), "| yes | yes | **no** |")):
            self.assertIn(said, verdict(bad, good))
            self.assertIn(said, verdict(good, bad))

    def test_a_buffer_delays_the_early_path_and_not_the_tight_one(self) -> None:
        # A register reaches a gate directly and through a chain; the gate's output is the end of both ways. Delaying that
        # end would make the late way later.
        stages = 60
        nets = [f"n{index}" for index in range(stages + 1)]
        gates = "".join(f"  INV_X1 i{index} (.A({a}), .Y({b}));\n" for index, (a, b) in enumerate(zip(nets, nets[1:])))
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            liberty = folder / "slow.lib"
            liberty.write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
            (folder / "fork.v").write_text(
                f"module fork_and_join (clk_i, result_tready_i);\n  input clk_i; input result_tready_i;\n"
                f"  wire q, d, {', '.join(nets)};\n"
                f"  DFF_X1 a (.D(result_tready_i), .CK(clk_i), .Q({nets[0]}));\n{gates}"
                f"  NAND2_X1 g (.A1({nets[-1]}), .A2({nets[0]}), .Y(d));\n"
                f"  DFF_X1 b (.D(d), .CK(clk_i), .Q(q));\nendmodule\n", encoding="utf-8")
            (folder / "dtof.sdc").write_text(
                "create_clock -name clk -period $period [get_ports clk_i]\nset_clock_uncertainty -hold 0.5 [get_clocks clk]\n",
                encoding="utf-8")
            (folder / "none.sdc").write_text("", encoding="utf-8")
            tools.write_settings(folder / "settings.tcl", {
                "liberty_files": [liberty], "netlist": folder / "fork.v", "wires": "", "top": "fork_and_join",
                "wire_load": library.read(liberty).wire_load, "constraints": folder / "dtof.sdc",
                "margins": folder / "none.sdc", "target_period": f"{PERIOD_NS}", "steps": ["margins", "early", "spare"],
                "slew": "0.028", "load": "10", "pins": ["i0/A", f"i{stages - 1}/A", "g/A1", "g/A2", "b/D"]})
            output = tools.run_sta(ROOT / "synth/sta/timing.tcl", folder / "settings.tcl", folder / "log", "fork_and_join")
        found = timing.Report(output, {})
        _, hold_slack = slacks(output)
        self.assertIn(TimedPath(["g/A2", "b/D"], round(hold_slack, 4)), found.early)
        setup_slack, _ = slacks(output)
        for pin in ("i0/A", f"i{stages - 1}/A", "g/A1", "b/D"):
            self.assertAlmostEqual(found.spare[pin], setup_slack, places=3)
        self.assertGreater(found.spare["g/A2"], setup_slack + 3 * run.HOLD_BUFFER_SLOW_NS)
        design = {"modules": {"fork_and_join": {"attributes": {"top": "1"}, "cells": {}}}}
        spare = {netlist.local_pin(design, pin): slack for pin, slack in found.spare.items()}
        self.assertEqual(run._last_free_pin([("", "g", "A2"), ("", "b", "D")], spare, 3), ("", "g", "A2"))
        self.assertEqual(run._last_free_pin([("", "g", "A1"), ("", "b", "D")], spare, 3), ("", "g", "A1"))

    def test_buffers_go_where_their_delay_is_to_spare(self) -> None:
        early, join, end = ("", "a", "D"), ("", "g", "A"), ("", "b", "D")
        one = run.HOLD_BUFFER_SLOW_NS
        plenty = 9 * one
        for spare, buffers, chosen in (({early: plenty, join: plenty, end: plenty}, 5, end),
                                       ({early: plenty, join: plenty, end: 1.5 * one}, 1, end),
                                       ({early: plenty, join: plenty, end: 1.5 * one}, 2, join),
                                       ({early: one, join: 2 * one, end: 0.0}, 3, join),
                                       ({early: 2 * one, end: one}, 2, early)):  # of `join` nothing is known
            self.assertEqual(run._last_free_pin([early, join, end], spare, buffers), chosen)

    def test_derate_and_uncertainty_cost_what_they_should(self) -> None:
        # A chain between two flip-flops: the margins take 5 % of what arrives late and 0.05 ns more of uncertainty; hold
        # loses 5 % of the shortest path.
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            liberty = folder / "slow.lib"
            liberty.write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
            nets = [f"n{index}" for index in range(13)]
            gates = "".join(f"  INV_X1 i{index} (.A({a}), .Y({b}));\n" for index, (a, b) in enumerate(zip(nets, nets[1:])))
            (folder / "chain.v").write_text(
                f"module chain (clk_i, result_tready_i);\n  input clk_i; input result_tready_i;\n  wire q, {', '.join(nets)};\n"
                f"  DFF_X1 a (.D(result_tready_i), .CK(clk_i), .Q({nets[0]}));\n{gates}"
                f"  DFF_X1 b (.D({nets[-1]}), .CK(clk_i), .Q(q));\nendmodule\n", encoding="utf-8")
            (folder / "dtof.sdc").write_text(
                "create_clock -name clk -period $period [get_ports clk_i]\nset_clock_uncertainty -setup 0.10 [get_clocks clk]\n"
                "set_clock_uncertainty -hold 0.05 [get_clocks clk]\n", encoding="utf-8")
            (folder / "none.sdc").write_text("", encoding="utf-8")

            def timed(margins: Path) -> tuple[float, float, float]:
                tools.write_settings(folder / "settings.tcl", {
                    "liberty_files": [liberty], "netlist": folder / "chain.v", "wires": "", "top": "chain",
                    "wire_load": library.read(liberty).wire_load, "constraints": folder / "dtof.sdc", "margins": margins,
                    "target_period": f"{PERIOD_NS}", "steps": ["margins"], "slew": "0.028", "load": "10"})
                output = tools.run_sta(ROOT / "synth/sta/timing.tcl", folder / "settings.tcl", folder / "log", "chain")
                arrival = float(found_in("OpenSTA", r"^ +([0-9.]+) +data arrival time", output.split("DTOF_MARGIN_PATH_MAX")[1])[1])
                return *slacks(output), arrival

            setup, hold, arrival = timed(folder / "none.sdc")
            tight_setup, tight_hold, late_arrival = timed(ROOT / "constraints/margins.sdc")
        self.assertGreater(arrival, 0.5)
        self.assertAlmostEqual(late_arrival, 1.05 * arrival, delta=0.002)
        # The derates change setup and hold times of cells, too, by 5 % of some hundredths of a nanosecond.
        self.assertAlmostEqual(setup - tight_setup, 0.05 + 0.05 * arrival, delta=0.02)
        self.assertAlmostEqual(hold - tight_hold, 0.05 * (hold + 0.05), delta=0.02)


if __name__ == "__main__":
    unittest.main()
