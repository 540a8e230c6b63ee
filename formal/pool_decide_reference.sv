// SPDX-License-Identifier: Apache-2.0
// Reference of poolPointer's decide (docs/reference/poolpointer.md, "Decide", "Confidence") for a column whose pixels are of one group: the
// results. In 32-bit integers.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_decide_reference #(
    parameter int NP = 8,
    parameter int ROWS = 2,
    parameter int LABELS = 5,
    parameter int HAS_LEFT = 0,
    parameter int SMOOTH = 1,      // S1 is on
    parameter int STORED_BITS = 2  // of a significance
) (
    input  logic [ROWS*32-1:0]   pointers_i,
    input  logic [ROWS*32-1:0]   rivals_i,
    input  logic [ROWS*32-1:0]   advantages_i,
    input  logic [LABELS*32-1:0] cells_i,
    input  logic [LABELS*32-1:0] significance_i,
    input  logic [31:0]          background_i,
    input  logic                 tilted_i,
    input  logic [ROWS*32-1:0]   left_winners_i,
    input  logic [ROWS*32-1:0]   left_margins_i,
    output logic [ROWS*32-1:0]   winners_o,      // c
    output logic [ROWS*32-1:0]   margins_o,      // |margin|
    output logic [ROWS*32-1:0]   words_o,
    output logic [ROWS*32-1:0]   confidences_o
);

  localparam int HALF_BIN = (1 << (16 - NP)) / 2;

  // The largest significance of the candidates near a position.
  function automatic logic [31:0] near_significance(input logic [LABELS*32-1:0] cells, input logic [LABELS*32-1:0] significance,
                                                    input logic signed [31:0] position);
    integer k;
    logic signed [31:0] away;
    near_significance = 32'd0;
    for (k = 0; k < LABELS; k = k + 1) begin
      away = cells[32*k+:32] - (position >>> 9);
      if (away >= -4 && away <= 4 && significance[32*k+:32] > near_significance) near_significance = significance[32*k+:32];
    end
  endfunction

  function automatic logic [31:0] weight_of(input logic [31:0] z);
    if (STORED_BITS == 3) begin
      case (z)
        0: weight_of = 32'd0;
        1: weight_of = 32'd13;
        2: weight_of = 32'd16;
        3: weight_of = 32'd20;
        4: weight_of = 32'd24;
        5: weight_of = 32'd29;
        6: weight_of = 32'd35;
        default: weight_of = 32'd64;
      endcase
    end else begin
      weight_of = (z == 32'd0) ? 32'd0 : (z == 32'd1) ? 32'd22 : (z == 32'd2) ? 32'd32 : 32'd64;
    end
  endfunction

  // The pixel's part beside its group's: M, r and s by the background.
  function automatic logic [31:0] pooled_part(input logic [31:0] pooled, input logic [31:0] background);
    logic signed [31:0] mean, above, r, s, sum;
    case (background >> 2)
      0: {mean, r, s} = {32'd18, 32'd2, 32'd3};
      1: {mean, r, s} = {32'd10, 32'd2, 32'd3};
      2: {mean, r, s} = {32'd14, 32'd2, 32'd4};
      3: {mean, r, s} = {32'd22, 32'd3, 32'd4};
      4: {mean, r, s} = {32'd36, 32'd3, 32'd9};
      5: {mean, r, s} = {32'd64, 32'd4, 32'd6};
      6: {mean, r, s} = {32'd128, 32'd4, 32'd9};
      7: {mean, r, s} = {32'd200, 32'd5, 32'd6};
      default: {mean, r, s} = {32'd255, 32'd5, 32'd6};
    endcase
    above = pooled - mean;
    if (above < 0) above = 0;
    sum = (above >>> r) + (above >>> s);
    pooled_part = (sum > 127) ? 127 : sum;
  endfunction

  logic [ROWS*2*32-1:0] evidence, positions, beliefs;

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
      logic signed [31:0] margin, reach, moved, shifted;
      logic [31:0] pooled, weight;
      logic [2:0] near;

      assign evidence[2*r*32+:64] = {32'd0, advantages_i[32*r+:32]};
      assign positions[2*r*32+:64] = {(rivals_i[32*r+:32] << 9) + 32'd256, pointers_i[32*r+:32]};
      assign margin = beliefs[2*r*32+:32] - beliefs[(2*r+1)*32+:32];
      assign margins_o[32*r+:32] = (margin < 0) ? -margin : margin;
      assign winners_o[32*r+:32] = (margin >= 0) ? positions[2*r*32+:32] : positions[(2*r+1)*32+:32];
      assign reach = (background_i < 32'd6 || margins_o[32*r+:32] >= 32'd64) ? 1024 : 1536;

      pool_closer_reference u_closer (
          .centre_i (winners_o[32*r+:32]),
          .beside_i ({left_winners_i[32*r+:32], winners_o[32*BELOW+:32], winners_o[32*ABOVE+:32]}),
          .present_i({HAS_LEFT != 0, r != ROWS - 1, r != 0}),
          .reach_i  (reach),
          .near_o   (near),
          .moved_o  (moved)
      );

      assign pooled = margins_o[32*r+:32] + (near[0] ? margins_o[32*ABOVE+:32] : 32'd0) + (near[1] ? margins_o[32*BELOW+:32] : 32'd0)
          + (near[2] ? left_margins_i[32*r+:32] : 32'd0);
      assign weight = weight_of(near_significance(cells_i, significance_i, winners_o[32*r+:32]));
      assign confidences_o[32*r+:32] = ((weight < (margins_o[32*r+:32] << 2)) ? weight : margins_o[32*r+:32] << 2)
          + (tilted_i ? 32'd0 : pooled_part(pooled, background_i));
      assign shifted = ((SMOOTH != 0) ? moved : $signed(winners_o[32*r+:32])) - HALF_BIN;
      assign words_o[32*r+:32] = (shifted < 0) ? 0 : (shifted > 65535 - 2 * HALF_BIN) ? 65535 - 2 * HALF_BIN : shifted;
    end
  endgenerate

endmodule

`default_nettype wire
