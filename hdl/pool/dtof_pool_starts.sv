// SPDX-License-Identifier: Apache-2.0
// poolPointer, choose: where the pointers of a pixel start, and with which advantage.
//
// Equations (docs/reference/poolpointer.md, Choose): S(k) = C[k] + (k = leader ? 64 offset : 0) for the best two labels k, the S of the best label
// in the column to the left, and n = min(margin, 2^(ADVANTAGE_WIDTH - 1) - 1). With OFFSET_BITS = 0 there is no leader, and S(k) = C[k].
//
// The track word's leader and offset move through the chain's steps with their pixel: each advance_i moves them on, from the prepared
// pixel to the next pixel, to this pixel, to the pixel before, whose labels are known.
//
// Latency: none from the labels to the starts. Cost: three adders of 10 bits and three registers of the leader and its offset.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_starts #(
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,
    parameter int ADVANTAGE_WIDTH = 7,
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(LABELS, SCORE_BITS, OFFSET_BITS),
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH,
    localparam int LEFT_WIDTH = CELL_WIDTH + OFFSET_BITS,
    localparam int MARGIN_WIDTH = dtof_pkg::POOL_EVIDENCE_WIDTH + 2
) (
    input  logic                       clk_i,
    input  logic                       advance_i,
    input  logic [    TRACK_WIDTH-1:0] word_i,          // track word of the prepared pixel
    // best two labels of the pixel before
    input  logic [    LABEL_WIDTH-1:0] best_label_i,
    input  logic [    LABEL_WIDTH-1:0] second_label_i,
    input  logic [     CELL_WIDTH-1:0] best_cell_i,
    input  logic [     CELL_WIDTH-1:0] second_cell_i,
    input  logic [   MARGIN_WIDTH-1:0] margin_i,
    output logic [     LEFT_WIDTH-1:0] best_o,          // {offset, cell} of the best label, for the column to the right
    output logic [               15:0] best_start_o,
    output logic [               15:0] second_start_o,
    output logic [ADVANTAGE_WIDTH-1:0] advantage_o,
    input  logic [     LEFT_WIDTH-1:0] left_i,          // {offset, cell} of the best label in the column to the left
    output logic [               15:0] left_start_o
);

  generate
    if (OFFSET_BITS != 0) begin : g_offset
      localparam int LEAD_WIDTH = LABEL_WIDTH + OFFSET_BITS;  // {offset, leader}
      function automatic logic [15:0] start_of(input logic [LEFT_WIDTH-1:0] lead);
        start_of = {lead[CELL_WIDTH-1:0], 9'd0}
            + {{(10 - OFFSET_BITS) {lead[LEFT_WIDTH-1]}}, lead[CELL_WIDTH+:OFFSET_BITS], 6'd0};
      endfunction
      logic [LEAD_WIDTH-1:0] next_lead_q, lead_q, last_lead_q;
      logic [LABEL_WIDTH-1:0] leader;
      logic [OFFSET_BITS-1:0] offset;
      always_ff @(posedge clk_i) begin
        if (advance_i) begin
          {last_lead_q, lead_q, next_lead_q} <= {lead_q, next_lead_q, word_i[TRACK_WIDTH-1-:LEAD_WIDTH]};
        end
      end
      assign {offset, leader} = last_lead_q;
      assign best_o = {offset & {OFFSET_BITS{leader == best_label_i}}, best_cell_i};
      assign best_start_o = start_of(best_o);
      assign second_start_o = start_of({offset & {OFFSET_BITS{leader == second_label_i}}, second_cell_i});
      assign left_start_o = start_of(left_i);
      logic unused_scores;
      assign unused_scores = ^word_i;
    end else begin : g_no_offset
      assign best_o = best_cell_i;
      assign best_start_o = {best_cell_i, 9'd0};
      assign second_start_o = {second_cell_i, 9'd0};
      assign left_start_o = {left_i, 9'd0};
      logic unused_leader;
      assign unused_leader = ^{clk_i, advance_i, word_i, best_label_i, second_label_i};
    end
  endgenerate

  localparam int HALF_ADVANTAGE = 1 << (ADVANTAGE_WIDTH - 1);
  assign advantage_o = (32'(margin_i) >= HALF_ADVANTAGE) ? ADVANTAGE_WIDTH'(HALF_ADVANTAGE - 1) : ADVANTAGE_WIDTH'(margin_i);

endmodule

`default_nettype wire
