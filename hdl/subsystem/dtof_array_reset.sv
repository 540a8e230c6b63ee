// SPDX-License-Identifier: Apache-2.0
// Ends an array's frame at any time and in any state, by a reset of the array alone.
//
// 1. After abort_i the array is in reset for eight clocks. Its clock runs, so that registers without a reset leave its pipelines.
// 2. For three more clocks its clock is stopped, so that the release of the reset has more than a period to reach all flip-flops.
// 3. busy_o is high during these eleven clocks. An abort_i in this time starts them again.
//
// rst_ni resets the array at once, and sets the flip-flop of the array's reset. The flip-flop releases the reset after the first clock edge with
// rst_ni high, so that the array's reset tree has the time from that edge (constraints/subsystem/dtof_subsystem.sdc). With scan_mode_i the array's
// reset is rst_ni, so that a tester controls it from a pin.
// Schedule (abort_i in clock 0): reset_o is high in clocks 1 to 8, busy_o in clocks 1 to 11. Latency: 1 clock.
// Cost: a counter of four bits, a flip-flop, two gates in the array's reset.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_array_reset (
    input  logic clk_i,
    input  logic rst_ni,
    input  logic scan_mode_i,
    input  logic abort_i,
    output logic busy_o,
    output logic reset_o,      // the array is in this reset, and its clock must run
    output logic array_rst_no  // rst_ni combined with this reset
);

  localparam logic [3:0] RESTING = 4'd3;
  localparam logic [3:0] ALL = 4'd11;

  logic [3:0] left_q;  // clocks until busy_o falls
  logic reset_q;       // left_q > RESTING, or rst_ni; a flip-flop of its own, so that no gate output can glitch on the reset

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      left_q <= '0;
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

endmodule

`default_nettype wire
