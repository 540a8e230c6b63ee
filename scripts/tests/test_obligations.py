# SPDX-License-Identifier: Apache-2.0
"""The integrator's obligations name assertions, flags and files that exist."""

import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "user" / "integration.md"
ROW = re.compile(r"^\| (\d+) \| .+ \| (.+) \|$", re.MULTILINE)


def rows(text: str) -> list[tuple[int, str]]:
    """(number, what reports a broken obligation)."""
    return [(int(number), notices) for number, notices in ROW.findall(text.split("## What an integrator owes\n", 1)[1])]


def problems(text: str, assertions: set[str], flags: set[str]) -> list[str]:
    found = []
    for number, notices in rows(text):
        named = set(re.findall(r"`(a_\w+)`", notices)) - assertions
        named |= {flag for flag in re.findall(r"`ERROR\.(\w+)`", notices) if flag not in flags}
        found += [f"{number}: '{name}' does not exist" for name in sorted(named)]
        if "`" not in notices and "tool" not in notices:
            found.append(f"{number}: nothing is named that notices it")
    return found


def assertions() -> set[str]:
    text = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "hdl").rglob("*.sv"))
    return set(re.findall(r"`DTOF_ASSERT\((a_\w+),", text)) | protocol_assertions()


def protocol_assertions() -> set[str]:
    """Those of hdl/dtof_assertions.f; test_assertions breaks them."""
    text = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "hdl/assertions").glob("*.sv"))
    return set(re.findall(r"^ +(a_\w+) :$", text, re.MULTILINE))


def flags() -> set[str]:
    return set(re.findall(r"\bERROR_(\w+)_LSB\b", (ROOT / "hdl/subsystem/dtof_registers_pkg.sv").read_text(encoding="utf-8")))


class Obligations(unittest.TestCase):
    def test_they_are_numbered_and_name_what_exists(self) -> None:
        text = PAGE.read_text(encoding="utf-8")
        self.assertEqual([number for number, _ in rows(text)], list(range(1, len(rows(text)) + 1)))
        self.assertGreaterEqual(len(rows(text)), 12)
        self.assertEqual(problems(text, assertions(), flags()), [])

    def test_a_name_that_does_not_exist_is_found(self) -> None:
        text = "## What an integrator owes\n| 1 | x | `a_gone`; `ERROR.GONE` |\n| 2 | x | a look |\n| 3 | x | nothing: it is lost |\n"
        self.assertEqual(problems(text, {"a_there"}, {"THERE"}),
                         ["1: 'GONE' does not exist", "1: 'a_gone' does not exist", "2: nothing is named that notices it",
                          "3: nothing is named that notices it"])


BENCH = """
`timescale 1ns/1ps
module breaches;
  bit clk = 0, rst_n = 0, start = 0, valid = 0, late = 0;
  always #1 clk = !clk;
  wire array_ready;
  reg  array_valid = 0;
  dtof_array #(.NP(4), .NB(2), .SRAM_NUM(2), .PIXELS_PER_SRAM(2), .COUNT_WIDTH(4)) u_array (
      .clk_i(clk), .rst_ni(rst_n), .sram_cfg_i('0), .start_i(start), .acq_num_i(16'd4), .gate_begin_i('0), .gate_end_i('0), .raw_i(1'b0),
      .raw_first_row_i('0), .raw_last_row_i('0), .tdc_valid_i(array_valid), .tdc_ready_o(array_ready), .tdc_timestamp_i('1), .result_tready_i(1'b1));
  dtof_pool_pointer_array #(.SRAM_NUM(2), .PIXELS_PER_SRAM(8), .ENGINE_COLUMNS(2)) u_pool (
      .clk_i(clk), .rst_ni(rst_n), .sram_cfg_i('0), .start_i(start), .acq_num_i(16'd4), .coarse_end_i(late ? 16'd3 : 16'd1), .track_end_i(16'd2),
      .gate_begin_i('0), .gate_end_i('0), .smooth_i(1'b0), .prior_i(1'b0), .template_i('0), .tdc_valid_i(1'b0), .tdc_timestamp_i('1),
      .result_tready_i(1'b1));
  reg read = 0, write = 0;
  reg [1:0] read_at = 0, write_at = 0;
  dtof_sram #(.PORTS(1), .DEPTH(3), .WIDTH(4)) u_sram (
      .clk_i(clk), .rst_ni(rst_n), .cfg_i('0), .read_en_i(read), .read_addr_i(read_at), .write_en_i(write), .write_addr_i(write_at),
      .write_parts_i(1'b1), .write_data_i(4'd5));
  initial begin
    repeat (3) @(negedge clk);
    rst_n = 1;
    late  = $test$plusargs("a_schedule");
    @(negedge clk) start = 1;
    @(negedge clk) start = 0;
    @(negedge clk) begin
      write    = 1;
      write_at = $test$plusargs("a_write_in_range") ? 3 : 2;
      read     = $test$plusargs("a_one_access");
    end
    @(negedge clk) begin
      write   = 0;
      read    = 1;
      read_at = $test$plusargs("a_read_in_range") ? 3 : 2;
    end
    @(negedge clk) read = 0;
    while (!array_ready) @(negedge clk);
    array_valid = 1;
    @(negedge clk);
    array_valid = !$test$plusargs("a_contiguous_acquisition");
    repeat (40) @(negedge clk);
    $display("PASS");
    $finish;
  end
endmodule
"""


class Breaches(unittest.TestCase):
    """Each assertion that the table names fails in a simulation where its obligation is broken."""

    def test_each_named_assertion_fails(self) -> None:
        named = {name for _, notices in rows(PAGE.read_text(encoding="utf-8")) for name in re.findall(r"`(a_\w+)`", notices)}
        named -= protocol_assertions() | {"a_no_array_error"}  # test_power_simulation breaks the last one
        self.assertEqual(named, set(re.findall(r'plusargs\("(a_\w+)"\)', BENCH)))
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "bench.sv").write_text(BENCH, encoding="utf-8")
            built = subprocess.run(["iverilog", "-g2012", "-s", "breaches", "-o", f"{folder}/bench.vvp", "-f", "dtof.f", f"{folder}/bench.sv"],
                                   cwd=ROOT / "hdl", capture_output=True, text=True, check=False)  # fmt: skip
            self.assertEqual(built.returncode, 0, built.stdout + built.stderr)
            for fault in ("", *sorted(named)):
                done = subprocess.run(["vvp", "-n", "bench.vvp", f"+{fault}"], cwd=folder, capture_output=True, text=True, check=False)
                with self.subTest(fault=fault):
                    self.assertEqual("PASS" in done.stdout, not fault, done.stdout)
                    self.assertEqual(done.returncode != 0, bool(fault), done.stdout)
                    if fault:
                        (source,) = {sentence for path in (ROOT / "hdl").rglob("*.sv") if path.parent.name != "assertions" for sentence in
                                     re.findall(rf"`DTOF_ASSERT\({fault},(?:[^;]*?)\"([^\"]*)\"\)", path.read_text(encoding="utf-8"))
                                     if sentence in done.stdout}  # fmt: skip
                        self.assertTrue(source)


if __name__ == "__main__":
    unittest.main()
