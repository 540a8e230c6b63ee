// SPDX-License-Identifier: Apache-2.0
// poolPointer: the word that an engine gives to a pair of columns.
//
// Word layouts: docs/reference/poolpointer.md. The word is
// - in decode a group's word: candidates, background and their significances;
// - in choose the first pointer words of two pixels of a column, or, with giving_used, the candidates of a group that some pixel uses
//   (PRIOR = 1), for decode of the next frame;
// - 0 from the clock after an operation on, while the SRAMs are cleared, and in decide.
//
// 1. take_word takes a pixel's first pointer word. With RIVAL_MOVES = 1 the rival's cell is delayed by two take_position, until dtof_smoothing has
//    moved the leader's start closer to its neighbours' starts.
// 2. The word is registered here because the wires to the pairs are long. A pair registers it one clock before it writes it.
//
// Schedule: the table of dtof_pool_sequencer. Latency: 1 clock from the decoder's outputs to word_o, 2 clocks from take_word.
// Cost: registers for half a word and for two pixels' words; with RIVAL_MOVES = 1 14 flip-flops; with PRIOR = 1 3 LABELS flip-flops.

`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_engine_word `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    parameter int PRIOR = 0,
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH,
    localparam int RIVAL_WIDTH = dtof_pkg::POOL_RIVAL_WIDTH,
    localparam int PIXEL_WIDTH = dtof_pkg::pool_pixel_width(LABELS, SCORE_BITS, OFFSET_BITS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES),
    localparam int GROUP_WIDTH = dtof_pkg::pool_group_width(LABELS, PIXEL_WIDTH),
    localparam int KEPT_WIDTH = dtof_pkg::pool_background_width(LABELS, PIXEL_WIDTH),
    localparam int HALF_WIDTH = dtof_pkg::max_of(2 * PIXEL_WIDTH, GROUP_WIDTH),
    localparam int SIGNIFICANCE_WIDTH = dtof_pkg::pool_significance_width(LABELS, PIXEL_WIDTH, ADVANTAGE_WIDTH, RIVAL_MOVES, PRIOR)
) (
    input  logic                         clk_i,
    input  logic                         rst_ni,
    input  `DTOF_TYPE(dtof_pool_pkg, pool_engine_command_t) command_i,
    // decode
    input  logic [LABELS*CELL_WIDTH-1:0] cells_i,
    input  logic [       KEPT_WIDTH-1:0] background_i,    // highest bits of B
    input  logic [dtof_pkg::max_of(LABELS * SIGNIFICANCE_WIDTH, 1)-1:0] significances_i,
    input  logic                         tilted_i,
    // choose
    input  logic [      LABEL_WIDTH-1:0] best_label_i,
    input  logic [      LABEL_WIDTH-1:0] second_label_i,
    input  logic [      RIVAL_WIDTH-1:0] second_cell_i,   // with take_position: cell at which the rival starts
    input  logic [                 15:0] start_i,         // with take_word: leader's start
    input  logic [  ADVANTAGE_WIDTH-1:0] advantage_i,     // with take_word
    input  logic [       HALF_WIDTH-1:0] group_i,         // with take_used: the group's word
    output logic [       HALF_WIDTH-1:0] word_o
);

  localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES);
  localparam int EVIDENCE_FIRST = GROUP_WIDTH + ((PRIOR != 0) ? LABELS : 0);  // {significances, tilted} in a group's word

  // Choose: first pointer words.

  logic [PIXEL_WIDTH-1:0] first_word;
  logic [2*PIXEL_WIDTH-1:0] new_pair_q;

  generate
    if (RIVAL_MOVES != 0) begin : g_absolute_word
      logic [RIVAL_WIDTH-1:0] rival_q, next_rival_q;
      always_ff @(posedge clk_i) begin
        if (command_i.choosing && command_i.take_position) begin
          next_rival_q <= second_cell_i;
          rival_q <= next_rival_q;
        end
      end
      assign first_word = PIXEL_WIDTH'({advantage_i, rival_q, start_i[15:POINTER_SHIFT]});
      logic unused_label;
      assign unused_label = ^second_label_i;
    end else begin : g_relative_word
      assign first_word = PIXEL_WIDTH'({advantage_i, second_label_i, best_label_i, {POINTER_WIDTH{1'b0}}});
      logic unused_cell;
      assign unused_cell = ^second_cell_i;
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    if (command_i.take_word && command_i.odd_word) begin
      new_pair_q[2*PIXEL_WIDTH-1:PIXEL_WIDTH] <= first_word;
    end else if (command_i.take_word) begin
      new_pair_q[PIXEL_WIDTH-1:0] <= first_word;
    end
  end

  // Candidates of a group that some pixel uses: those that the pair's left column has used, and those of this column. The next group's
  // first pixel arrives before they are written, so so_far_q begins anew while used_q still holds the group before.

  logic [HALF_WIDTH-1:0] done_word;

  generate
    if (PRIOR != 0) begin : g_used
      logic [LABELS-1:0] left_used_q, so_far_q, used_q;
      always_ff @(posedge clk_i) begin
        if (command_i.take_used) begin
          left_used_q <= group_i[GROUP_WIDTH+:LABELS];
        end
        if (command_i.take_choice) begin
          so_far_q <= (command_i.next_group ? left_used_q : so_far_q) | (LABELS'(1) << best_label_i);
        end
        if (command_i.next_group) begin
          used_q <= so_far_q;
        end
      end
      assign done_word = command_i.giving_used ? HALF_WIDTH'(used_q) << GROUP_WIDTH : HALF_WIDTH'(new_pair_q);
    end else begin : g_not_used
      assign done_word = HALF_WIDTH'(new_pair_q);
    end
  endgenerate

  // Decode: the group's word.

  logic [HALF_WIDTH-1:0] new_evidence;  // significances and tilted flag of the group's candidates
  generate
    if (SIGNIFICANCE_WIDTH != 0) begin : g_new_evidence
      assign new_evidence = HALF_WIDTH'({significances_i, tilted_i}) << EVIDENCE_FIRST;
    end else begin : g_no_new_evidence
      assign new_evidence = '0;
      logic unused_new_evidence;
      assign unused_new_evidence = ^{significances_i, tilted_i};
    end
  endgenerate

  // The output.

  logic active, was_active_q;

  assign active = command_i.decoding || command_i.choosing || command_i.deciding;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      was_active_q <= 1'b1;
    end else begin
      was_active_q <= active;
    end
  end

  always_ff @(posedge clk_i) begin
    if (active || was_active_q) begin
      word_o <= ((HALF_WIDTH'({background_i, cells_i}) | new_evidence) & {HALF_WIDTH{command_i.decoding}})
          | (done_word & {HALF_WIDTH{command_i.choosing}});
    end
  end

  logic unused;
  assign unused = ^{command_i, best_label_i, start_i, group_i};

endmodule

`default_nettype wire
