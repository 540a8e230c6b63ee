// SPDX-License-Identifier: Apache-2.0
// Reference of poolPointer's decide (docs/reference/poolpointer.md, "Decide", "Confidence") for a column whose pixels are of one group: the
// results. In signed integers of W bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_decide_reference #(
    parameter int W = 18,
    parameter int NP = 8,
    parameter int ROWS = 2,
    parameter int LABELS = 5,
    parameter int HAS_LEFT = 0,
    parameter int SMOOTH = 1,      // S1 is on
    parameter int STORED_BITS = 2  // of a significance
) (
    input  logic [ROWS*W-1:0]   pointers_i,
    input  logic [ROWS*W-1:0]   rivals_i,
    input  logic [ROWS*W-1:0]   advantages_i,
    input  logic [LABELS*W-1:0] cells_i,
    input  logic [LABELS*W-1:0] significance_i,
    input  logic [W-1:0]          background_i,
    input  logic                 tilted_i,
    input  logic [ROWS*W-1:0]   left_winners_i,
    input  logic [ROWS*W-1:0]   left_margins_i,
    output logic [ROWS*W-1:0]   winners_o,      // c
    output logic [ROWS*W-1:0]   margins_o,      // |margin|
    output logic [ROWS*W-1:0]   words_o,
    output logic [ROWS*W-1:0]   confidences_o
);

  localparam int HALF_BIN = (1 << (16 - NP)) / 2;

  // The largest significance of the candidates near a position.
  function automatic logic [W-1:0] near_significance(input logic [LABELS*W-1:0] cells, input logic [LABELS*W-1:0] significance,
                                                    input logic signed [W-1:0] position);
    integer k;
    logic signed [W-1:0] away;
    near_significance = 32'd0;
    for (k = 0; k < LABELS; k = k + 1) begin
      away = cells[W*k+:W] - (position >>> 9);
      if (away >= -4 && away <= 4 && significance[W*k+:W] > near_significance) near_significance = significance[W*k+:W];
    end
  endfunction

  function automatic logic [W-1:0] weight_of(input logic [W-1:0] z);
    if (STORED_BITS == 3) begin
      weight_of = (z == 32'd0) ? 32'd0 : (z == 32'd1) ? 32'd13 : (z == 32'd2) ? 32'd16 : (z == 32'd3) ? 32'd20 : (z == 32'd4) ? 32'd24
          : (z == 32'd5) ? 32'd29 : (z == 32'd6) ? 32'd35 : 32'd64;
    end else begin
      weight_of = (z == 32'd0) ? 32'd0 : (z == 32'd1) ? 32'd22 : (z == 32'd2) ? 32'd32 : 32'd64;
    end
  endfunction

  // The pixel's part beside its group's: M, r and s by the background.
  function automatic logic [W-1:0] pooled_part(input logic [W-1:0] pooled, input logic [W-1:0] background);
    logic signed [W-1:0] mean, above, sum;
    logic [3:0] r, s;
    {mean, r, s} = {W'(255), 4'd5, 4'd6};
    if (background < 32'd32) {mean, r, s} = {W'(200), 4'd5, 4'd6};
    if (background < 32'd28) {mean, r, s} = {W'(128), 4'd4, 4'd9};
    if (background < 32'd24) {mean, r, s} = {W'(64), 4'd4, 4'd6};
    if (background < 32'd20) {mean, r, s} = {W'(36), 4'd3, 4'd9};
    if (background < 32'd16) {mean, r, s} = {W'(22), 4'd3, 4'd4};
    if (background < 32'd12) {mean, r, s} = {W'(14), 4'd2, 4'd4};
    if (background < 32'd8) {mean, r, s} = {W'(10), 4'd2, 4'd3};
    if (background < 32'd4) {mean, r, s} = {W'(18), 4'd2, 4'd3};
    above = pooled - mean;
    if (above < 0) above = 0;
    sum = (above >>> r) + (above >>> s);
    pooled_part = (sum > 127) ? 127 : sum;
  endfunction

  logic [ROWS*2*W-1:0] evidence, positions, beliefs;

  pool_chain_reference #(
      .ROWS  (ROWS),
      .LABELS(2)
  ) u_chain (
      .evidence_i (evidence),
      .positions_i(positions),
      .lambda_i   (32'd2),
      .beliefs_o  (beliefs)
  );

  genvar r;
  generate
    for (r = 0; r < ROWS; r = r + 1) begin : g_row
      localparam int ABOVE = (r + ROWS - 1) % ROWS;
      localparam int BELOW = (r + 1) % ROWS;
      logic signed [W-1:0] margin, reach, moved, shifted;
      logic [W-1:0] pooled, weight;
      logic [2:0] near;

      assign evidence[2*r*W+:2*W] = {W'(0), advantages_i[W*r+:W]};
      assign positions[2*r*W+:2*W] = {W'((rivals_i[W*r+:W] << 9) + 32'd256), pointers_i[W*r+:W]};
      assign margin = beliefs[2*r*W+:W] - beliefs[(2*r+1)*W+:W];
      assign margins_o[W*r+:W] = (margin < 0) ? -margin : margin;
      assign winners_o[W*r+:W] = (margin >= 0) ? positions[2*r*W+:W] : positions[(2*r+1)*W+:W];
      assign reach = (background_i < 32'd6 || margins_o[W*r+:W] >= 32'd64) ? 1024 : 1536;

      pool_closer_reference u_closer (
          .centre_i (winners_o[W*r+:W]),
          .beside_i ({left_winners_i[W*r+:W], winners_o[W*BELOW+:W], winners_o[W*ABOVE+:W]}),
          .present_i({HAS_LEFT != 0, r != ROWS - 1, r != 0}),
          .reach_i  (reach),
          .near_o   (near),
          .moved_o  (moved)
      );

      assign pooled = margins_o[W*r+:W] + (near[0] ? margins_o[W*ABOVE+:W] : 32'd0) + (near[1] ? margins_o[W*BELOW+:W] : 32'd0)
          + (near[2] ? left_margins_i[W*r+:W] : 32'd0);
      assign weight = weight_of(near_significance(cells_i, significance_i, winners_o[W*r+:W]));
      assign confidences_o[W*r+:W] = ((weight < (margins_o[W*r+:W] << 2)) ? weight : margins_o[W*r+:W] << 2)
          + (tilted_i ? 32'd0 : pooled_part(pooled, background_i));
      assign shifted = ((SMOOTH != 0) ? moved : $signed(winners_o[W*r+:W])) - HALF_BIN;
      assign words_o[W*r+:W] = (shifted < 0) ? 0 : (shifted > 65535 - 2 * HALF_BIN) ? 65535 - 2 * HALF_BIN : shifted;
    end
  endgenerate

endmodule

`default_nettype wire
