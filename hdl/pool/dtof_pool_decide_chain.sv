// SPDX-License-Identifier: Apache-2.0
// poolPointer, decide: the chain along a column with two labels, the pointers of a pixel's leader and rival.
//
// Equations (docs/reference/poolpointer.md, Decide): dtof_label_chain with E = (n, 0), Q = (Qa, Qb) and lambda = DECIDE_PENALTY.
// With RIVAL_MOVES = 0 a pointer is relative to its candidate's cell, and the rival is at its own candidate.
//
// 1. With RIVAL_MOVES = 0 advance_i looks up the cells of the captured pixel's candidates in its group's word; the pixel is then prepared.
// 2. The next advance_i takes the prepared pixel into the chain.
//
// Schedule and latency: those of dtof_label_chain.
// Cost: dtof_label_chain with two labels; with RIVAL_MOVES = 0 two choices among LABELS cells, 14 flip-flops and an adder of 18 bits.

`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_decide_chain `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH,
    localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES),
    localparam int PIXEL_WIDTH = dtof_pkg::pool_pixel_width(LABELS, SCORE_BITS, OFFSET_BITS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES),
    localparam int EVIDENCE_WIDTH = ADVANTAGE_WIDTH + 1,
    localparam int PENALTY_WIDTH = dtof_pkg::POOL_DECIDE_PENALTY_WIDTH
) (
    input  logic                         clk_i,
    input  logic                         active_i,         // high in all of decide; while low, the chain's registers hold
    input  `DTOF_TYPE(dtof_pool_pkg, chain_command_t) command_i,
    input  logic                         advance_i,        // command_i.advance; or that of choose, which has no effect
    input  logic [      PIXEL_WIDTH-1:0] captured_i,       // word of the pixel that advance_i prepares
    input  logic [LABELS*CELL_WIDTH-1:0] cells_i,          // candidates of its group
    input  logic [      PIXEL_WIDTH-1:0] prepared_i,       // word of the prepared pixel
    // as in dtof_label_chain
    output logic [  2*PENALTY_WIDTH-1:0] message_o,
    input  logic [  2*PENALTY_WIDTH-1:0] other_message_i,
    output logic                         rival_wins_o,
    output logic [                 15:0] position_o,       // of the winner
    output logic [                 15:0] lost_position_o,  // of the other label
    output logic [   EVIDENCE_WIDTH+1:0] margin_o
);

  localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES);
  localparam int POSITION_WIDTH = 17;  // signed

  logic [POSITION_WIDTH-1:0] leader_position, rival_position, position, lost_position;
  logic unused_loser;

  generate
    if (RIVAL_MOVES != 0) begin : g_absolute
      assign leader_position = POSITION_WIDTH'(prepared_i[POINTER_WIDTH-1:0]) << POINTER_SHIFT;
      assign rival_position = POSITION_WIDTH'({prepared_i[POINTER_WIDTH+:dtof_pkg::POOL_RIVAL_WIDTH], 9'h100});
      logic unused_group;
      assign unused_group = ^{clk_i, advance_i, captured_i, cells_i};
    end else begin : g_relative
      localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS);
      logic [LABEL_WIDTH-1:0] leader_label, rival_label;
      logic [CELL_WIDTH-1:0] leader_cell_q, rival_cell_q;
      logic signed [17:0] moved;
      assign leader_label = captured_i[POINTER_WIDTH+:LABEL_WIDTH];
      assign rival_label = captured_i[POINTER_WIDTH+LABEL_WIDTH+:LABEL_WIDTH];
      always_ff @(posedge clk_i) begin
        if (advance_i) begin
          leader_cell_q <= cells_i[leader_label*CELL_WIDTH+:CELL_WIDTH];
          rival_cell_q <= cells_i[rival_label*CELL_WIDTH+:CELL_WIDTH];
        end
      end
      assign moved = $signed({2'b00, leader_cell_q, 9'd0})
          + $signed({{(18 - POINTER_WIDTH - POINTER_SHIFT) {prepared_i[POINTER_WIDTH-1]}}, prepared_i[POINTER_WIDTH-1:0],
                     {POINTER_SHIFT{1'b0}}});
      // A position beyond the range becomes the end of the range.
      assign leader_position = moved[17] ? '0 : moved[16] ? POSITION_WIDTH'(17'h0ffff) : POSITION_WIDTH'(moved[15:0]);
      assign rival_position = POSITION_WIDTH'({rival_cell_q, 9'd0});
    end
  endgenerate

  assign position_o = position[15:0];
  assign lost_position_o = lost_position[15:0];

  dtof_label_chain #(
      .LABELS        (2),
      .POSITION_WIDTH(POSITION_WIDTH),
      .REACH         (2048),
      .EVIDENCE_WIDTH(EVIDENCE_WIDTH),
      .PENALTY_WIDTH (PENALTY_WIDTH)
  ) u_decide (
      .clk_i            (clk_i),
      .active_i         (active_i),
      .command_i        (command_i),
      .evidence_i       ({{EVIDENCE_WIDTH{1'b0}}, 1'b0, prepared_i[POINT_WIDTH-1-:ADVANTAGE_WIDTH]}),
      .position_i       ({rival_position, leader_position}),
      .penalty_i        (PENALTY_WIDTH'(2)),
      .message_o        (message_o),
      .other_message_i  (other_message_i),
      .best_label_o     (rival_wins_o),
      .second_label_o   (unused_loser),
      .best_position_o  (position),
      .second_position_o(lost_position),
      .margin_o         (margin_o)
  );

  logic unused;
  assign unused = ^{unused_loser, position[16], lost_position[16], captured_i, prepared_i};

endmodule

`default_nettype wire
