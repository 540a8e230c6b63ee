// SPDX-License-Identifier: Apache-2.0
// Reports a wait that takes too long.
//
// 1. After limit_i successive clocks with waits_i, expired_o is high for one clock.
// 2. If the wait continues, the count begins again. limit_i = 0 switches the watchdog off.
//
// Latency: expired_o is high two clocks after the last of the limit_i clocks: waits_i comes late in its clock, so a register is first.
// Cost: a counter and a comparator of WIDTH bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_watchdog #(
    parameter int WIDTH = 24
) (
    input  logic             clk_i,
    input  logic             rst_ni,
    input  logic [WIDTH-1:0] limit_i,
    input  logic             waits_i,
    output logic             expired_o
);

  logic [WIDTH-1:0] count_q;  // clocks of the present wait so far
  logic waits_q, expired_q, reached;

  assign reached = waits_q && (limit_i != '0) && (count_q >= limit_i - 1'b1);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      waits_q <= 1'b0;
      count_q <= '0;
      expired_q <= 1'b0;
    end else begin
      waits_q <= waits_i;
      expired_q <= reached;
      if (!waits_q || reached || limit_i == '0) begin
        count_q <= '0;
      end else begin
        count_q <= count_q + 1'b1;
      end
    end
  end

  assign expired_o = expired_q;

endmodule

`default_nettype wire
