// SPDX-License-Identifier: Apache-2.0
// Ends an array's frame at any time, whatever the array waits for: a reset of the array alone.
//
// 1. Behind abort_i the array is in reset for eight clocks, in which its clock runs: what has no reset leaves its pipelines.
// 2. For three more clocks its clock rests, so that the release has more than a period for its way.
// 3. busy_o is high meanwhile. An abort_i in these clocks begins them again.
//
// With scan_mode_i the tester has the array's reset at a pin.
// Cost: a counter of four bits, a flip-flop, an AND in the array's reset.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_array_reset (
    input  logic clk_i,
    input  logic rst_ni,
    input  logic scan_mode_i,
    input  logic abort_i,
    output logic busy_o,
    output logic reset_o,      // the array is in this reset, and its clock is to run
    output logic array_rst_no  // rst_ni, and this reset
);

  localparam logic [3:0] RESTING = 4'd3;
  localparam logic [3:0] ALL = 4'd11;

  logic [3:0] left_q;  // clocks
  logic reset_q;       // left_q > RESTING, without a gate between flip-flop and reset

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      left_q <= '0;
      reset_q <= 1'b0;
    end else if (abort_i) begin
      left_q <= ALL;
      reset_q <= 1'b1;
    end else if (left_q != '0) begin
      left_q <= left_q - 1'b1;
      reset_q <= (left_q > RESTING + 1'b1);
    end
  end

  assign busy_o = (left_q != '0);
  assign reset_o = reset_q;
  assign array_rst_no = rst_ni && (scan_mode_i || !reset_q);

endmodule

`default_nettype wire
