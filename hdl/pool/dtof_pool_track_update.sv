// SPDX-License-Identifier: Apache-2.0
// poolPointer, track: next track word of a pixel after one timestamp: scores of the candidates, leader, leader's offset. Combinational.
//
// Equation (docs/reference/poolpointer.md, Track): the lowest candidate that is hit gains a point; if its score is full, all
// others lose a point instead. A candidate that passes the leader's score becomes the leader, and the offset becomes 0.
// Otherwise the offset follows the timestamp by 4, 2 or 1, less with a higher score of the leader.
// Latency: none. Cost: an incrementer or decrementer per score, an adder for the offset; about 20 gate delays.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_track_update #(
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,  // 0: neither offset nor leader
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(LABELS, SCORE_BITS, OFFSET_BITS)
) (
    input  logic [TRACK_WIDTH-1:0] word_i,         // {offset, leader, scores}
    input  logic [ SCORE_BITS-1:0] leader_score_i,
    input  logic [     LABELS-1:0] hits_i,         // candidates that the timestamp hits; 0 without a timestamp
    input  logic                   offset_up_i,
    input  logic                   offset_down_i,
    output logic                   changed_o,      // low: word_o equals word_i
    output logic [TRACK_WIDTH-1:0] word_o
);

  localparam int SCORES_WIDTH = LABELS * SCORE_BITS;

  // Scores.

  logic [LABELS-1:0] winner, gain, loss;
  logic [SCORE_BITS-1:0] winner_score;
  logic [SCORES_WIDTH-1:0] score, step, next_score;
  logic hit, full;

  assign winner = hits_i & (~hits_i + 1'b1);
  assign hit = |hits_i;
  assign full = (winner_score == '1);
  assign score = word_i[SCORES_WIDTH-1:0];

  integer j;
  always_comb begin
    winner_score = '0;
    for (j = 0; j < LABELS; j = j + 1) begin
      winner_score = winner_score | (score[j*SCORE_BITS+:SCORE_BITS] & {SCORE_BITS{winner[j]}});
    end
    for (j = 0; j < LABELS; j = j + 1) begin
      gain[j] = winner[j] && !full;
      loss[j] = hit && full && !winner[j] && (score[j*SCORE_BITS+:SCORE_BITS] != '0);
      step[j*SCORE_BITS+:SCORE_BITS] = {SCORE_BITS{loss[j]}} | SCORE_BITS'(gain[j]);  // 1, 0, -1
      next_score[j*SCORE_BITS+:SCORE_BITS] = score[j*SCORE_BITS+:SCORE_BITS] + step[j*SCORE_BITS+:SCORE_BITS];
    end
  end

  generate
    if (OFFSET_BITS == 0) begin : g_scores_alone
      assign word_o = next_score;
      assign changed_o = (hit && !full) || (loss != '0);
      logic unused;
      assign unused = ^{leader_score_i, offset_up_i, offset_down_i};
    end else begin : g_leader
      localparam int SUM_WIDTH = dtof_pkg::max_of(OFFSET_BITS, 4) + 1;
      localparam logic signed [SUM_WIDTH-1:0] HIGHEST = SUM_WIDTH'((1 << (OFFSET_BITS - 1)) - 1);
      // Scores of the leader from which the offset moves by 2 and by 1.
      localparam int SLOWER_FROM = 3;
      localparam int SLOWEST_FROM = 8;

      logic [LABEL_WIDTH-1:0] leader, winner_label;
      logic change;
      integer i;

      assign leader = word_i[SCORES_WIDTH+:LABEL_WIDTH];

      always_comb begin
        winner_label = '0;
        for (i = 0; i < LABELS; i = i + 1) begin
          winner_label = winner_label | (LABEL_WIDTH'(i) & {LABEL_WIDTH{winner[i]}});
        end
      end

      // Offset, limited to its range; the sum has bits enough that the comparison is exact.

      logic signed [SUM_WIDTH-1:0] offset, move, sum, limited;

      assign offset = $signed({{(SUM_WIDTH - OFFSET_BITS) {word_i[TRACK_WIDTH-1]}}, word_i[TRACK_WIDTH-1-:OFFSET_BITS]});
      assign move = (32'(leader_score_i) < SLOWER_FROM) ? SUM_WIDTH'(4)
          : (32'(leader_score_i) < SLOWEST_FROM) ? SUM_WIDTH'(2) : SUM_WIDTH'(1);
      assign sum = offset_up_i ? offset + move : offset_down_i ? offset - move : offset;
      assign limited = (sum > HIGHEST) ? HIGHEST : (sum < ~HIGHEST) ? ~HIGHEST : sum;

      // A candidate with a full score always passes the leader, because all others lose a point.
      assign change = hit && (winner_label != leader) && (full || winner_score >= leader_score_i);

      assign changed_o = (hit && !full) || (loss != '0) || change || offset_up_i || offset_down_i;
      assign word_o = {change ? OFFSET_BITS'(0) : limited[OFFSET_BITS-1:0], change ? winner_label : leader, next_score};

      logic unused;
      assign unused = ^limited;
    end
  endgenerate

endmodule

`default_nettype wire
