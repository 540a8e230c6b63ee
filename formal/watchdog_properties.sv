// SPDX-License-Identifier: Apache-2.0
// dtof_watchdog: it expires in the clock behind limit_i clocks of one wait, never otherwise and never with 0, whatever comes and goes.
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

  // Clocks of the wait up to the last clock, from the begin of the wait or the last expiry on.
  logic [WIDTH:0] waited_q, waited;
  logic due;
  assign due = (limit != '0) && (waited_q == {1'b0, limit});
  assign waited = due ? '0 : waited_q;
  always_ff @(posedge clk_i) begin
    if (!rst_n || limit == '0) begin
      waited_q <= '0;
    end else begin
      waited_q <= waits_i ? waited + 1'b1 : '0;
    end
  end

  `PROVE(a_expires, !rst_n || expired == due)
  `GOAL(rst_n && expired && limit == 3'd5)

endmodule

`default_nettype wire
