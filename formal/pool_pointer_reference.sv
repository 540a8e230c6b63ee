// SPDX-License-Identifier: Apache-2.0
// Reference of poolPointer for a frame of a small array (docs/reference/poolpointer.md): two columns of at most four rows, so one group, one
// engine; fewer than 16 acquisitions, so no sweep and no level of thinning but 0. A stage is a module of its own.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_pointer_reference #(
    parameter int W = 18,
    parameter int NP = 8,
    parameter int ROWS = 2,
    parameter int COUNT_WIDTH = 7,
    parameter int LABELS = 5,
    parameter int MOST_SCORE = 15,
    parameter int SMOOTH = 1,
    parameter int STORED_BITS = 2,
    parameter int ACQUISITIONS = 3,
    parameter int COARSE_END = 1,
    parameter int TRACK_END = 2,
    localparam int PIXELS = 2 * ROWS  // column by column
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   take_i,         // an acquisition of this frame is complete
    input  logic [W-1:0]            acquisition_i,
    input  logic [PIXELS*2*NP-1:0] timestamps_i,   // both of each pixel, the first one lowest
    input  logic [LABELS-1:0]      used_i,         // candidates of the last frame that were used; 0 without a prior
    input  logic [LABELS*W-1:0]   used_cells_i,
    output logic [PIXELS*W-1:0]   positions_o,
    output logic [PIXELS*W-1:0]   confidences_o,
    output logic [LABELS-1:0]      used_o,
    output logic [LABELS*W-1:0]   cells_o
);

  localparam int F = 16 - NP;
  localparam int NONE = (1 << NP) - 1;
  localparam int COLUMN = ROWS * W;
  localparam int MOST_COUNT = (1 << COUNT_WIDTH) - 1;

  // Timestamps of the acquisition as positions.
  logic [PIXELS-1:0] any, two, thinned;
  logic [PIXELS*W-1:0] preferred, other;

  genvar p;
  generate
    for (p = 0; p < PIXELS; p = p + 1) begin : g_time
      logic [W-1:0] first, second;
      logic has_first, has_second, swaps;
      assign first = 32'(timestamps_i[2*p*NP+:NP]);
      assign second = 32'(timestamps_i[(2*p+1)*NP+:NP]);
      assign has_first = first != 32'(NONE);
      assign has_second = second != 32'(NONE);
      assign any[p] = has_first || has_second;
      assign two[p] = has_first && has_second;
      assign swaps = two[p] ? acquisition_i[0] : !has_first;
      assign preferred[W*p+:W] = ((swaps ? second : first) << F) + 32'((1 << F) >> 1);
      assign other[W*p+:W] = ((swaps ? first : second) << F) + 32'((1 << F) >> 1);
      assign thinned[p] = acquisition_i < 32'd16 && 32'd0 < 32'd7 - (preferred[W*p+:W] >> 13);
    end
  endgenerate

  // Coarse.
  logic [32*8-1:0] counts_q, counts;
  logic [W-1:0] chosen;
  logic here;
  integer c, r, b;

  always_comb begin
    counts = counts_q;
    for (c = 0; c < 2; c = c + 1) begin
      for (r = 0; r < ROWS; r = r + 2) begin
        // The even row if the acquisition is even, and the other one if that row has no timestamp.
        here = any[c*ROWS+r];
        chosen = preferred[W*(c*ROWS+r)+:W];
        if (r + 1 < ROWS && any[c*ROWS+(r+1)%ROWS] && (acquisition_i[0] || !here)) begin
          here = 1'b1;
          chosen = preferred[W*(c*ROWS+(r+1)%ROWS)+:W];
        end
        for (b = 0; b < 32; b = b + 1) begin
          if (here && (chosen >> 11) == 32'(b) && counts[8*b+:8] != 8'(MOST_COUNT)) counts[8*b+:8] = counts[8*b+:8] + 8'd1;
        end
      end
    end
  end

  logic [LABELS*W-1:0] significance;
  logic [W-1:0] background;
  logic tilted;

  pool_decode_reference #(
      .LABELS      (LABELS),
      .COUNT_WIDTH (COUNT_WIDTH),
      .ACQUISITIONS(ACQUISITIONS),
      .STORED_BITS (STORED_BITS)
  ) u_decode (
      .counts_i      (counts_q),
      .used_i        (used_i),
      .used_cells_i  (used_cells_i),
      .cells_o       (cells_o),
      .significance_o(significance),
      .background_o  (background),
      .tilted_o      (tilted)
  );

  // Track.
  logic [PIXELS*LABELS*W-1:0] scores_q, scores;
  logic [PIXELS*W-1:0] leaders_q, offsets_q, leaders, offsets;

  generate
    for (p = 0; p < PIXELS; p = p + 1) begin : g_track
      pool_track_reference #(
          .LABELS    (LABELS),
          .MOST_SCORE(MOST_SCORE)
      ) u_track (
          .preferred_i (preferred[W*p+:W]),
          .other_i     (other[W*p+:W]),
          .two_i       (two[p]),
          .thinned_i   (thinned[p]),
          .cells_i     (cells_o),
          .background_i(background),
          .scores_i    (scores_q[p*LABELS*W+:LABELS*W]),
          .leader_i    (leaders_q[W*p+:W]),
          .offset_i    (offsets_q[W*p+:W]),
          .scores_o    (scores[p*LABELS*W+:LABELS*W]),
          .leader_o    (leaders[W*p+:W]),
          .offset_o    (offsets[W*p+:W])
      );
    end
  endgenerate

  // Choose: the left column first.
  logic [PIXELS*W-1:0] labels, cells_chosen, starts, first_pointers, first_rivals, first_advantages;

  genvar g;
  generate
    for (g = 0; g < 2; g = g + 1) begin : g_choose
      pool_choose_reference #(
          .ROWS     (ROWS),
          .LABELS   (LABELS),
          .HAS_LEFT (g),
          .HAS_RIGHT(1 - g)
      ) u_choose (
          .cells_i       (cells_o),
          .background_i  (background),
          .scores_i      (scores_q[g*ROWS*LABELS*W+:ROWS*LABELS*W]),
          .leaders_i     (leaders_q[g*COLUMN+:COLUMN]),
          .offsets_i     (offsets_q[g*COLUMN+:COLUMN]),
          .right_scores_i(scores_q[ROWS*LABELS*W+:ROWS*LABELS*W]),
          .left_cells_i  ((g == 0) ? '0 : cells_chosen[0+:COLUMN]),
          .left_starts_i ((g == 0) ? '0 : starts[0+:COLUMN]),
          .labels_o      (labels[g*COLUMN+:COLUMN]),
          .cells_o       (cells_chosen[g*COLUMN+:COLUMN]),
          .starts_o      (starts[g*COLUMN+:COLUMN]),
          .pointers_o    (first_pointers[g*COLUMN+:COLUMN]),
          .rivals_o      (first_rivals[g*COLUMN+:COLUMN]),
          .advantages_o  (first_advantages[g*COLUMN+:COLUMN])
      );
    end
  endgenerate

  integer k, i;
  always_comb begin
    for (k = 0; k < LABELS; k = k + 1) begin
      used_o[k] = 1'b0;
      for (i = 0; i < PIXELS; i = i + 1) begin
        if (labels[W*i+:W] == 32'(k)) used_o[k] = 1'b1;
      end
    end
  end

  // Point. The first acquisition of the phase begins with what choose has found.
  logic [PIXELS*W-1:0] pointers_q, rivals_q, advantages_q, pointers_before, rivals_before, advantages_before, pointers, rivals, advantages;
  logic begins;
  assign begins = acquisition_i == 32'(TRACK_END);
  assign pointers_before = begins ? first_pointers : pointers_q;
  assign rivals_before = begins ? first_rivals : rivals_q;
  assign advantages_before = begins ? first_advantages : advantages_q;

  generate
    for (p = 0; p < PIXELS; p = p + 1) begin : g_point
      pool_point_reference u_point (
          .preferred_i  (preferred[W*p+:W]),
          .other_i      (other[W*p+:W]),
          .two_i        (two[p]),
          .acquisition_i(acquisition_i),
          .pointer_i    (pointers_before[W*p+:W]),
          .rival_i      (rivals_before[W*p+:W]),
          .advantage_i  (advantages_before[W*p+:W]),
          .pointer_o    (pointers[W*p+:W]),
          .rival_o      (rivals[W*p+:W]),
          .advantage_o  (advantages[W*p+:W])
      );
    end
  endgenerate

  integer q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      counts_q <= '0;
      scores_q <= '0;
      leaders_q <= '0;
      offsets_q <= '0;
    end else if (take_i) begin
      if (acquisition_i < 32'(COARSE_END)) counts_q <= counts;
      for (q = 0; q < PIXELS; q = q + 1) begin
        if (acquisition_i >= 32'(COARSE_END) && acquisition_i < 32'(TRACK_END) && any[q]) begin
          scores_q[q*LABELS*W+:LABELS*W] <= scores[q*LABELS*W+:LABELS*W];
          leaders_q[W*q+:W] <= leaders[W*q+:W];
          offsets_q[W*q+:W] <= offsets[W*q+:W];
        end
        if (acquisition_i >= 32'(TRACK_END)) begin
          pointers_q[W*q+:W] <= any[q] ? pointers[W*q+:W] : pointers_before[W*q+:W];
          rivals_q[W*q+:W] <= any[q] ? rivals[W*q+:W] : rivals_before[W*q+:W];
          advantages_q[W*q+:W] <= any[q] ? advantages[W*q+:W] : advantages_before[W*q+:W];
        end
      end
    end
  end

  // Decide.
  logic [PIXELS*W-1:0] winners, margins;

  generate
    for (g = 0; g < 2; g = g + 1) begin : g_decide
      pool_decide_reference #(
          .NP         (NP),
          .ROWS       (ROWS),
          .LABELS     (LABELS),
          .HAS_LEFT   (g),
          .SMOOTH     (SMOOTH),
          .STORED_BITS(STORED_BITS)
      ) u_decide (
          .pointers_i    (pointers_q[g*COLUMN+:COLUMN]),
          .rivals_i      (rivals_q[g*COLUMN+:COLUMN]),
          .advantages_i  (advantages_q[g*COLUMN+:COLUMN]),
          .cells_i       (cells_o),
          .significance_i(significance),
          .background_i  (background),
          .tilted_i      (tilted),
          .left_winners_i((g == 0) ? '0 : winners[0+:COLUMN]),
          .left_margins_i((g == 0) ? '0 : margins[0+:COLUMN]),
          .winners_o     (winners[g*COLUMN+:COLUMN]),
          .margins_o     (margins[g*COLUMN+:COLUMN]),
          .words_o       (positions_o[g*COLUMN+:COLUMN]),
          .confidences_o (confidences_o[g*COLUMN+:COLUMN])
      );
    end
  endgenerate

endmodule

`default_nettype wire
