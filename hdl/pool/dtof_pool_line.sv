// SPDX-License-Identifier: Apache-2.0
// poolPointer: carries the word that an engine reads from a pair of columns to the engine.
//
// At most one pair of an engine drives a word and all others drive 0, so an OR combines the words. Up to
// dtof_pkg::POOL_LINE_PAIRS neighbouring pairs form a segment: their OR runs from pair to pair (dtof_pool_pair) and ends in a register
// of this module. The OR of these registers is the line. So the longest path has the length of a segment, however many columns an
// engine has, and every pair's word takes the same time.
// The registers take words only while engines work, so that their clock can rest in stream phases.
// Latency: POOL_LINE_CLOCKS from words_i to line_o.
// Cost: WIDTH flip-flops per segment.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_line #(
    parameter int SEGMENTS = 5,
    parameter int WIDTH = 58
) (
    input  logic                      clk_i,
    input  logic                      active_i,  // from the first word of an operation of the engine to its last word
    input  logic [SEGMENTS*WIDTH-1:0] words_i,  // one word per segment
    output logic [         WIDTH-1:0] line_o
);

  logic [SEGMENTS*WIDTH-1:0] words_q;
  integer i;

  always_ff @(posedge clk_i) begin
    if (active_i) begin
      words_q <= words_i;
    end
  end

  always_comb begin
    line_o = '0;
    for (i = 0; i < SEGMENTS; i = i + 1) begin
      line_o = line_o | words_q[i*WIDTH+:WIDTH];
    end
  end

endmodule

`default_nettype wire
