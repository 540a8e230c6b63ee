// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_watchdog: expired_o is high exactly two clocks after the last of limit_i successive clocks of one wait, and never with limit_i = 0,
// for any sequence of waits.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module watchdog_properties #(
    parameter int WIDTH = 3
) (
    input logic clk_i,
    input logic reset_i,
    input logic waits_i
);

  (* anyconst *) logic [WIDTH-1:0] limit;
  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic expired;

  dtof_watchdog #(
      .WIDTH(WIDTH)
  ) u_dut (
      .clk_i    (clk_i),
      .rst_ni   (rst_n),
      .limit_i  (limit),
      .waits_i  (waits_i),
      .expired_o(expired)
  );

  // Clocks of the wait up to the last clock but one, counted from the begin of the wait or from the last expiry.
  logic [WIDTH:0] waited_q, waited;
  logic waits_q;
  logic due;
  assign due = (limit != '0) && (waited_q == {1'b0, limit});
  assign waited = due ? '0 : waited_q;
  always_ff @(posedge clk_i) begin
    waits_q <= rst_n && waits_i;
    if (!rst_n || limit == '0) begin
      waited_q <= '0;
    end else begin
      waited_q <= waits_q ? waited + 1'b1 : '0;
    end
  end

  `PROVE(a_expires, !rst_n || expired == due)
  `GOAL(rst_n && expired && limit == 3'd5)

endmodule

`default_nettype wire
