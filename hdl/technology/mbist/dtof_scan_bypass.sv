// SPDX-License-Identifier: Apache-2.0
// Leads the inputs of a memory around the macro while scan_i is high, so that scan tests the logic in front of the memory and behind it.
//
// Equation: bit i of the read data is the XOR of the inputs i, i + WIDTH, i + 2 WIDTH ... of the last clock. So a wrong value at any one input
// changes one bit of the register, and the register, which is part of the scan chain, gives every bit of the read data any value.
// While scan_i is low, the read data are the macro's, and the register does not load.
// Schedule: clock 0 inputs, clock 1 read data, as with the macro.
// Latency: one clock. Cost: WIDTH flip-flops and multiplexers, fewer than INPUTS XOR gates.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_scan_bypass #(
    parameter int INPUTS = 14,  // inputs of the macro, at least 1
    parameter int WIDTH = 8     // bits of a word, at least 1
) (
    input  logic              clk_i,
    input  logic              scan_i,         // 1: bypass; constant while the chip scans
    input  logic [INPUTS-1:0] inputs_i,
    input  logic [ WIDTH-1:0] macro_rdata_i,
    output logic [ WIDTH-1:0] rdata_o
);

  `DTOF_REQUIRE(g_illegal_inputs, INPUTS >= 1, "dtof_scan_bypass: INPUTS must be at least 1")
  `DTOF_REQUIRE(g_illegal_width, WIDTH >= 1, "dtof_scan_bypass: WIDTH must be at least 1")

  localparam int ROUNDS = (INPUTS + WIDTH - 1) / WIDTH;

  logic [ROUNDS*WIDTH-1:0] filled;
  logic [WIDTH-1:0] folded, folded_q;
  integer i;

  assign filled = (ROUNDS * WIDTH)'(inputs_i);

  always_comb begin
    folded = '0;
    for (i = 0; i < ROUNDS; i = i + 1) begin
      folded = folded ^ filled[i*WIDTH+:WIDTH];
    end
  end

  always_ff @(posedge clk_i) begin
    if (scan_i) begin
      folded_q <= folded;
    end
  end

  assign rdata_o = scan_i ? folded_q : macro_rdata_i;

endmodule

`default_nettype wire
