// SPDX-License-Identifier: Apache-2.0
// A pixel's track word after one timestamp: scores of the candidates, leader, its offset. Combinational.
//
// Equation (docs/reference/poolpointer.md, Track): the lowest candidate hit gains a point, or the others lose one
// if its score is full; it leads if it is now ahead of the leader. The leader's offset follows the timestamp by one
// and starts anew with a new leader.
// Cost: an incrementer or decrementer a score; about 20 gate delays.
module track_update #(
    parameter int LABELS = 6,
    parameter int DARK_LABELS = 6,
    parameter int DARK_SCORE_BITS = 4,
    parameter int BRIGHT_LABELS = 6,
    parameter int BRIGHT_SCORE_BITS = 4,
    parameter int OFFSET_BITS = 5,  // 0: neither offset nor leader
    localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(DARK_LABELS, DARK_SCORE_BITS, BRIGHT_LABELS,
                                                            BRIGHT_SCORE_BITS, OFFSET_BITS)
) (
    input  logic                   update_i,
    input  logic [TRACK_WIDTH-1:0] word_i,         // {offset, leader, scores}
    input  logic [     LABELS-1:0] hits_i,         // none without a timestamp
    input  logic                   bright_i,
    input  logic                   offset_up_i,
    input  logic                   offset_down_i,
    output logic [TRACK_WIDTH-1:0] word_o          // 0 without update_i
);

  localparam int SCORES_WIDTH = dtof_pkg::max_of(DARK_LABELS * DARK_SCORE_BITS, BRIGHT_LABELS * BRIGHT_SCORE_BITS);
  localparam int SCORE_WIDTH = dtof_pkg::max_of(DARK_SCORE_BITS, BRIGHT_SCORE_BITS);
  localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS);
  localparam int OFFSET_WIDTH = dtof_pkg::max_of(OFFSET_BITS, 1);
  localparam logic [SCORE_WIDTH-1:0] DARK_FULL = SCORE_WIDTH'((1 << DARK_SCORE_BITS) - 1);
  localparam logic [SCORE_WIDTH-1:0] BRIGHT_FULL = SCORE_WIDTH'((1 << BRIGHT_SCORE_BITS) - 1);
  localparam logic [OFFSET_WIDTH-1:0] HIGHEST_OFFSET = OFFSET_WIDTH'((1 << (OFFSET_WIDTH - 1)) - 1);
  localparam logic [OFFSET_WIDTH-1:0] LOWEST_OFFSET = ~HIGHEST_OFFSET;

  integer j;
  logic [LABELS-1:0] winner, gain, loss;
  logic [LABELS*SCORE_WIDTH-1:0] score, next_score, step;  // of every label, whichever the word's format
  logic [SCORE_WIDTH-1:0] winner_score, leader_score;
  logic [LABEL_WIDTH-1:0] leader, winner_label;
  logic [OFFSET_WIDTH-1:0] offset, moved;
  logic [SCORES_WIDTH-1:0] scores;
  logic hit, full, up, down, change;

  // Under update_i alone, so that a simulator works on words that are updated; the defaults say that nothing is kept.
  always_comb begin
    word_o = '0;
    j = 0;
    winner = '0;
    gain = '0;
    loss = '0;
    score = '0;
    next_score = '0;
    step = '0;
    winner_score = '0;
    leader_score = '0;
    leader = '0;
    winner_label = '0;
    offset = '0;
    moved = '0;
    scores = '0;
    hit = 1'b0;
    full = 1'b0;
    up = 1'b0;
    down = 1'b0;
    change = 1'b0;
    if (update_i) begin
      winner = hits_i & (~hits_i + 1'b1);
      hit = |hits_i;
      leader = LABEL_WIDTH'(word_i >> SCORES_WIDTH);
      offset = OFFSET_WIDTH'(word_i >> (SCORES_WIDTH + LABEL_WIDTH));

      score = '0;
      for (j = 0; j < DARK_LABELS; j = j + 1) begin
        if (!bright_i) score[j*SCORE_WIDTH+:SCORE_WIDTH] = SCORE_WIDTH'(word_i[j*DARK_SCORE_BITS+:DARK_SCORE_BITS]);
      end
      for (j = 0; j < BRIGHT_LABELS; j = j + 1) begin
        if (bright_i) score[j*SCORE_WIDTH+:SCORE_WIDTH] = SCORE_WIDTH'(word_i[j*BRIGHT_SCORE_BITS+:BRIGHT_SCORE_BITS]);
      end

      winner_score = '0;
      leader_score = '0;
      winner_label = '0;
      for (j = 0; j < LABELS; j = j + 1) begin
        winner_score = winner_score | (score[j*SCORE_WIDTH+:SCORE_WIDTH] & {SCORE_WIDTH{winner[j]}});
        leader_score = leader_score | (score[j*SCORE_WIDTH+:SCORE_WIDTH] & {SCORE_WIDTH{leader == LABEL_WIDTH'(j)}});
        winner_label = winner_label | (LABEL_WIDTH'(j) & {LABEL_WIDTH{winner[j]}});
      end
      full = (winner_score == (bright_i ? BRIGHT_FULL : DARK_FULL));
      for (j = 0; j < LABELS; j = j + 1) begin
        gain[j] = winner[j] && !full;
        loss[j] = full && !winner[j] && (score[j*SCORE_WIDTH+:SCORE_WIDTH] != '0);
        step[j*SCORE_WIDTH+:SCORE_WIDTH] = {SCORE_WIDTH{loss[j]}} | SCORE_WIDTH'(gain[j]);  // 1, 0, -1
        next_score[j*SCORE_WIDTH+:SCORE_WIDTH] = score[j*SCORE_WIDTH+:SCORE_WIDTH] + step[j*SCORE_WIDTH+:SCORE_WIDTH];
      end
      scores = '0;
      if (bright_i) begin
        for (j = 0; j < BRIGHT_LABELS; j = j + 1) begin
          scores[j*BRIGHT_SCORE_BITS+:BRIGHT_SCORE_BITS] = next_score[j*SCORE_WIDTH+:BRIGHT_SCORE_BITS];
        end
      end else begin
        for (j = 0; j < DARK_LABELS; j = j + 1) begin
          scores[j*DARK_SCORE_BITS+:DARK_SCORE_BITS] = next_score[j*SCORE_WIDTH+:DARK_SCORE_BITS];
        end
      end

      up = offset_up_i && (offset != HIGHEST_OFFSET);
      down = offset_down_i && (offset != LOWEST_OFFSET);
      moved = offset + ({OFFSET_WIDTH{down}} | OFFSET_WIDTH'(up));  // 1, 0, -1

      // A full winner passes whoever led: the others lose a point.
      change = hit && (winner_label != leader) && (full || winner_score >= leader_score);
      // Without an offset there is no leader either: both are cut off.
      word_o = TRACK_WIDTH'({change ? '0 : moved, change ? winner_label : leader, scores});
    end
  end

endmodule
