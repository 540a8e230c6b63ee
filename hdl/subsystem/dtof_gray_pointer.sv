// SPDX-License-Identifier: Apache-2.0
// A pointer for another clock: a counter in Gray code. From clock to clock at most one bit changes, except when the pointer is cleared.
//
// Equation: gray_o = n ^ (n >> 1), address_o = n mod 2^(WIDTH - 1), n' = clear_i ? 0 : (n + step_i) mod 2^WIDTH.
// No reset: clear_i sets the pointer.
// Latency: one clock. Cost: WIDTH flip-flops, an incrementer, 2 WIDTH XORs.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_gray_pointer #(
    parameter int WIDTH = 4  // bits of the pointer, at least 2
) (
    input  logic             clk_i,
    input  logic             rst_ni,   // for the assertion alone
    input  logic             clear_i,
    input  logic             step_i,
    output logic [WIDTH-1:0] gray_o,   // from flip-flops
    output logic [WIDTH-2:0] address_o
);

  logic [WIDTH-1:0] code_q, code, count, changed;

  genvar i;
  generate
    for (i = 0; i < WIDTH; i = i + 1) begin : g_bit
      assign count[i] = ^code_q[WIDTH-1:i];
    end
  endgenerate
  assign code = (count + WIDTH'(1)) ^ ((count + WIDTH'(1)) >> 1);

  always_ff @(posedge clk_i) begin
    if (clear_i) begin
      code_q <= '0;
    end else if (step_i) begin
      code_q <= code;
    end
  end

  assign gray_o = code_q;
  assign address_o = count[WIDTH-2:0];

  assign changed = code ^ code_q;
  `DTOF_ASSERT(a_one_bit, !step_i || (changed & (changed - 1'b1)) == '0, "more than one bit of a Gray pointer changes")

endmodule

`default_nettype wire
