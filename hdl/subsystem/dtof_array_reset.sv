// SPDX-License-Identifier: Apache-2.0
// Resets an array: at the start, and at any time and in any state by abort_i, which ends its frame.
//
// 1. After rst_ni or abort_i the array is in reset for eight clocks. Its clock runs, so that registers without a reset leave its pipelines.
// 2. For three more clocks its clock is stopped. So the release of the reset has four periods to reach all flip-flops of a wide array.
// 3. busy_o is high during these eleven clocks. An abort_i in this time starts them again.
//
// rst_ni resets the array at once. The release comes from a flip-flop alone (constraints/subsystem/dtof_subsystem.sdc). With scan_mode_i the
// array's reset is rst_ni, so that a tester controls it from a pin.
// Schedule (abort_i in clock 0; or rst_ni is low in clock 0 and high from clock 1 on): reset_o is high in clocks 1 to 8, busy_o in clocks 1 to
// 11. Latency: 1 clock.
// Cost: a counter of four bits, a flip-flop, two gates in each of the two resets.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_array_reset (
    input  logic clk_i,
    input  logic rst_ni,
    input  logic scan_mode_i,
    input  logic abort_i,
    output logic busy_o,
    output logic reset_o,       // the array is in this reset, and its clock must run
    output logic array_rst_no,  // rst_ni combined with this reset
    output logic stream_rst_no  // the same for the logic behind the array, whose clock runs on: released within one period
);

  localparam logic [3:0] RESTING = 4'd3;
  localparam logic [3:0] ALL = 4'd11;

  logic [3:0] left_q;  // clocks until busy_o falls
  logic reset_q;       // left_q > RESTING, or rst_ni; a flip-flop of its own, so that no gate output can glitch on the reset

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      left_q <= ALL;
      reset_q <= 1'b1;
    end else if (abort_i) begin
      left_q <= ALL;
      reset_q <= 1'b1;
    end else begin
      reset_q <= (left_q > RESTING + 1'b1);
      if (left_q != '0) begin
        left_q <= left_q - 1'b1;
      end
    end
  end

  assign busy_o = (left_q != '0);
  assign reset_o = reset_q;
  assign array_rst_no = rst_ni && (scan_mode_i || !reset_q);
  assign stream_rst_no = rst_ni && (scan_mode_i || !reset_q);  // the pin above has constraints of its own

endmodule

`default_nettype wire
