# SPDX-License-Identifier: Apache-2.0
import subprocess
import tempfile
import unittest
from pathlib import Path

import fpga_check
from fpga_check import Counts

ROOT = Path(__file__).resolve().parents[2]
STATISTICS = """Number of cells:               1862
     CCU2C                         173
     DP16KD                          3
     LUT4                         1092
     PFUMX                         141
     TRELLIS_DPR16X4                 2
     TRELLIS_FF                    451
"""


def run(technology: Path) -> subprocess.CompletedProcess:
    return subprocess.run([str(ROOT / "scripts/fpga_check.py"), "ezpointer", "--families", "ecp5", "--technology",
                           str(technology)], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)  # fmt: skip


class FpgaCheck(unittest.TestCase):
    def test_cells_are_counted(self):
        self.assertEqual(fpga_check.counted(fpga_check.FAMILIES["ecp5"], STATISTICS), Counts(3, 1092 + 2 * 173, 451, 2))

    def test_names_of_block_rams(self):
        for target, names in {"ice40": ["SB_RAM40_4K", "SB_RAM40_4KNR"], "ecp5": ["DP16KD", "PDPW16KD"],
                              "gowin": ["SP", "SPX9", "DP", "DPX9", "SDP", "SDPX9", "SDPB"],
                              "xilinx": ["RAMB18E1", "RAMB36E1"]}.items():  # fmt: skip
            for name in names:
                with self.subTest(name=name):
                    counts = fpga_check.counted(fpga_check.FAMILIES[target], f"   Number of cells:  7\n   {name}    7\n")
                    self.assertEqual(counts, Counts(7, 0, 0, 0))

    def test_a_memory_that_is_none_is_reported(self):
        memories = ["36 words x 20 bits", "16 words x 14 bits"]
        self.assertEqual(fpga_check.problem(memories, Counts(2, 9, 9, 0)), "")
        self.assertEqual(fpga_check.problem(memories, Counts(1, 9, 9, 0)), "1 block RAMs for 2 memories")
        self.assertEqual(fpga_check.problem(memories, Counts(2, 9, 9, 3)), "3 look-up tables are memory")

    def test_every_read_out_with_rtl_has_its_memories(self):
        subsystems = fpga_check.subsystems()
        for name, (_, parameters) in subsystems.items():
            self.assertIsInstance(parameters["READOUT"], int, name)
        self.assertEqual(subsystems["poolpointer-lean"][1]["GROUP_SIZE"], 8)
        self.assertEqual(sorted(fpga_check.memories(subsystems["ezpointer"][1])),
                         ["16 words x 14 bits", "16 words x 14 bits", "36 words x 21 bits"])

    def test_a_memory_that_is_read_without_a_clock_is_noticed(self):
        with tempfile.TemporaryDirectory() as folder:
            for file in (ROOT / "hdl/technology/fpga").glob("*.sv"):
                text = file.read_text(encoding="utf-8")
                if file.stem == "dtof_sram_1r1w":
                    begin = text.index("  always_ff @(posedge clk_i) begin\n    if (re_i)")
                    text = text[:begin] + "  assign rdata_o = memory[raddr_i];\nendmodule\n"
                (Path(folder) / file.name).write_text(text, encoding="utf-8")
            result = run(Path(folder))
        self.assertEqual(result.returncode, 1)
        self.assertIn("error: ezpointer, ECP5: ERROR: no valid mapping found for memory", result.stdout)


if __name__ == "__main__":
    unittest.main()
