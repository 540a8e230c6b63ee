// SPDX-License-Identifier: Apache-2.0
// One link of the result chain: loads the result of its column, or takes that of the next column when the chain shifts.
//
// Latency: 1 clock. Cost: WIDTH flip-flops and a multiplexer per column.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_result_register #(
    parameter int WIDTH = 14
) (
    input  logic             clk_i,
    input  logic             rst_ni,         // for the assertion only
    input  logic             load_i,
    input  logic             shift_i,
    input  logic [WIDTH-1:0] result_i,
    input  logic [WIDTH-1:0] next_column_i,
    output logic [WIDTH-1:0] result_o
);

  logic [WIDTH-1:0] result_q;

  always_ff @(posedge clk_i) begin
    if (load_i) begin
      result_q <= result_i;
    end else if (shift_i) begin
      result_q <= next_column_i;
    end
  end

  `DTOF_ASSERT(a_load_or_shift, !(load_i && shift_i), "a result is loaded while the chain shifts")

  assign result_o = result_q;

endmodule

`default_nettype wire
