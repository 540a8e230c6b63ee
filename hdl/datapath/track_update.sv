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
    input  logic [TRACK_WIDTH-1:0] word_i,         // {offset, leader, scores}
    input  logic [     LABELS-1:0] hits_i,         // none without a timestamp
    input  logic                   bright_i,
    input  logic                   offset_up_i,
    input  logic                   offset_down_i,
    output logic [TRACK_WIDTH-1:0] word_o
);

  localparam int SCORES_WIDTH = dtof_pkg::max_of(DARK_LABELS * DARK_SCORE_BITS, BRIGHT_LABELS * BRIGHT_SCORE_BITS);
  localparam int SCORE_WIDTH = dtof_pkg::max_of(DARK_SCORE_BITS, BRIGHT_SCORE_BITS);
  localparam logic [SCORE_WIDTH-1:0] DARK_FULL = SCORE_WIDTH'((1 << DARK_SCORE_BITS) - 1);
  localparam logic [SCORE_WIDTH-1:0] BRIGHT_FULL = SCORE_WIDTH'((1 << BRIGHT_SCORE_BITS) - 1);

  logic [LABELS-1:0] winner;
  logic [LABELS*SCORE_WIDTH-1:0] score;  // of every label, whichever the word's format
  logic [SCORE_WIDTH-1:0] winner_score;
  logic hit, full;
  logic [SCORES_WIDTH-1:0] scores;

  assign winner = hits_i & (~hits_i + 1'b1);
  assign hit = |hits_i;
  assign full = (winner_score == (bright_i ? BRIGHT_FULL : DARK_FULL));

  genvar k;
  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_label
      logic [SCORE_WIDTH-1:0] dark, bright;
      if (k < DARK_LABELS) begin : g_dark
        assign dark = SCORE_WIDTH'(word_i[k*DARK_SCORE_BITS+:DARK_SCORE_BITS]);
      end else begin : g_no_dark
        assign dark = '0;
      end
      if (k < BRIGHT_LABELS) begin : g_bright
        assign bright = SCORE_WIDTH'(word_i[k*BRIGHT_SCORE_BITS+:BRIGHT_SCORE_BITS]);
      end else begin : g_no_bright
        assign bright = '0;
      end
      assign score[k*SCORE_WIDTH+:SCORE_WIDTH] = bright_i ? bright : dark;
    end
  endgenerate

  integer j;
  logic [LABELS*SCORE_WIDTH-1:0] next_score, step;
  logic [LABELS-1:0] gain, loss;
  always_comb begin
    winner_score = '0;
    for (j = 0; j < LABELS; j = j + 1) begin
      winner_score = winner_score | (score[j*SCORE_WIDTH+:SCORE_WIDTH] & {SCORE_WIDTH{winner[j]}});
    end
    for (j = 0; j < LABELS; j = j + 1) begin
      gain[j] = winner[j] && !full;
      loss[j] = hit && full && !winner[j] && (score[j*SCORE_WIDTH+:SCORE_WIDTH] != '0);
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
  end

  assign word_o[SCORES_WIDTH-1:0] = scores;

  generate
    if (OFFSET_BITS > 0) begin : g_offset
      localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS);
      logic [LABEL_WIDTH-1:0] leader, winner_label;
      logic signed [OFFSET_BITS-1:0] offset, moved;
      logic [SCORE_WIDTH-1:0] leader_score;
      logic change;

      assign leader = word_i[SCORES_WIDTH+:LABEL_WIDTH];
      assign offset = $signed(word_i[SCORES_WIDTH+LABEL_WIDTH+:OFFSET_BITS]);

      logic up, down;
      assign up = offset_up_i && (offset != {1'b0, {(OFFSET_BITS - 1) {1'b1}}});
      assign down = offset_down_i && (offset != {1'b1, {(OFFSET_BITS - 1) {1'b0}}});
      assign moved = offset + $signed({{(OFFSET_BITS - 1) {down}}, up || down});

      always_comb begin
        winner_label = '0;
        leader_score = '0;
        for (j = 0; j < LABELS; j = j + 1) begin
          winner_label = winner_label | (LABEL_WIDTH'(j) & {LABEL_WIDTH{winner[j]}});
          leader_score = leader_score
              | (score[j*SCORE_WIDTH+:SCORE_WIDTH] & {SCORE_WIDTH{leader == LABEL_WIDTH'(j)}});
        end
      end

      // A full winner passes whoever led: the others lose a point.
      assign change = hit && (winner_label != leader) && (full || winner_score >= leader_score);
      assign word_o[SCORES_WIDTH+:LABEL_WIDTH] = change ? winner_label : leader;
      assign word_o[SCORES_WIDTH+LABEL_WIDTH+:OFFSET_BITS] = change ? '0 : moved;
    end else begin : g_no_offset
      logic unused;
      assign unused = ^{offset_up_i, offset_down_i};
    end
  endgenerate

endmodule
