// SPDX-License-Identifier: Apache-2.0
// poolPointer: what needs several pixels of a column at once, shared by ENGINE_COLUMNS columns.
//
// Decode makes the groups' words of the coarse histogram, choose the first pointer words of the track words,
// decide the results of the pointer words (docs/reference/poolpointer.md). Messages of a chain's first pass wait in a
// scratch memory, one word a pixel.
//
// 1. The line, the selected column's word, is registered. Decode hands it to the candidate decoder, whose group word is
//    written back.
// 2. Choose and decide take from it first a pixel's word and then its group's, which together make the pixel that is
//    prepared for the chain: labels with evidence and position, and the penalty.
// 3. The chain of the operation in work steps on, and its messages of the first pass wait in the scratch memory.
// 4. Of the best two labels choose makes the pixel's first pointer word, and two of these a word to write; decide makes
//    the result.
//
// It knows neither rows nor columns nor clocks: in each clock it does what the command says, and nothing else.
//
// Schedule: the table of engine_sequencer, with this module's POOL_ENGINE_*_CLOCKS (dtof_pkg).
// Cost: candidate_decoder, two label_chains, a single-port SRAM of PIXELS_PER_SRAM words, per engine.
`include "engine_command.svh"

module pool_engine #(
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int COUNT_WIDTH = 7,
    parameter int DARK_LABELS = 5,
    parameter int DARK_SCORE_BITS = 4,
    parameter int BRIGHT_LABELS = 5,
    parameter int BRIGHT_SCORE_BITS = 4,
    parameter int BRIGHT_FROM = 6,
    parameter int OFFSET_BITS = 5,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    parameter int SECOND_TARGET = 0,  // 1: the result has the position of the label that lost, too
    localparam int LABELS = dtof_pkg::max_of(DARK_LABELS, BRIGHT_LABELS),
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int GROUP_WIDTH = dtof_pkg::pool_group_width(LABELS),
    localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(DARK_LABELS, DARK_SCORE_BITS, BRIGHT_LABELS,
                                                            BRIGHT_SCORE_BITS, OFFSET_BITS),
    localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES),
    localparam int PIXEL_WIDTH = dtof_pkg::max_of(TRACK_WIDTH, POINT_WIDTH),
    localparam int WORD_WIDTH = dtof_pkg::max_of(2 * PIXEL_WIDTH, GROUP_WIDTH),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int CONFIDENCE_WIDTH = dtof_pkg::pool_confidence_width(ADVANTAGE_WIDTH),
    localparam int RESULT_WIDTH = dtof_pkg::pool_result_width(ADVANTAGE_WIDTH, SECOND_TARGET)
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    // side band of the SRAM macros, which the technology folder gives a meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    input  engine_command_t         command_i,
    input  logic [  WORD_WIDTH-1:0] line_i,         // the selected column's word, POOL_PAIR_READ_CLOCKS after its read
    output logic [  WORD_WIDTH-1:0] word_o,         // what is written: the group's word, or two first pointer words
    input  logic [   ROW_WIDTH-1:0] message_row_i,  // of command_i.write_message and read_message
    // {code, fraction, confidence}, with SECOND_TARGET {second code, second fraction, code, fraction, confidence};
    // held from one take_result to the next
    output logic [RESULT_WIDTH-1:0] result_o
);

  localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH;
  localparam int BACKGROUND_WIDTH = dtof_pkg::POOL_BACKGROUND_WIDTH;
  localparam int BINS_PER_WORD = dtof_pkg::pool_bins_per_word(WORD_WIDTH, COUNT_WIDTH);
  localparam int SCORES_WIDTH = dtof_pkg::max_of(DARK_LABELS * DARK_SCORE_BITS, BRIGHT_LABELS * BRIGHT_SCORE_BITS);
  localparam int SCORE_WIDTH = dtof_pkg::max_of(DARK_SCORE_BITS, BRIGHT_SCORE_BITS);
  localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES);
  localparam int RIVAL_WIDTH = dtof_pkg::POOL_RIVAL_WIDTH;
  localparam int FIRST_PENALISED_LABEL = 2;

  localparam int CHOOSE_PENALTY_WIDTH = dtof_pkg::POOL_CHOOSE_PENALTY_WIDTH;
  localparam int DECIDE_PENALTY_WIDTH = dtof_pkg::POOL_DECIDE_PENALTY_WIDTH;
  // A score less up to 2^CHOOSE_PENALTY_WIDTH - 1; an advantage or nothing.
  localparam int CHOOSE_EVIDENCE_WIDTH = dtof_pkg::max_of(SCORE_WIDTH, CHOOSE_PENALTY_WIDTH) + 1;
  localparam int DECIDE_EVIDENCE_WIDTH = ADVANTAGE_WIDTH + 1;
  localparam int CELL_POSITION_WIDTH = CELL_WIDTH + 1;
  localparam int POSITION_WIDTH = 18;
  localparam int CHOOSE_MESSAGE_WIDTH = LABELS * CHOOSE_PENALTY_WIDTH;
  localparam int DECIDE_MESSAGE_WIDTH = 2 * DECIDE_PENALTY_WIDTH;
  localparam int MESSAGE_WIDTH = dtof_pkg::max_of(CHOOSE_MESSAGE_WIDTH, DECIDE_MESSAGE_WIDTH);

  logic [WORD_WIDTH-1:0] line_q;
  always_ff @(posedge clk_i) begin
    line_q <= line_i;
  end

  // Decode.

  logic [LABELS*CELL_WIDTH-1:0] new_cells;
  logic [BACKGROUND_WIDTH-1:0] new_background;

  candidate_decoder #(
      .COUNT_WIDTH  (COUNT_WIDTH),
      .LABELS       (LABELS),
      .BINS_PER_WORD(BINS_PER_WORD)
  ) u_candidate_decoder (
      .clk_i       (clk_i),
      .command_i   (command_i.decode),
      .line_i      (line_q[BINS_PER_WORD*COUNT_WIDTH-1:0]),
      .cells_o     (new_cells),
      .background_o(new_background)
  );

  // A pixel prepared for the chains: its word was captured, its group's is on the line.

  logic [PIXEL_WIDTH-1:0] pixel_q;
  logic [LABELS*CELL_WIDTH-1:0] cells;
  logic [BACKGROUND_WIDTH-1:0] background;
  logic bright;

  always_ff @(posedge clk_i) begin
    if (command_i.take_pixel) begin
      pixel_q <= command_i.odd_pixel ? line_q[2*PIXEL_WIDTH-1:PIXEL_WIDTH] : line_q[PIXEL_WIDTH-1:0];
    end
  end

  assign cells = line_q[LABELS*CELL_WIDTH-1:0];
  assign background = line_q[LABELS*CELL_WIDTH+:BACKGROUND_WIDTH];
  assign bright = (BRIGHT_FROM == 0) || (background >= BACKGROUND_WIDTH'(BRIGHT_FROM));

  logic [LABELS-1:0] in_use;
  logic [LABELS*CHOOSE_EVIDENCE_WIDTH-1:0] choose_evidence;
  logic [LABELS*CELL_POSITION_WIDTH-1:0] choose_position;

  genvar k;
  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_label
      logic [SCORE_WIDTH-1:0] dark_score, bright_score;
      logic [CHOOSE_EVIDENCE_WIDTH-1:0] score, penalty;
      if (k < DARK_LABELS) begin : g_dark
        assign dark_score = SCORE_WIDTH'(pixel_q[k*DARK_SCORE_BITS+:DARK_SCORE_BITS]);
      end else begin : g_no_dark
        assign dark_score = '0;
      end
      if (k < BRIGHT_LABELS) begin : g_bright
        assign bright_score = SCORE_WIDTH'(pixel_q[k*BRIGHT_SCORE_BITS+:BRIGHT_SCORE_BITS]);
      end else begin : g_no_bright
        assign bright_score = '0;
      end
      assign in_use[k] = bright ? (k < BRIGHT_LABELS) : (k < DARK_LABELS);
      assign score = bright ? CHOOSE_EVIDENCE_WIDTH'(bright_score) : CHOOSE_EVIDENCE_WIDTH'(dark_score);
      assign penalty = (k >= FIRST_PENALISED_LABEL) ? CHOOSE_EVIDENCE_WIDTH'(background >> 2) : '0;
      assign choose_evidence[k*CHOOSE_EVIDENCE_WIDTH+:CHOOSE_EVIDENCE_WIDTH] = score - penalty;
      assign choose_position[k*CELL_POSITION_WIDTH+:CELL_POSITION_WIDTH] = {1'b0, cells[k*CELL_WIDTH+:CELL_WIDTH]};
    end
  endgenerate

  logic [POSITION_WIDTH-1:0] leader_position, rival_position;
  generate
    if (RIVAL_MOVES != 0) begin : g_absolute
      assign leader_position = POSITION_WIDTH'(pixel_q[POINTER_WIDTH-1:0]) << POINTER_SHIFT;
      assign rival_position = POSITION_WIDTH'({pixel_q[POINTER_WIDTH+:RIVAL_WIDTH], 9'h100});
    end else begin : g_relative
      logic [LABEL_WIDTH-1:0] leader, rival;
      logic [POSITION_WIDTH-1:0] pointer;
      assign leader = pixel_q[POINTER_WIDTH+:LABEL_WIDTH];
      assign rival = pixel_q[POINTER_WIDTH+LABEL_WIDTH+:LABEL_WIDTH];
      assign pointer = {{(POSITION_WIDTH - POINTER_WIDTH) {pixel_q[POINTER_WIDTH-1]}}, pixel_q[POINTER_WIDTH-1:0]};
      assign leader_position = POSITION_WIDTH'({cells[leader*CELL_WIDTH+:CELL_WIDTH], 9'd0}) + (pointer << POINTER_SHIFT);
      assign rival_position = POSITION_WIDTH'({cells[rival*CELL_WIDTH+:CELL_WIDTH], 9'd0});
    end
  endgenerate

  // Chains and their scratch memory.

  logic [CHOOSE_MESSAGE_WIDTH-1:0] choose_message;
  logic [DECIDE_MESSAGE_WIDTH-1:0] decide_message;
  logic [MESSAGE_WIDTH-1:0] scratch_in, scratch_out;

  assign scratch_in = command_i.deciding ? MESSAGE_WIDTH'(decide_message) : MESSAGE_WIDTH'(choose_message);

  dtof_sram #(
      .PORTS(1),
      .DEPTH(PIXELS_PER_SRAM),
      .WIDTH(MESSAGE_WIDTH)
  ) u_scratch_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (sram_cfg_o),
      .read_en_i   (command_i.read_message),
      .read_addr_i (message_row_i),
      .read_data_o (scratch_out),
      .write_en_i  (command_i.write_message),
      .write_addr_i(message_row_i),
      .write_data_i(scratch_in)
  );

  logic [LABEL_WIDTH-1:0] best_label, second_label;
  logic [CELL_POSITION_WIDTH-1:0] best_cell, second_cell;
  logic [CHOOSE_EVIDENCE_WIDTH+1:0] choose_margin;

  label_chain #(
      .LABELS        (LABELS),
      .POSITION_WIDTH(CELL_POSITION_WIDTH),
      .REACH         (4),
      .EVIDENCE_WIDTH(CHOOSE_EVIDENCE_WIDTH),
      .PENALTY_WIDTH (CHOOSE_PENALTY_WIDTH)
  ) u_choose (
      .clk_i            (clk_i),
      .command_i        (command_i.choose),
      .in_use_i         (in_use),
      .evidence_i       (choose_evidence),
      .position_i       (choose_position),
      .penalty_i        (CHOOSE_PENALTY_WIDTH'(background >> 2) + CHOOSE_PENALTY_WIDTH'(2)),
      .message_o        (choose_message),
      .other_message_i  (scratch_out[CHOOSE_MESSAGE_WIDTH-1:0]),
      .best_label_o     (best_label),
      .second_label_o   (second_label),
      .best_position_o  (best_cell),
      .second_position_o(second_cell),
      .margin_o         (choose_margin)
  );

  logic decided_rival, unused_loser;
  logic [POSITION_WIDTH-1:0] position, lost_position;
  logic [DECIDE_EVIDENCE_WIDTH+1:0] decide_margin;

  label_chain #(
      .LABELS        (2),
      .POSITION_WIDTH(POSITION_WIDTH),
      .REACH         (2048),
      .EVIDENCE_WIDTH(DECIDE_EVIDENCE_WIDTH),
      .PENALTY_WIDTH (DECIDE_PENALTY_WIDTH)
  ) u_decide (
      .clk_i            (clk_i),
      .command_i        (command_i.decide),
      .in_use_i         (2'b11),
      .evidence_i       ({{DECIDE_EVIDENCE_WIDTH{1'b0}}, 1'b0, pixel_q[POINT_WIDTH-1-:ADVANTAGE_WIDTH]}),
      .position_i       ({rival_position, leader_position}),
      .penalty_i        (DECIDE_PENALTY_WIDTH'(background >> 3) + DECIDE_PENALTY_WIDTH'(4)),
      .message_o        (decide_message),
      .other_message_i  (scratch_out[DECIDE_MESSAGE_WIDTH-1:0]),
      .best_label_o     (decided_rival),
      .second_label_o   (unused_loser),
      .best_position_o  (position),
      .second_position_o(lost_position),
      .margin_o         (decide_margin)
  );

  // Choose: the first pointer word. The leader's offset comes along with its pixel.

  logic [15:0] best_start, second_start;
  logic [PIXEL_WIDTH-1:0] first_word;
  logic [ADVANTAGE_WIDTH-1:0] start_advantage;
  logic [2*PIXEL_WIDTH-1:0] new_pair_q;

  generate
    if (OFFSET_BITS > 0) begin : g_offset
      localparam int LEAD_WIDTH = LABEL_WIDTH + OFFSET_BITS;  // {offset, leader}
      logic [LEAD_WIDTH-1:0] next_lead_q, lead_q, last_lead_q;
      logic [15:0] offset;
      always_ff @(posedge clk_i) begin
        if (command_i.choose.advance) begin
          next_lead_q <= pixel_q[SCORES_WIDTH+:LEAD_WIDTH];
          lead_q <= next_lead_q;
          last_lead_q <= lead_q;
        end
      end
      assign offset = {{(10 - OFFSET_BITS) {last_lead_q[LEAD_WIDTH-1]}}, last_lead_q[LABEL_WIDTH+:OFFSET_BITS], 6'd0};
      assign best_start = {best_cell[CELL_WIDTH-1:0], 9'd0} + ((last_lead_q[LABEL_WIDTH-1:0] == best_label) ? offset : '0);
      assign second_start = {second_cell[CELL_WIDTH-1:0], 9'd0}
          + ((last_lead_q[LABEL_WIDTH-1:0] == second_label) ? offset : '0);
    end else begin : g_no_offset
      assign best_start = {best_cell[CELL_WIDTH-1:0], 9'd0};
      assign second_start = {second_cell[CELL_WIDTH-1:0], 9'd0};
    end
  endgenerate

  localparam int HALF_ADVANTAGE = 1 << (ADVANTAGE_WIDTH - 1);
  assign start_advantage = (32'(choose_margin) >= HALF_ADVANTAGE) ? ADVANTAGE_WIDTH'(HALF_ADVANTAGE - 1)
      : ADVANTAGE_WIDTH'(choose_margin);

  generate
    if (RIVAL_MOVES != 0) begin : g_absolute_word
      assign first_word = PIXEL_WIDTH'({start_advantage, second_start[15:9], best_start[15:POINTER_SHIFT]});
    end else begin : g_relative_word
      logic [15:0] from_candidate;
      logic unused_offset;
      assign unused_offset = ^from_candidate;
      assign from_candidate = best_start - {best_cell[CELL_WIDTH-1:0], 9'd0};
      assign first_word = PIXEL_WIDTH'({start_advantage, second_label, best_label,
                                        from_candidate[POINTER_SHIFT+:POINTER_WIDTH]});
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    if (command_i.take_choice && command_i.odd_result) begin
      new_pair_q[2*PIXEL_WIDTH-1:PIXEL_WIDTH] <= first_word;
    end else if (command_i.take_choice) begin
      new_pair_q[PIXEL_WIDTH-1:0] <= first_word;
    end
  end

  assign word_o = command_i.decoding ? WORD_WIDTH'({new_background, new_cells}) : WORD_WIDTH'(new_pair_q);

  // Decide: a position counts from its bin's low end, a timestamp stands for the middle of its bin.

  localparam int F = 16 - NP;
  localparam logic signed [POSITION_WIDTH-1:0] HALF_BIN = POSITION_WIDTH'((1 << F) / 2);
  localparam logic signed [POSITION_WIDTH-1:0] LAST_POSITION = POSITION_WIDTH'(65536 - (1 << F) - 1);
  logic signed [POSITION_WIDTH-1:0] shifted;
  logic [15:0] limited;

  assign shifted = $signed(position) - HALF_BIN;
  assign limited = (shifted < 0) ? '0 : (shifted > LAST_POSITION) ? 16'(LAST_POSITION) : shifted[15:0];

  generate
    if (SECOND_TARGET != 0) begin : g_second_target
      logic signed [POSITION_WIDTH-1:0] lost_shifted;
      logic [15:0] lost_limited;
      assign lost_shifted = $signed(lost_position) - HALF_BIN;
      assign lost_limited = (lost_shifted < 0) ? '0
          : (lost_shifted > LAST_POSITION) ? 16'(LAST_POSITION) : lost_shifted[15:0];
      always_ff @(posedge clk_i) begin
        if (command_i.take_result) begin
          result_o <= {lost_limited, limited, decide_margin[CONFIDENCE_WIDTH-1:0]};
        end
      end
    end else begin : g_one_target
      logic unused_position;
      assign unused_position = ^lost_position;
      always_ff @(posedge clk_i) begin
        if (command_i.take_result) begin
          result_o <= {limited, decide_margin[CONFIDENCE_WIDTH-1:0]};
        end
      end
    end
  endgenerate

  logic unused;
  assign unused = ^{decided_rival, unused_loser, decide_margin, best_cell[CELL_WIDTH], second_cell[CELL_WIDTH],
                    second_start};

endmodule
