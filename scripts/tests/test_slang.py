# SPDX-License-Identifier: Apache-2.0
"""slang, where it is installed, refuses what other tools take."""

import shutil
import tempfile
import unittest
from pathlib import Path

import slang

ROOT = Path(__file__).resolve().parents[2]


@unittest.skipUnless(slang.is_installed(), "slang is not installed: make lint-slang installs it")
class Slang(unittest.TestCase):
    def refused(self, file: str, *changes: tuple[str, str]) -> list[str]:
        with tempfile.TemporaryDirectory() as folder:
            hdl = Path(folder) / "hdl"
            shutil.copytree(ROOT / "hdl", hdl)
            text = (hdl / file).read_text(encoding="utf-8")
            for old, new in changes:
                self.assertEqual(text.count(old), 1, old)
                text = text.replace(old, new)
            (hdl / file).write_text(text, encoding="utf-8")
            return slang.read("dtof_subsystem", slang.TOPS["dtof_subsystem"], hdl)

    def test_a_name_before_its_declaration(self):
        last = "  assign result_tvalid_o = array_tvalid && !waits_i;\n"
        failures = self.refused("subsystem/dtof_gated_array.sv", ("logic array_clk, array_busy, ", "logic array_clk, "),
                                (last, f"{last}  logic array_busy;\n"))  # fmt: skip
        self.assertTrue(any("dtof_gated_array.sv" in line and "'array_busy'" in line for line in failures), failures)

    def test_a_macro_of_another_files_include(self):
        failures = self.refused("thesis/dtof_array.sv", ('`include "dtof_readout_range.svh"\n', ""))
        self.assertTrue(any("dtof_array.sv" in line and "DTOF_READOUT_RANGE" in line for line in failures), failures)


if __name__ == "__main__":
    unittest.main()
