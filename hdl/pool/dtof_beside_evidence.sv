// SPDX-License-Identifier: Apache-2.0
// poolPointer, choose: evidence for each candidate of a pixel, from the pixel's scores and from the columns to the left and right.
//
// Equations (docs/reference/poolpointer.md, Choose): E(k) = score[k] - (k >= 2 ? B >> 3 : 0) - from_left - from_right, B the
// background of the pixel's group. from_left is 2 + (3 B >> 4) if the candidate is more than four cells from the candidate chosen
// in the column to the left, otherwise 0. from_right is 0 if the candidate is within four cells of the best candidate of the pixel
// to the right; otherwise it is 1 + (3 B >> 4), limited to the lead of that pixel's best candidate over its second candidate if
// the candidate is within four cells of the second.
//
// 1. take_right_pixel loads the scores of the pixel to the right. first_rank loads the cells of its group; the module ranks the
//    candidates, one per clock, and keeps the best two.
// 2. advance_i loads the pixel itself. take_ranks registers the two costs and the two cells of the pixel to the right.
// 3. compare compares the pixel's candidates, one per clock, with the three cells. Each candidate's evidence follows in the next clock.
//
// Schedule: the table of dtof_pool_sequencer. Latency: 1 clock from compare to a candidate's evidence. evidence_o and cells_o hold
//   from the clock after the last compare until advance_i, which may be given in that same clock.
// Cost: three comparators of cells, some 150 flip-flops at the defaults, per engine.

