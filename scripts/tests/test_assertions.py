# SPDX-License-Identifier: Apache-2.0
"""The concurrent assertions and covers of hdl/assertions in the example's bench: a good frame meets the covers, planted faults of a source, a
master and an array are reported with the side that is at fault."""

import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HDL = ROOT / "hdl"
BENCH = "examples/example_bench.sv"
GATED_ARRAY = "hdl/subsystem/dtof_gated_array.sv"
# What the bench does while its frame runs, so that a cover that stays at 0 is a mistake of the cover.
UNOPTIMISED = ("-MAKEFLAGS", "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0")  # compiling takes longer than running
MET = {"c_write", "c_read", "c_frame", "c_acquisition", "c_at_once", "c_held_up", "c_in_a_row", "c_pause", "c_last"}


def planted(text: str, find: str, replacement: str) -> str:
    found, count = re.subn(find, replacement, text)
    if count < 1:
        raise AssertionError(f"'{find}' is no more in the source")
    return found


class Assertions(unittest.TestCase):
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        """One simulation, whose faults are switched on by arguments."""
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = Path(scratch.name)
        bench = (ROOT / BENCH).read_text(encoding="utf-8")
        bench = planted(bench, r"while \(!line_ready\) @\(negedge clk\);",
                        'while (!line_ready) begin @(negedge clk); if ($test$plusargs("fault_data")) line = ~line; end')
        bench = planted(bench, r"#0\.1 penable = 1'b1;",
                        '#0.1 penable = !$test$plusargs("fault_setup"); if ($test$plusargs("fault_address")) paddr[2] = !paddr[2];')
        bench = planted(bench, r"#0\.1 psel = 1'b1;", '#0.1 psel = 1; penable = $test$plusargs("fault_no_setup");')
        (cls.folder / "bench.sv").write_text(bench, encoding="utf-8")
        gated = planted((ROOT / GATED_ARRAY).read_text(encoding="utf-8"), r"(\.tdc_valid_i\s*)\(([^)]*)\)", r"\1(\2 && !fault_gap)")
        # A signal of its own: Verilator 5.032 takes no $time in an expression at a port.
        gated = planted(gated, r"\n( *logic [^;]*\barray_tvalid\b[^;]*;)", r"""\n\1
  logic fault_side_band = 0;
  always_ff @(posedge clk_i) fault_side_band <= $test$plusargs("fault_side_band") && $time > 5000;
  logic fault_gap;
  always_ff @(posedge clk_i) fault_gap <= $test$plusargs("fault_gap") && $time > 5000 && ($time / 3) % 101 == 0;""")
        gated = planted(gated, r"(\.sram_cfg_i\s*)\(sram_cfg_i\)(,\s*\.sram_cfg_o\s*\(sram_cfg_o\))",
                            r"\1(sram_cfg_i ^ {dtof_pkg::SRAM_CFG_WIDTH{fault_side_band}})\2")
        (cls.folder / "gated_array.sv").write_text(gated, encoding="utf-8")
        files = [str(cls.folder / "gated_array.sv") if line.endswith("/dtof_gated_array.sv") else line
                 for line in (HDL / "dtof.f").read_text(encoding="utf-8").splitlines() if line.endswith(".sv") and not line.startswith("//")]
        built = subprocess.run(
            ["verilator", "--cc", "--exe", "--build", "--timing", "--assert", "--coverage-user", "-Wno-fatal", *UNOPTIMISED,
             "--timescale", "1ns/1ps", "--Mdir", cls.folder / "build", "-f", "dtof_lint.f", "+incdir+common", *files, "-f", "dtof_assertions.f", cls.folder / "bench.sv",
             ROOT / "examples/assertions_main.cpp", "--top-module", "example_bench"],
            cwd=HDL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if built.returncode != 0:
            raise AssertionError(built.stdout[-3000:])

    def simulate(self, *arguments: str) -> tuple[str, dict[str, int]]:
        """What the simulation says, and how often each cover was met, by its name and whose it is."""
        coverage = self.folder / "coverage.dat"
        coverage.unlink(missing_ok=True)
        done = subprocess.run([self.folder / "build" / "Vexample_bench", *arguments, coverage], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, check=False)
        text = coverage.read_text(encoding="utf-8", errors="replace") if coverage.exists() else ""
        found = re.findall(r"\x01o\x02(c_\w+)\x01h\x02\S*?\.(\w+)\.c_\w+' (\d+)", text)
        return done.stdout, {f"{whose}.{name}": int(count) for name, whose, count in found}

    def test_a_good_frame_meets_the_covers(self) -> None:
        said, covers = self.simulate()
        self.assertIn("PASS", said)
        self.assertNotIn("Error", said)
        self.assertEqual({name.split(".")[0] for name in covers},
                         {"u_register_protocol", "u_array_protocol", "u_result_protocol", "u_line_protocol"})
        missed = {name for name, count in covers.items() if count == 0 and name.split(".")[1] in MET} - {"u_register_protocol.c_in_a_row"}
        self.assertEqual(missed, set())

    def test_planted_faults_are_reported_with_the_side_that_is_at_fault(self) -> None:
        for fault, says in (("fault_data", "the source of lines changed tdata or tlast before tready"),
                            ("fault_setup", "the master's setup has no access behind it"),
                            ("fault_address", "the master changed the address, the direction or the strobes within a transfer"),
                            ("fault_no_setup", "the master's access has no setup in front of it"),
                            ("fault_gap", "the source left a gap inside an acquisition"),
                            ("fault_side_band", "sram_cfg_i changed during a frame")):
            with self.subTest(fault=fault):
                said, _ = self.simulate(f"+{fault}")
                self.assertIn(says, said)
                self.assertNotIn("PASS", said)


RESET_BENCH = """
`timescale 1ns/1ps
module reset_bench;
  logic clk_tdc = 0, clk = 0, rst_tdc_n = 0, rst_n = 0;
  always #1 clk_tdc = !clk_tdc;
  always #5 clk = !clk;
  dtof_async_line_fifo #(.WIDTH(4), .DEPTH(2)) u_fifo (
      .clk_tdc_i(clk_tdc), .rst_tdc_ni(rst_tdc_n), .s_tvalid_i(1'b0), .s_tready_o(), .s_tdata_i('0), .s_tlast_i(1'b0),
      .clk_i(clk), .rst_ni(rst_n), .m_tvalid_o(), .m_tready_i(1'b1), .m_tdata_o(), .m_tlast_o());
  initial begin
    #42 rst_tdc_n = 1;
    rst_n = 1;
    #40 rst_tdc_n = $test$plusargs("fault_tdc_reset") ? 0 : 1;  // three clocks of the other side
    #30 rst_tdc_n = 1;
    #40 rst_n = $test$plusargs("fault_readout_reset") ? 0 : 1;
    #6 rst_n = 1;
    #40 {rst_n, rst_tdc_n} = 0;
    #40 {rst_n, rst_tdc_n} = 3;  // four clocks of the slower side
    #40 $display("PASS");
    $finish;
  end
endmodule
"""


class ResetLength(unittest.TestCase):
    def test_a_reset_that_is_too_short_is_reported_with_its_side(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "bench.sv").write_text(RESET_BENCH, encoding="utf-8")
            built = subprocess.run(["verilator", "--binary", "--assert", "-Wno-fatal", *UNOPTIMISED, "--timescale", "1ns/1ps", "--Mdir", folder / "build",
                                    "-f", "dtof_lint.f", "-f", "dtof.f", "-f", "dtof_assertions.f", folder / "bench.sv", "--top-module", "reset_bench"],
                                   cwd=HDL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
            self.assertEqual(built.returncode, 0, built.stdout[-3000:])
            for fault, says in (("", ""), ("fault_tdc_reset", "the reset of the TDC side lasted fewer than 4 clocks of the other side"),
                                ("fault_readout_reset", "the reset of the read-out side lasted fewer than 4 clocks of the other side")):
                with self.subTest(fault=fault):
                    said = subprocess.run([folder / "build" / "Vreset_bench", f"+{fault}"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                          text=True, check=False).stdout
                    self.assertIn(says, said)
                    self.assertEqual("PASS" in said, not fault, said)


if __name__ == "__main__":
    unittest.main()
