// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_array_reset: after rst_ni or an abort the array is in reset for eight clocks and its clock is stopped for three more, from any
// state and for any number of aborts; without them no output changes; scan_mode_i connects the reset to the pin.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module array_reset_properties (
    input logic clk_i,
    input logic reset_i,
    input logic scan_mode_i,
    input logic abort_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic busy, in_reset, array_rst_n, stream_rst_n;

  dtof_array_reset u_dut (
      .clk_i        (clk_i),
      .rst_ni       (rst_n),
      .scan_mode_i  (scan_mode_i),
      .abort_i      (abort_i),
      .busy_o       (busy),
      .reset_o      (in_reset),
      .array_rst_no (array_rst_n),
      .stream_rst_no(stream_rst_n)
  );

  // Clocks since the last abort or the last clock with rst_ni low, at most 15.
  logic [3:0] since_q;
  always_ff @(posedge clk_i) begin
    if (!rst_n || abort_i) begin
      since_q <= 4'd1;
    end else if (since_q != 4'd15) begin
      since_q <= since_q + 1'b1;
    end
  end

  `PROVE(a_reset, !rst_n || in_reset == (since_q <= 4'd8))
  `PROVE(a_array, array_rst_n == (rst_n && (scan_mode_i || since_q > 4'd8)))
  `PROVE(a_stream, stream_rst_n == array_rst_n)
  `PROVE(a_busy, !rst_n || busy == (since_q <= 4'd11))
  `GOAL(rst_n && since_q == 4'd12 && !busy)

endmodule

`default_nettype wire
