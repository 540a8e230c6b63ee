// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pool_track_update: a pixel's track word after one timestamp follows docs/reference/poolpointer.md, Track, step by step on
// integers.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_track_update_properties #(
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int SCORES_WIDTH = LABELS * SCORE_BITS,
    localparam int OFFSET_WIDTH = dtof_pkg::max_of(OFFSET_BITS, 1),
    localparam int FULL_WIDTH = SCORES_WIDTH + LABEL_WIDTH + OFFSET_WIDTH,  // with leader and offset
    localparam int TRACK_WIDTH = (OFFSET_BITS == 0) ? SCORES_WIDTH : FULL_WIDTH
) (
    input logic                   clk_i,
    input logic [TRACK_WIDTH-1:0] word_i,
    input logic [     LABELS-1:0] hits_i,
    input logic                   offset_up_i,
    input logic                   offset_down_i
);

  logic checking;
  assign checking = 1'b1;

  logic [TRACK_WIDTH-1:0] word;
  logic changed;
  logic [FULL_WIDTH-1:0] full_before, full_after;

  assign full_before = FULL_WIDTH'(word_i);
  assign full_after = FULL_WIDTH'(word);

  integer leader_score;

  dtof_pool_track_update #(
      .LABELS     (LABELS),
      .SCORE_BITS (SCORE_BITS),
      .OFFSET_BITS(OFFSET_BITS)
  ) u_dut (
      .word_i        (word_i),
      .leader_score_i(SCORE_BITS'(leader_score)),
      .hits_i        (hits_i),
      .offset_up_i   (offset_up_i),
      .offset_down_i (offset_down_i),
      .changed_o     (changed),
      .word_o        (word)
  );

  localparam int FULL = (1 << SCORE_BITS) - 1;
  localparam int END = 1 << (OFFSET_WIDTH - 1);
  integer k, score, leader, offset, step, hit_label, hit_score, next_leader, next_offset;
  integer next_hit_score, next_leader_score;
  logic [SCORES_WIDTH-1:0] next_scores;
  logic any_hit;

  always_comb begin
    leader = 32'(full_before[SCORES_WIDTH+:LABEL_WIDTH]);
    offset = 32'(full_before[FULL_WIDTH-1-:OFFSET_WIDTH]);
    if (offset >= END) offset = offset - 2 * END;

    // First the offset moves, with the old leader; the step is smaller for a higher score.
    leader_score = 0;
    for (k = 0; k < LABELS; k = k + 1) begin
      if (k == leader) leader_score = 32'(word_i[k*SCORE_BITS+:SCORE_BITS]);
    end
    step = (leader_score < 3) ? 4 : (leader_score < 8) ? 2 : 1;
    next_offset = offset;
    if (offset_up_i) next_offset = (offset + step > END - 1) ? END - 1 : offset + step;
    if (offset_down_i) next_offset = (offset - step < -END) ? -END : offset - step;

    // The lowest candidate that is hit gains a point, or every other candidate loses a point.
    any_hit = 1'b0;
    hit_label = 0;
    hit_score = 0;
    for (k = LABELS - 1; k >= 0; k = k - 1) begin
      if (hits_i[k]) begin
        any_hit = 1'b1;
        hit_label = k;
        hit_score = 32'(word_i[k*SCORE_BITS+:SCORE_BITS]);
      end
    end
    next_scores = word_i[SCORES_WIDTH-1:0];
    next_hit_score = 0;
    next_leader_score = 0;
    for (k = 0; k < LABELS; k = k + 1) begin
      score = 32'(word_i[k*SCORE_BITS+:SCORE_BITS]);
      if (any_hit && k == hit_label && hit_score < FULL) score = score + 1;
      if (any_hit && k != hit_label && hit_score == FULL && score > 0) score = score - 1;
      next_scores[k*SCORE_BITS+:SCORE_BITS] = SCORE_BITS'(score);
      if (k == hit_label) next_hit_score = score;
      if (k == leader) next_leader_score = score;
    end

    // Then this candidate becomes the leader if its score exceeds the leader's.
    next_leader = leader;
    if (any_hit && hit_label != leader && next_hit_score > next_leader_score) begin
      next_leader = hit_label;
      next_offset = 0;
    end
  end

  `ASSUME(m_leader_in_use, leader < LABELS)
  `ASSUME(m_one_way, !(offset_up_i && offset_down_i))
  `PROVE(a_scores, word[SCORES_WIDTH-1:0] == next_scores)
  `PROVE(a_leader, OFFSET_BITS == 0 || 32'(full_after[SCORES_WIDTH+:LABEL_WIDTH]) == next_leader)
  `PROVE(a_stays, changed || word == word_i)
  `PROVE(a_changes, !changed || word != word_i || offset_up_i || offset_down_i)
  `PROVE(a_offset, OFFSET_BITS == 0 || full_after[FULL_WIDTH-1-:OFFSET_WIDTH] == OFFSET_WIDTH'(next_offset))
  `GOAL(any_hit && hit_score == FULL && offset_down_i && next_offset == -END)

endmodule

`default_nettype wire
