# SPDX-License-Identifier: Apache-2.0
"""The rules of scripts/lint_rtl.py find what they are there for."""

import importlib.util
import unittest
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
_spec = importlib.util.spec_from_file_location("lint_rtl", ROOT / "scripts" / "lint_rtl.py")
assert _spec is not None and _spec.loader is not None
lint_rtl = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(lint_rtl)


class MisreadTest(unittest.TestCase):
    def test_parameters_set_to_unsized_ones_are_refused(self) -> None:
        for text in ("  localparam logic [BIN_WIDTH-1:0] LAST = '1;", "module m #(\n  parameter bit [3:0] P = '1,\n",
                     "localparam L\n    = '1;"):
            self.assertEqual(len(lint_rtl.check_misread({"hdl/m.sv": text})), 1, text)

    def test_the_place_is_named(self) -> None:
        self.assertIn("hdl/m.sv:3:", lint_rtl.check_misread({"hdl/m.sv": "\n\nlocalparam L = '1;"})[0])

    def test_unsized_ones_elsewhere_are_fine(self) -> None:
        text = "localparam logic [3:0] L = {4{1'b1}};\nassign a = '1;\nif (b != '1) begin\n  localparam M = 1'b1;\n"
        self.assertEqual(lint_rtl.check_misread({"hdl/m.sv": text}), [])


class NettypeTest(unittest.TestCase):
    GOOD = "// What it is.\n\n// verilator lint_off TIMESCALEMOD\n`default_nettype none\n\nmodule m;\nendmodule\n\n`default_nettype wire\n"

    def test_what_stands_around_modules(self) -> None:
        self.assertEqual(lint_rtl.check_nettype({"hdl/m.sv": self.GOOD}), [])
        for wrong in (self.GOOD.replace("`default_nettype none\n", ""), self.GOOD.replace("`default_nettype wire\n", ""),
                      self.GOOD.replace("// verilator lint_off TIMESCALEMOD\n", ""), "module first;\nendmodule\n" + self.GOOD,
                      self.GOOD + "module last;\nendmodule\n", "`timescale 1ns/1ps\n" + self.GOOD):
            self.assertEqual(len(lint_rtl.check_nettype({"hdl/m.sv": wrong})), 1, wrong)


class IcarusTest(unittest.TestCase):
    def test_sorry_lines_are_failures(self) -> None:
        self.assertEqual(len(lint_rtl.sorry("a.sv:3: sorry: constant selects are not supported\nother line")), 1)


class BlockRamTest(unittest.TestCase):
    def test_a_memory_that_cannot_be_a_block_ram_is_seen(self) -> None:
        """The same count on a register file of two words finds no block RAM."""
        found, cells = lint_rtl.block_rams("ecp5", "dtof_sram_1r1w", 2, 4)
        self.assertEqual(found, 0)
        self.assertTrue(cells)


class QuickTest(unittest.TestCase):
    """A quick run reads what a full run reads, each by fewer tools."""

    def read(self, quick: bool) -> dict[str, tuple]:
        """The tools that read each array and subsystem."""
        found: dict[str, tuple] = {}

        def check_read(what: str, top: str, parameters: dict[str, int], tools: tuple = lint_rtl.TOOLS) -> list[str]:
            found[f"{what} {parameters}"] = tools
            return []

        with mock.patch.object(lint_rtl, "check_read", check_read):
            for configuration in lint_rtl.load(ROOT / "configurations.toml").values():
                lint_rtl.check_configuration(configuration, quick)
            for top, settings, sentence in lint_rtl.parameter_limits():
                if not sentence:
                    lint_rtl.check_limit(top, settings, sentence, quick)
            for readout in lint_rtl.subsystem_numbers():
                lint_rtl.check_subsystem(readout, quick)
        return found

    def test_everything_is_read_by_some_tool(self) -> None:
        whole, quick = self.read(False), self.read(True)
        self.assertEqual(whole.keys(), quick.keys())
        self.assertEqual(set(whole.values()), {lint_rtl.TOOLS})
        self.assertTrue(all(quick.values()), quick)
        for what, tools in quick.items():  # what no build verilates
            if what.startswith("configuration pool") or (what.startswith("the legal") and "1024" not in what):
                self.assertIn(lint_rtl.verilator, tools, what)


if __name__ == "__main__":
    unittest.main()