`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_beside_evidence `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int LABELS = 5,      // candidates of a group
    parameter int SCORE_BITS = 4,  // bits of a candidate's score
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH,
    localparam int BACKGROUND_WIDTH = dtof_pkg::POOL_BACKGROUND_WIDTH,
    localparam int GROUP_WIDTH = LABELS * CELL_WIDTH + BACKGROUND_WIDTH,  // all cells, and the background with all bits
    localparam int EVIDENCE_WIDTH = dtof_pkg::POOL_EVIDENCE_WIDTH
) (
    input  logic                             clk_i,
    input  `DTOF_TYPE(dtof_pool_pkg, beside_command_t) command_i,
    // pixel to the right: its scores with take_right_pixel, its group's word with first_rank
    input  logic [    LABELS*SCORE_BITS-1:0] right_scores_i,
    input  logic                             has_right_i,     // a column to the right exists
    // pixel to prepare, loaded with advance_i, and its group's word
    input  logic                             advance_i,
    input  logic [    LABELS*SCORE_BITS-1:0] scores_i,
    input  logic [          GROUP_WIDTH-1:0] group_i,         // {B, cells}; with first_rank of the group of the pixel to the right
    input  logic [           CELL_WIDTH-1:0] left_cell_i,     // with compare: cell chosen in the column to the left
    output logic [LABELS*EVIDENCE_WIDTH-1:0] evidence_o,      // signed
    output logic [    LABELS*CELL_WIDTH-1:0] cells_o,
    output logic [     BACKGROUND_WIDTH-1:0] background_o
);

  localparam int COST_WIDTH = 4;  // 2 + (3 * 39 >> 4) at most
  localparam int LATENESS_SHIFT = 3;
  localparam int LATENESS_WIDTH = BACKGROUND_WIDTH - LATENESS_SHIFT;

  localparam logic signed [CELL_WIDTH:0] REACH = (CELL_WIDTH + 1)'(4);

  function automatic logic far(input logic [CELL_WIDTH-1:0] cell_a, input logic [CELL_WIDTH-1:0] cell_b);
    logic signed [CELL_WIDTH:0] distance;
    distance = $signed({1'b0, cell_a}) - $signed({1'b0, cell_b});
    far = (distance > REACH) || (distance < -REACH);
  endfunction

  // Pixel to the right: its best two candidates; on a tie the candidate with the lower number.

  logic [LABELS*SCORE_BITS-1:0] right_scores_q;
  logic [LABELS*CELL_WIDTH-1:0] right_cells, right_cells_q;
  logic [LATENESS_WIDTH-1:0] right_lateness_q;
  logic signed [EVIDENCE_WIDTH-1:0] right_score, lateness, right_evidence, best_q, second_q;
  logic signed [EVIDENCE_WIDTH:0] to_best, to_second;
  logic [CELL_WIDTH-1:0] best_cell_q, second_cell_q;
  logic second_rank_q;

  assign right_cells = command_i.first_rank ? group_i[LABELS*CELL_WIDTH-1:0] : right_cells_q;
  assign right_evidence = right_score - lateness;
  assign right_score = $signed(EVIDENCE_WIDTH'(right_scores_q[SCORE_BITS-1:0]));
  assign lateness = command_i.late_rank ? $signed(EVIDENCE_WIDTH'(right_lateness_q)) : '0;

  // Adds the costs on the other side of the comparison, so that one addition replaces a subtraction and a comparison.
  assign to_best = (EVIDENCE_WIDTH + 1)'(best_q) + (EVIDENCE_WIDTH + 1)'(lateness) - (EVIDENCE_WIDTH + 1)'(right_score);
  assign to_second = (EVIDENCE_WIDTH + 1)'(second_q) + (EVIDENCE_WIDTH + 1)'(lateness)
      - (EVIDENCE_WIDTH + 1)'(right_score);

  always_ff @(posedge clk_i) begin
    if (command_i.take_right_pixel) begin
      right_scores_q <= right_scores_i;
    end else if (command_i.rank) begin
      right_scores_q <= right_scores_q >> SCORE_BITS;
    end
    if (command_i.rank) begin
      right_cells_q <= right_cells >> CELL_WIDTH;
      second_rank_q <= command_i.first_rank;
      if (command_i.first_rank) begin
        right_lateness_q <= group_i[GROUP_WIDTH-1-:LATENESS_WIDTH];
      end
      if (command_i.first_rank || to_best < 0) begin
        best_q <= right_evidence;
        best_cell_q <= right_cells[CELL_WIDTH-1:0];
        second_q <= best_q;
        second_cell_q <= best_cell_q;
      end else if (second_rank_q || to_second < 0) begin
        second_q <= right_evidence;
        second_cell_q <= right_cells[CELL_WIDTH-1:0];
      end
    end
  end

  // Costs of a disagreement with the columns to the left and right.

  logic [BACKGROUND_WIDTH-1:0] background_q;
  logic [BACKGROUND_WIDTH+1:0] three_backgrounds;
  logic [COST_WIDTH-1:0] left_cost, right_limit, left_cost_q, right_limit_q, right_margin_q;
  logic [EVIDENCE_WIDTH-1:0] ahead;
  logic [CELL_WIDTH-1:0] right_best_cell_q, right_second_cell_q;

  assign three_backgrounds = (BACKGROUND_WIDTH + 2)'(background_q) + ((BACKGROUND_WIDTH + 2)'(background_q) << 1);
  assign left_cost = COST_WIDTH'(three_backgrounds >> 4) + COST_WIDTH'(2);
  assign right_limit = COST_WIDTH'(three_backgrounds >> 4) + COST_WIDTH'(1);
  assign ahead = EVIDENCE_WIDTH'(best_q - second_q);

  always_ff @(posedge clk_i) begin
    if (command_i.take_ranks) begin
      right_best_cell_q <= best_cell_q;
      right_second_cell_q <= second_cell_q;
      left_cost_q <= left_cost;
      right_limit_q <= right_limit;
      right_margin_q <= (ahead < EVIDENCE_WIDTH'(right_limit)) ? ahead[COST_WIDTH-1:0] : right_limit;
    end
  end

  // The prepared pixel.

  logic [LABELS*SCORE_BITS-1:0] scores_q;
  logic [LABELS*CELL_WIDTH-1:0] cells_q;
  logic [LABELS*EVIDENCE_WIDTH-1:0] evidence_q;
  logic [CELL_WIDTH-1:0] own_cell;
  logic [COST_WIDTH-1:0] from_left, from_right;
  logic signed [EVIDENCE_WIDTH-1:0] evidence, own_q, costs;
  logic [LABELS*EVIDENCE_WIDTH-1:0] evidences;
  logic compared_q, far_left_q, far_best_q, far_second_q;

  assign own_cell = cells_q[CELL_WIDTH-1:0];
  assign from_left = far_left_q ? left_cost_q : '0;
  assign from_right = !far_best_q ? '0 : far_second_q ? right_limit_q : right_margin_q;
  assign costs = $signed(EVIDENCE_WIDTH'(from_left)) + $signed(EVIDENCE_WIDTH'(from_right));
  assign evidence = own_q - costs;
  assign evidences = compared_q ? {evidence, evidence_q[LABELS*EVIDENCE_WIDTH-1:EVIDENCE_WIDTH]} : evidence_q;

  always_ff @(posedge clk_i) begin
    if (advance_i) begin
      scores_q <= scores_i;
      cells_q <= group_i[LABELS*CELL_WIDTH-1:0];
      background_q <= group_i[LABELS*CELL_WIDTH+:BACKGROUND_WIDTH];
    end else if (command_i.compare) begin
      scores_q <= scores_q >> SCORE_BITS;
      cells_q <= {own_cell, cells_q[LABELS*CELL_WIDTH-1:CELL_WIDTH]};
    end
    compared_q <= command_i.compare;
    if (command_i.compare) begin
      far_left_q <= command_i.has_left && far(own_cell, left_cell_i);
      far_best_q <= has_right_i && far(own_cell, right_best_cell_q);
      far_second_q <= far(own_cell, right_second_cell_q);
      own_q <= $signed(EVIDENCE_WIDTH'(scores_q[SCORE_BITS-1:0]))
          - (command_i.late_compare ? $signed(EVIDENCE_WIDTH'(background_q >> LATENESS_SHIFT)) : '0);
    end
    if (compared_q) begin
      evidence_q <= evidences;
    end
  end

  assign evidence_o = evidences;
  assign cells_o = cells_q;
  assign background_o = background_q;

endmodule

`default_nettype wire
