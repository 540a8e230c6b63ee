# SPDX-License-Identifier: Apache-2.0
import subprocess
import tempfile
import unittest
from pathlib import Path

HDL = Path(__file__).resolve().parents[2] / "hdl"
# A frame of one acquisition; whoever has no use for the SRAMs' side band may leave it open, so that it floats.
BENCH = """
module bench;
  logic clk = 1'b0, rst_n = 1'b0, start = 1'b0;
  wire done;
  TOP #(.PIXELS_PER_SRAM(8), .SRAM_NUM(4)MORE) u_array (
      .clk_i(clk), .rst_ni(rst_n), .start_i(start), .acq_num_i(16'd1), .done_o(done), .tdc_valid_i(1'b1),
      .tdc_timestamp_i({40{1'b1}}), .result_tready_i(1'b1)OTHERS);
  always #1 clk = !clk;
  initial begin
    #4 rst_n = 1'b1;
    @(posedge clk) start <= 1'b1;
    @(posedge clk) start <= 1'b0;
    @(posedge done) $display("frame done");
    $finish;
  end
endmodule
"""
GATE = ", .gate_begin_i(10'd0), .gate_end_i(10'd1023)"
OTHERS = {
    "dtof_array": GATE + ", .raw_i(1'b0), .raw_first_row_i(3'd0), .raw_last_row_i(3'd0)",
    "dtof_pool_pointer_array": GATE + ", .coarse_end_i(16'd0), .track_end_i(16'd0), .smooth_i(1'b1), .prior_i(1'b0), .template_i(256'd0)",
}


class OpenSideBand(unittest.TestCase):
    def test_a_frame_ends(self) -> None:
        for top, others in OTHERS.items():
            with self.subTest(top), tempfile.TemporaryDirectory() as folder:
                bench, program = Path(folder) / "bench.sv", Path(folder) / "bench.vvp"
                bench.write_text(BENCH.replace("TOP", top).replace("OTHERS", others).replace(
                    "MORE", "" if top == "dtof_array" else ", .ENGINE_COLUMNS(2)"), encoding="utf-8")
                subprocess.run(["iverilog", "-g2012", "-f", "dtof.f", "-s", "bench", "-o", str(program), str(bench)], cwd=HDL,
                               check=True)  # fmt: skip
                said = subprocess.run(["vvp", "-n", str(program)], timeout=120, text=True, stdout=subprocess.PIPE, check=True)
                self.assertIn("frame done", said.stdout)


if __name__ == "__main__":
    unittest.main()
