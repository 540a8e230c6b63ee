# SPDX-License-Identifier: Apache-2.0
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MODULE = (ROOT / "hdl/subsystem/dtof_reset_synchroniser.sv").read_text(encoding="utf-8")
# A clock of 10 units that rises at 5, 15, ...; the reset rises and falls beside its edges.
BENCH = """
module bench;
  logic clk = 1'b0, rst_n = 1'b1, scan_mode = 1'b0;
  wire released;
  dtof_reset_synchroniser u_reset (.clk_i(clk), .rst_ni(rst_n), .scan_mode_i(scan_mode), .rst_no(released));
  always @(released) $display("%0d %b", $time, released);
  initial begin
    #1 rst_n = 1'b0;
    #12 rst_n = 1'b1;     // 13, before the edge at 15
    #30 rst_n = 1'b0;     // 43, between edges
    #1 rst_n = 1'b1;      // 44, before the edge at 45
    #20 rst_n = 1'b0;     // 64
    #2 scan_mode = 1'b1;
    #1 rst_n = 1'b1;      // 67, without an edge
    #2 rst_n = 1'b0;      // 69
    #1 $finish;
  end
  always #5 clk = !clk;
endmodule
"""


def seen(module: str) -> list[str]:
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "bench.sv"
        source.write_text(module + BENCH, encoding="utf-8")
        subprocess.run(["iverilog", "-g2012", "-s", "bench", "-o", f"{folder}/bench.vvp", str(source)], check=True)
        return subprocess.run(["vvp", "-n", f"{folder}/bench.vvp"], check=True, capture_output=True, text=True).stdout.split("\n")


def changes(module: str) -> list[str]:
    return [line for line in seen(module) if line.endswith((" 0", " 1"))]


EXPECTED = ["1 0", "25 1", "43 0", "55 1", "64 0", "67 1", "69 0"]


class ResetSynchroniser(unittest.TestCase):
    def test_it_falls_at_once_and_rises_at_the_second_edge(self):
        self.assertEqual(changes(MODULE), EXPECTED)

    def test_what_is_wrong_is_seen(self):
        for old, new in ((" or negedge rst_ni", ""), ("scan_mode_i ? rst_ni : ", ""), ("released_q[1];", "released_q[0];")):
            with self.subTest(old=old):
                self.assertEqual(MODULE.count(old), 1)
                self.assertNotEqual(changes(MODULE.replace(old, new)), EXPECTED)


if __name__ == "__main__":
    unittest.main()
