// SPDX-License-Identifier: Apache-2.0
// A pixel's track word after one timestamp: docs/reference/poolpointer.md, Track, step by step on integers.
`include "properties.svh"

module track_update_properties #(
    parameter int DARK_LABELS = 5,
    parameter int DARK_SCORE_BITS = 4,
    parameter int BRIGHT_LABELS = 5,
    parameter int BRIGHT_SCORE_BITS = 4,
    parameter int OFFSET_BITS = 5,
    localparam int LABELS = dtof_pkg::max_of(DARK_LABELS, BRIGHT_LABELS),
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int SCORES_WIDTH = dtof_pkg::max_of(DARK_LABELS * DARK_SCORE_BITS, BRIGHT_LABELS * BRIGHT_SCORE_BITS),
    localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(DARK_LABELS, DARK_SCORE_BITS, BRIGHT_LABELS,
                                                            BRIGHT_SCORE_BITS, OFFSET_BITS)
) (
    input logic                   clk_i,
    input logic                   update_i,
    input logic [TRACK_WIDTH-1:0] word_i,
    input logic [     LABELS-1:0] hits_i,
    input logic                   bright_i,
    input logic                   offset_up_i,
    input logic                   offset_down_i
);

  logic checking;
  assign checking = 1'b1;

  logic [TRACK_WIDTH-1:0] word;

  track_update #(
      .LABELS           (LABELS),
      .DARK_LABELS      (DARK_LABELS),
      .DARK_SCORE_BITS  (DARK_SCORE_BITS),
      .BRIGHT_LABELS    (BRIGHT_LABELS),
      .BRIGHT_SCORE_BITS(BRIGHT_SCORE_BITS),
      .OFFSET_BITS      (OFFSET_BITS)
  ) u_dut (
      .update_i     (update_i),
      .word_i       (word_i),
      .hits_i       (hits_i),
      .bright_i     (bright_i),
      .offset_up_i  (offset_up_i),
      .offset_down_i(offset_down_i),
      .word_o       (word)
  );

  localparam int SCORE_BITS = 4;  // at most
  integer k, candidates, bits, full, hit_label, leader, offset, next_leader, next_offset, hit_score;
  integer leader_score, next_hit_score, next_leader_score;
  logic [LABELS*SCORE_BITS-1:0] score, next_score, got_score;
  logic any_hit;

  always_comb begin
    candidates = bright_i ? BRIGHT_LABELS : DARK_LABELS;
    bits = bright_i ? BRIGHT_SCORE_BITS : DARK_SCORE_BITS;
    full = (1 << bits) - 1;

    // The word's fields.
    score = '0;
    got_score = '0;
    for (k = 0; k < LABELS; k = k + 1) begin
      if (k < candidates) begin
        score[k*SCORE_BITS+:SCORE_BITS] = SCORE_BITS'((word_i >> (k * bits)) & TRACK_WIDTH'(full));
        got_score[k*SCORE_BITS+:SCORE_BITS] = SCORE_BITS'((word >> (k * bits)) & TRACK_WIDTH'(full));
      end
    end
    leader = 0;
    offset = 0;
    if (OFFSET_BITS > 0) begin
      leader = 32'((word_i >> SCORES_WIDTH) & TRACK_WIDTH'((1 << LABEL_WIDTH) - 1));
      offset = 32'(word_i >> (SCORES_WIDTH + LABEL_WIDTH));
      if (offset >= (1 << OFFSET_BITS) / 2) offset = offset - (1 << OFFSET_BITS);
    end

    // The offset moves first, with the old leader.
    next_offset = offset;
    if (offset_up_i && offset < (1 << OFFSET_BITS) / 2 - 1) next_offset = offset + 1;
    if (offset_down_i && offset > -(1 << OFFSET_BITS) / 2) next_offset = offset - 1;

    // The lowest candidate hit gains a point, or every other one loses one.
    any_hit = 1'b0;
    hit_label = 0;
    hit_score = 0;
    for (k = LABELS - 1; k >= 0; k = k - 1) begin
      if (hits_i[k]) begin
        any_hit = 1'b1;
        hit_label = k;
        hit_score = 32'(score[k*SCORE_BITS+:SCORE_BITS]);
      end
    end
    next_score = score;
    next_hit_score = 0;
    next_leader_score = 0;
    for (k = 0; k < LABELS; k = k + 1) begin
      if (any_hit && k == hit_label && hit_score < full) begin
        next_score[k*SCORE_BITS+:SCORE_BITS] = score[k*SCORE_BITS+:SCORE_BITS] + SCORE_BITS'(1);
      end else if (any_hit && k != hit_label && hit_score == full && score[k*SCORE_BITS+:SCORE_BITS] != 0) begin
        next_score[k*SCORE_BITS+:SCORE_BITS] = score[k*SCORE_BITS+:SCORE_BITS] - SCORE_BITS'(1);
      end
      if (k == hit_label) next_hit_score = 32'(next_score[k*SCORE_BITS+:SCORE_BITS]);
      if (k == leader) next_leader_score = 32'(next_score[k*SCORE_BITS+:SCORE_BITS]);
    end

    // Then it leads, if it is ahead of the leader.
    next_leader = leader;
    if (any_hit && hit_label != leader && next_hit_score > next_leader_score) begin
      next_leader = hit_label;
      next_offset = 0;
    end
  end

  `ASSUME(m_hits_in_use, (hits_i >> candidates) == '0)
  `ASSUME(m_leader_in_use, leader < candidates)
  `ASSUME(m_one_way, !(offset_up_i && offset_down_i))
  `PROVE(a_scores, !update_i || got_score == next_score)
  `PROVE(a_nothing, update_i || word == '0)
  generate
    if (OFFSET_BITS > 0) begin : g_offset
      `PROVE(a_leader, !update_i || 32'(word[SCORES_WIDTH+:LABEL_WIDTH]) == next_leader)
      `PROVE(a_offset, !update_i || word[SCORES_WIDTH+LABEL_WIDTH+:OFFSET_BITS] == OFFSET_BITS'(next_offset))
    end
  endgenerate
  `GOAL(update_i && any_hit && hit_score == full)

endmodule
