// SPDX-License-Identifier: Apache-2.0
// Reference of a candidate of poolPointer's decode (docs/reference/poolpointer.md, "Decode", "Significance"): the candidate of the sums w,
// and the sums for the next candidate. In signed integers of W bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_candidate_reference #(
    parameter int W = 18,
    parameter int ACQUISITIONS = 3,
    parameter int MISSING = 4,
    parameter int STORED_BITS = 2,  // bits of the significance that the group's word stores, 2 or 3
    localparam int PAIRS = 31
) (
    input  logic [PAIRS*W-1:0] w_i,
    input  logic [PAIRS*W-1:0] w_before_i,      // w'
    input  logic [PAIRS-1:0]    taken_i,
    input  logic [PAIRS-1:0]    raised_i,        // pairs with PRIOR_WEIGHT
    input  logic [W-1:0]         lowest_i,        // m
    output logic [PAIRS*W-1:0] w_o,
    output logic [PAIRS-1:0]    taken_o,
    output logic [W-1:0]         cell_o,
    output logic [W-1:0]         significance_o
);

  // Eight times the logarithm to base 2: 8 e + m.
  function automatic logic signed [W-1:0] lg(input logic [W-1:0] x);
    integer e;
    lg = 0;
    for (e = 0; e < 16; e = e + 1) begin
      if ((x >> e) != 32'd0) lg = 32'(8 * e) + (((x << 3) >> e) & 32'd7);
    end
  endfunction

  logic signed [W-1:0] place;  // i
  logic [W-1:0] highest;
  logic prior;
  integer i;

  always_comb begin
    place = -1;
    highest = 32'd0;
    prior = 1'b0;
    for (i = 0; i < PAIRS; i = i + 1) begin
      if (!taken_i[i] && (place < 0 || w_i[W*i+:W] > highest)) begin
        place = i;
        highest = w_i[W*i+:W];
        prior = raised_i[i];
      end
    end
  end

  // Sums beside it, 0 beyond either end.
  logic [W-1:0] one_below, one_above, three_below, four_below, three_above, four_above;
  integer j;

  always_comb begin
    {one_below, one_above, three_below, four_below, three_above, four_above} = '0;
    for (j = 0; j < PAIRS; j = j + 1) begin
      if (place == j + 1) one_below = w_i[W*j+:W];
      if (place == j - 1) one_above = w_i[W*j+:W];
      if (place == j + 3) three_below = w_i[W*j+:W];
      if (place == j + 4) four_below = w_i[W*j+:W];
      if (place == j - 3) three_above = w_before_i[W*j+:W];
      if (place == j - 4) four_above = w_before_i[W*j+:W];
    end
  end

  logic signed [W-1:0] tilt, height;

  always_comb begin
    tilt = one_above - one_below;
    height = highest - ((one_above < one_below) ? one_above : one_below);
    cell_o = (place + 1) << 2;
    if (height > 0 && (tilt <<< 1) > height) cell_o = ((place + 1) << 2) + 1;
    if (height > 0 && -(tilt <<< 1) > height) cell_o = ((place + 1) << 2) - 1;
  end

  logic signed [W-1:0] around, above, level, offset;  // S, D

  always_comb begin
    around = three_below + four_below + three_above + four_above;
    if (place < 4) around = ((three_above + four_above) << 1) + ((three_above + four_above) >> 2);
    if (place > 26) around = (four_below + three_below) << 1;
    above = ((highest - (prior ? 32'd28 : 32'd0)) << 2) - around;
    offset = (ACQUISITIONS <= 3333) ? 0 : ((lg(32'(ACQUISITIONS)) - 93) >>> 1);
    level = (lg(above) << 1) - lg(around + (around >>> 3) + 64) - 36 - offset - 4 * MISSING;
    if (above <= 0 || level < 0) level = 0;
    level = level >>> 2;
    if (level > 7) level = 7;
    significance_o = (STORED_BITS == 3) ? level : (level < 1) ? 0 : ((level - 1) >>> 1);
  end

  // Its pulse leaks into the pairs two places away.
  logic [W-1:0] excess;
  integer n;

  always_comb begin
    excess = (highest > lowest_i) ? ((highest - lowest_i) >> 3) : 32'd0;
    for (n = 0; n < PAIRS; n = n + 1) begin
      w_o[W*n+:W] = w_i[W*n+:W];
      if (place == n + 2 || place == n - 2) w_o[W*n+:W] = (w_i[W*n+:W] > excess) ? w_i[W*n+:W] - excess : 32'd0;
      taken_o[n] = taken_i[n] || (place >= n - 1 && place <= n + 1);
    end
  end

endmodule

`default_nettype wire
