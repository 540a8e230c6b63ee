// SPDX-License-Identifier: Apache-2.0
// poolPointer, choose: the chain along a column whose labels are the candidates of each pixel's group.
//
// Equations (docs/reference/poolpointer.md, Choose): dtof_label_chain with Q(k) = C[k] and lambda = 2 + (5 B >> 4). Positions are counted in
// cells, so 2048 positions are 4 cells.
//
// Schedule and latency: those of dtof_label_chain.
// Cost: dtof_label_chain with LABELS labels, and an adder of 9 bits.

`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_choose_chain `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int LABELS = 5,
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH,
    localparam int BACKGROUND_WIDTH = dtof_pkg::POOL_BACKGROUND_WIDTH,
    localparam int EVIDENCE_WIDTH = dtof_pkg::POOL_EVIDENCE_WIDTH,
    localparam int PENALTY_WIDTH = dtof_pkg::POOL_CHOOSE_PENALTY_WIDTH
) (
    input  logic                             clk_i,
    input  logic                             active_i,         // high in all of choose; while low, registers hold
    input  `DTOF_TYPE(dtof_pool_pkg, chain_command_t) command_i,
    // pixel to prepare
    input  logic [LABELS*EVIDENCE_WIDTH-1:0] evidence_i,
    input  logic [    LABELS*CELL_WIDTH-1:0] cells_i,
    input  logic [     BACKGROUND_WIDTH-1:0] background_i,
    // as in dtof_label_chain
    output logic [ LABELS*PENALTY_WIDTH-1:0] message_o,
    input  logic [ LABELS*PENALTY_WIDTH-1:0] other_message_i,
    output logic [          LABEL_WIDTH-1:0] best_label_o,
    output logic [          LABEL_WIDTH-1:0] second_label_o,
    output logic [           CELL_WIDTH-1:0] best_cell_o,
    output logic [           CELL_WIDTH-1:0] second_cell_o,
    output logic [       EVIDENCE_WIDTH+1:0] margin_o
);

  localparam int POSITION_WIDTH = CELL_WIDTH + 1;  // signed

  logic [LABELS*POSITION_WIDTH-1:0] positions;
  logic [POSITION_WIDTH-1:0] best_position, second_position;
  logic [BACKGROUND_WIDTH+2:0] five_backgrounds;
  logic [PENALTY_WIDTH-1:0] penalty;

  genvar k;
  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_label
      assign positions[k*POSITION_WIDTH+:POSITION_WIDTH] = {1'b0, cells_i[k*CELL_WIDTH+:CELL_WIDTH]};
    end
  endgenerate

  assign five_backgrounds = (BACKGROUND_WIDTH + 3)'(background_i) + ((BACKGROUND_WIDTH + 3)'(background_i) << 2);
  assign penalty = PENALTY_WIDTH'(five_backgrounds >> 4) + PENALTY_WIDTH'(2);
  assign best_cell_o = best_position[CELL_WIDTH-1:0];
  assign second_cell_o = second_position[CELL_WIDTH-1:0];

  dtof_label_chain #(
      .LABELS        (LABELS),
      .POSITION_WIDTH(POSITION_WIDTH),
      .REACH         (4),
      .EVIDENCE_WIDTH(EVIDENCE_WIDTH),
      .PENALTY_WIDTH (PENALTY_WIDTH)
  ) u_choose (
      .clk_i            (clk_i),
      .active_i         (active_i),
      .command_i        (command_i),
      .evidence_i       (evidence_i),
      .position_i       (positions),
      .penalty_i        (penalty),
      .message_o        (message_o),
      .other_message_i  (other_message_i),
      .best_label_o     (best_label_o),
      .second_label_o   (second_label_o),
      .best_position_o  (best_position),
      .second_position_o(second_position),
      .margin_o         (margin_o)
  );

  logic unused;
  assign unused = ^{best_position[CELL_WIDTH], second_position[CELL_WIDTH]};

endmodule

`default_nettype wire
