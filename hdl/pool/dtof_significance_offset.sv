// SPDX-License-Identifier: Apache-2.0
// poolPointer, decode: correction of the significances in long frames, whose sweeps remove a part of the background's counts.
//
// Equation (docs/reference/poolpointer.md, Significance): (lg(A) - lg(3333)) / 2, lg(3333) = 93, in units of lg; A is the number of
// acquisitions. 0 for A <= 3333, 17 for A = 65,535, limited to the largest number of OFFSET_WIDTH bits.
//
// 1. The first clock registers lg(A).
// 2. The second clock registers the offset.
//
// Latency: 2 clocks from acq_num_i to offset_o. Cost: 12 flip-flops, a dtof_eighth_octaves, per array.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_significance_offset #(
    parameter int ACQ_WIDTH = 16,  // at least 2
    localparam int OFFSET_WIDTH = dtof_pkg::POOL_SIGNIFICANCE_OFFSET_WIDTH
) (
    input  logic                    clk_i,
    input  logic [   ACQ_WIDTH-1:0] acq_num_i,  // A, from a register
    output logic [OFFSET_WIDTH-1:0] offset_o
);

  localparam int LOGARITHM_WIDTH = 3 + dtof_pkg::index_width(ACQ_WIDTH);
  localparam int LEAST = 93;
  localparam int MOST = (1 << OFFSET_WIDTH) - 1;

  logic [LOGARITHM_WIDTH-1:0] logarithm, logarithm_q;
  int half;

  dtof_eighth_octaves #(
      .WIDTH(ACQ_WIDTH)
  ) u_logarithm (
      .x_i        (acq_num_i),
      .logarithm_o(logarithm)
  );

  assign half = (32'(logarithm_q) - LEAST) >>> 1;

  always_ff @(posedge clk_i) begin
    logarithm_q <= logarithm;
    offset_o <= (32'(logarithm_q) <= LEAST) ? '0 : (half > MOST) ? OFFSET_WIDTH'(MOST) : OFFSET_WIDTH'(half);
  end

endmodule

`default_nettype wire
