// SPDX-License-Identifier: Apache-2.0
// poolPointer: does what needs several pixels at once, for ENGINE_COLUMNS columns one after the other.
//
// Operations (docs/reference/poolpointer.md, Decode, Choose, Decide): decode makes the groups' words from the coarse histograms; choose
// makes the first pointer words from the track words; decide makes the results from the pointer words. The scratch memory has a word for
// each row: the messages of a chain's first pass, and the best label of the column to the left (choose: its cell and offset; decide:
// its position).
//
// 1. The line carries the word that a pair of columns has read. Decode passes it to the candidate decoder; the pair then writes
//    the decoder's group word.
// 2. Choose and decide take a pixel's word from the line and, one clock later, its group's word: the pixel is prepared. In choose
//    dtof_beside_evidence adds the evidence of the neighbouring columns before the pixel enters the chain.
// 3. The operation's chain (dtof_label_chain) handles one pixel per step. Messages of the first pass are kept in the scratch memory.
// 4. From the best two labels choose makes the pixel's first pointer word; two such words are written together. dtof_smoothing moves the
//    starts of the pointers (with RIVAL_MOVES = 0: not) and decide's winners, and makes decide's result.
// 5. With PRIOR = 1 choose also collects which candidates of a group are used, for decode of the next frame.
//
// An engine has no counters of rows, columns or clocks: in each clock it executes the command, and nothing else.
//
// Schedule: the table of dtof_pool_sequencer. Latency: POOL_ENGINE_*_CLOCKS (dtof_pkg).
// Cost: dtof_pool_candidate_decoder, dtof_beside_evidence, two dtof_label_chain, a single-port SRAM with a word per row, per engine.

`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_engine `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int COUNT_WIDTH = 7,
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    parameter int CELL_SHIFT = 9,
    parameter int PARITY = 0,  // 1: the scratch memory's words have parity bits
    parameter int SECOND_TARGET = 0,
    parameter int AMPLITUDE = 0,
    parameter int PRIOR = 0,
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(LABELS, SCORE_BITS, OFFSET_BITS),
    localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES),
    localparam int PIXEL_WIDTH = dtof_pkg::max_of(TRACK_WIDTH, POINT_WIDTH),
    localparam int GROUP_WIDTH = dtof_pkg::pool_group_width(LABELS, PIXEL_WIDTH),
    localparam int HALF_WIDTH = dtof_pkg::max_of(2 * PIXEL_WIDTH, GROUP_WIDTH),
    localparam int LINE_HALVES = dtof_pkg::pool_line_halves(HALF_WIDTH, COUNT_WIDTH),
    localparam int LINE_WIDTH = LINE_HALVES * HALF_WIDTH,
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int SIGNIFICANCE_WIDTH = dtof_pkg::pool_significance_width(LABELS, PIXEL_WIDTH, ADVANTAGE_WIDTH, RIVAL_MOVES, PRIOR),
    localparam int CONFIDENCE_WIDTH = dtof_pkg::pool_confidence_width(ADVANTAGE_WIDTH),
    localparam int DEPTH_WIDTH = dtof_pkg::pool_result_width(ADVANTAGE_WIDTH, SECOND_TARGET),
    // {background as the group's word stores it, advantage}
    localparam int LIGHT_WIDTH = (AMPLITUDE != 0) ? dtof_pkg::pool_background_width(LABELS, PIXEL_WIDTH) + ADVANTAGE_WIDTH : 0,
    localparam int RESULT_WIDTH = DEPTH_WIDTH + LIGHT_WIDTH
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    // side band of the SRAM macros; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // chain of damaged words, with PARITY = 1
    input  logic                    next_parity_error_i,
    output logic                    parity_error_o,
    input  logic                    smooth_i,       // S1 is on
    input  logic                    has_right_i,    // choose: a column to the right exists; decode: a pair to the right exists
    input  logic [dtof_pkg::POOL_SIGNIFICANCE_OFFSET_WIDTH-1:0] significance_offset_i,  // correction for long frames
    input  logic [dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] template_i,  // decode: entry of TEMPLATE for the bin whose sum begins; hidden_i: that bin is hidden
    input  logic                    hidden_i,
    input  `DTOF_TYPE(dtof_pool_pkg, pool_engine_command_t) command_i,
    input  logic [  LINE_WIDTH-1:0] line_i,         // the word that was read, POOL_PAIR_READ_CLOCKS + POOL_LINE_CLOCKS after its read
    output logic [  HALF_WIDTH-1:0] word_o,         // the word to write: a group's word, or two first pointer words
    input  logic [   ROW_WIDTH-1:0] scratch_row_i,  // row of write_scratch and read_scratch
    // {code, fraction, confidence}, with SECOND_TARGET = 1 {second code, second fraction, code, ...}, with AMPLITUDE = 1 {background,
    // advantage} above; holds from one take_result to the next
    output logic [RESULT_WIDTH-1:0] result_o
);

  localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH;
  localparam int BACKGROUND_WIDTH = dtof_pkg::POOL_BACKGROUND_WIDTH;
  localparam int KEPT_WIDTH = dtof_pkg::pool_background_width(LABELS, PIXEL_WIDTH);  // highest bits of B that a group's word stores
  localparam int SCORES_WIDTH = LABELS * SCORE_BITS;
  localparam int LEAD_WIDTH = LABEL_WIDTH + OFFSET_BITS;  // {offset, leader}
  localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES);
  localparam int RIVAL_WIDTH = dtof_pkg::POOL_RIVAL_WIDTH;
  localparam int SMOOTH_BRIGHT_FROM = 6;
  localparam int HALF_BINS_WIDTH = dtof_pkg::POOL_BINS_PER_LINE / LINE_HALVES * COUNT_WIDTH;
  localparam int BINS_WIDTH = dtof_pkg::POOL_BINS_PER_LINE * COUNT_WIDTH;
  localparam int CHOOSE_PENALTY_WIDTH = 4;  // 2 + (5 * 39 >> 4) at most
  localparam int DECIDE_PENALTY_WIDTH = 2;
  localparam int CHOOSE_EVIDENCE_WIDTH = dtof_pkg::POOL_EVIDENCE_WIDTH;
  localparam int DECIDE_EVIDENCE_WIDTH = ADVANTAGE_WIDTH + 1;
  localparam int CELL_POSITION_WIDTH = CELL_WIDTH + 1;
  localparam int POSITION_WIDTH = 17;
  localparam int CHOOSE_MESSAGE_WIDTH = LABELS * CHOOSE_PENALTY_WIDTH;
  localparam int DECIDE_MESSAGE_WIDTH = 2 * DECIDE_PENALTY_WIDTH;
  localparam int LEFT_WIDTH = CELL_WIDTH + OFFSET_BITS;  // choose: cell and offset of a column's best label
  // Decide: {margin, position} of the winner; without significances the position alone.
  localparam int WINNER_WIDTH = 16 + ((SIGNIFICANCE_WIDTH != 0) ? CONFIDENCE_WIDTH : 0);
  localparam int EVIDENCE_FIRST = GROUP_WIDTH + ((PRIOR != 0) ? LABELS : 0);  // {significances, tilted} in a group's word
  localparam int SCRATCH_WIDTH = dtof_pkg::max_of(CHOOSE_MESSAGE_WIDTH + LEFT_WIDTH, DECIDE_MESSAGE_WIDTH + WINNER_WIDTH);

  `DTOF_TYPE(dtof_pool_pkg, beside_command_t) beside;
  assign beside = command_i.beside;

  // Outside an operation registers hold. word_o becomes 0 in the clock after an operation.

  logic active, was_active_q;
  logic [LINE_WIDTH-1:0] line_q;

  assign active = command_i.decoding || command_i.choosing || command_i.deciding;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      was_active_q <= 1'b1;
    end else begin
      was_active_q <= active;
    end
  end

  always_ff @(posedge clk_i) begin
    if (active) begin
      line_q <= line_i;
    end
  end

  // Decode.

  logic [BINS_WIDTH-1:0] line_bins;
  genvar h;
  generate
    for (h = 0; h < LINE_HALVES; h = h + 1) begin : g_half
      assign line_bins[h*HALF_BINS_WIDTH+:HALF_BINS_WIDTH] = line_i[h*HALF_WIDTH+:HALF_BINS_WIDTH];
    end
  endgenerate

  logic [LABELS*CELL_WIDTH-1:0] new_cells;
  logic [BACKGROUND_WIDTH-1:0] new_background;
  logic [dtof_pkg::max_of(LABELS * SIGNIFICANCE_WIDTH, 1)-1:0] new_significances;
  logic new_tilted;

  logic [LABELS-1:0] last_used;  // used candidates of the group whose word is at line_i
  generate
    if (PRIOR != 0) begin : g_last_used
      assign last_used = line_i[GROUP_WIDTH+:LABELS];
    end else begin : g_no_last_used
      assign last_used = '0;
    end
  endgenerate

  dtof_pool_candidate_decoder #(
      .COUNT_WIDTH       (COUNT_WIDTH),
      .LABELS            (LABELS),
      .PRIOR             (PRIOR),
      .SIGNIFICANCE_WIDTH(SIGNIFICANCE_WIDTH)
  ) u_candidate_decoder (
      .clk_i       (clk_i),
      .active_i    (command_i.decoding),
      .command_i   (command_i.decode),
      .line_i      (line_bins),
      .last_cells_i(line_i[LABELS*CELL_WIDTH-1:0]),
      .last_used_i (last_used),
      .template_i  (template_i),
      .hidden_i    (hidden_i),
      .has_right_i (has_right_i),
      .significance_offset_i(significance_offset_i),
      .cells_o     (new_cells),
      .significances_o(new_significances),
      .tilted_o    (new_tilted),
      .background_o(new_background)
  );

  // Preparation of a pixel: its word was captured, its group's word is on the line. Each step of the chain moves the pixel on.

  logic advance;
  logic [PIXEL_WIDTH-1:0] line_pixel, captured_q, prepared_q;
  logic [LABELS*CHOOSE_EVIDENCE_WIDTH-1:0] choose_evidence;
  logic [LABELS*CELL_WIDTH-1:0] cells;
  logic [BACKGROUND_WIDTH-1:0] line_background, background;
  logic [LEAD_WIDTH-1:0] prepared_lead, next_lead_q, lead_q, last_lead_q;
  logic prepared_bright_q, next_bright_q, bright_q, last_bright_q;
  logic [SCRATCH_WIDTH-1:0] scratch;
  logic [CELL_WIDTH-1:0] left_cell;

  assign advance = command_i.choose.advance || command_i.decide.advance;
  // The low bits that the group's word does not store are replaced by the middle of their range.
  assign line_background = (BACKGROUND_WIDTH'(line_q[LABELS*CELL_WIDTH+:KEPT_WIDTH]) << (BACKGROUND_WIDTH - KEPT_WIDTH))
      | BACKGROUND_WIDTH'((1 << (BACKGROUND_WIDTH - KEPT_WIDTH)) >> 1);
  assign line_pixel = command_i.odd_pixel ? line_q[PIXEL_WIDTH+:PIXEL_WIDTH] : line_q[PIXEL_WIDTH-1:0];

  generate
    if (OFFSET_BITS != 0) begin : g_lead
      assign prepared_lead = prepared_q[SCORES_WIDTH+:LEAD_WIDTH];
    end else begin : g_no_lead
      assign prepared_lead = '0;
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    if (command_i.take_pixel) begin
      captured_q <= line_pixel;
    end
    if (advance) begin
      prepared_q <= captured_q;
      prepared_bright_q <= (line_background >= BACKGROUND_WIDTH'(SMOOTH_BRIGHT_FROM));
      {next_lead_q, next_bright_q} <= {prepared_lead, prepared_bright_q};
      {lead_q, bright_q} <= {next_lead_q, next_bright_q};
      {last_lead_q, last_bright_q} <= {lead_q, bright_q};
    end
  end

  dtof_beside_evidence #(
      .LABELS    (LABELS),
      .SCORE_BITS(SCORE_BITS)
  ) u_beside_evidence (
      .clk_i         (clk_i),
      .command_i     (beside),
      .right_scores_i(line_pixel[SCORES_WIDTH-1:0]),
      .has_right_i   (has_right_i),
      .advance_i     (advance),
      .scores_i      (captured_q[SCORES_WIDTH-1:0]),
      .group_i       ({line_background, line_q[LABELS*CELL_WIDTH-1:0]}),
      .left_cell_i   (left_cell),
      .evidence_o    (choose_evidence),
      .cells_o       (cells),
      .background_o  (background)
  );

  // Chains, and their scratch memory: {messages, best label of the left column}. The second pass writes the column's own best label.

  logic [LABELS*CELL_POSITION_WIDTH-1:0] choose_position;
  logic [BACKGROUND_WIDTH+2:0] five_backgrounds;
  logic [CHOOSE_PENALTY_WIDTH-1:0] choose_penalty;
  logic [CHOOSE_MESSAGE_WIDTH-1:0] choose_message;
  logic [DECIDE_MESSAGE_WIDTH-1:0] decide_message;
  logic [SCRATCH_WIDTH-1:0] choose_scratch, decide_scratch;
  logic [LABEL_WIDTH-1:0] best_label, second_label;
  logic [CELL_POSITION_WIDTH-1:0] best_cell, second_cell;
  logic [CHOOSE_EVIDENCE_WIDTH+1:0] choose_margin;
  logic [LEFT_WIDTH-1:0] best_lead;
  logic [POSITION_WIDTH-1:0] position;  // winner of decide
  logic [WINNER_WIDTH-1:0] winner;
  logic [DECIDE_EVIDENCE_WIDTH+1:0] decide_margin;
  logic [LEFT_WIDTH-1:0] written_left;

  genvar k;
  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_label
      assign choose_position[k*CELL_POSITION_WIDTH+:CELL_POSITION_WIDTH] = {1'b0, cells[k*CELL_WIDTH+:CELL_WIDTH]};
    end
  endgenerate

  assign five_backgrounds = (BACKGROUND_WIDTH + 3)'(background) + ((BACKGROUND_WIDTH + 3)'(background) << 2);
  assign choose_penalty = CHOOSE_PENALTY_WIDTH'(five_backgrounds >> 4) + CHOOSE_PENALTY_WIDTH'(2);
  assign left_cell = scratch[CELL_WIDTH-1:0];
  generate
    if (PARITY != 0) begin : g_written_left
      // The first column writes zeros for the column to its left, so that no word has bits that were never written.
      assign written_left = scratch[LEFT_WIDTH-1:0] & {LEFT_WIDTH{command_i.beside.has_left}};
    end else begin : g_left
      assign written_left = scratch[LEFT_WIDTH-1:0];
    end
  endgenerate
  assign choose_scratch = SCRATCH_WIDTH'({choose_message, command_i.back ? best_lead : written_left});
  generate
    if (SIGNIFICANCE_WIDTH != 0) begin : g_winner_margin
      assign winner = {decide_margin[CONFIDENCE_WIDTH-1:0], position[15:0]};
    end else begin : g_winner
      assign winner = position[15:0];
    end
  endgenerate
  assign decide_scratch = SCRATCH_WIDTH'({decide_message, command_i.back ? winner : scratch[WINNER_WIDTH-1:0]});

  logic damaged, unwritten_q;

  // The first column's words are read before they are written: what they have of a column to the left has no effect.
  always_ff @(posedge clk_i) begin
    unwritten_q <= (PARITY != 0) && command_i.choosing && !command_i.back && !command_i.beside.has_left;
  end

  dtof_event_link #(
      .PRESENT(PARITY)
  ) u_parity_link (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .event_i      (damaged),
      .next_column_i(next_parity_error_i),
      .event_o      (parity_error_o)
  );

  dtof_parity_sram #(
      .PORTS(1),
      .DEPTH(PIXELS_PER_SRAM),
      .WIDTH(SCRATCH_WIDTH),
      .PARITY(PARITY),
      .PARITIES(dtof_pkg::POOL_SCRATCH_PARITIES)
  ) u_scratch_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (sram_cfg_o),
      .read_en_i   (command_i.read_scratch),
      .read_addr_i (scratch_row_i),
      .read_data_o (scratch),
      .ignore_i    (unwritten_q),
      .error_o     (damaged),
      .write_en_i  (command_i.write_scratch),
      .write_addr_i(scratch_row_i),
      .write_data_i(command_i.deciding ? decide_scratch : choose_scratch)
  );

  dtof_label_chain #(
      .LABELS        (LABELS),
      .POSITION_WIDTH(CELL_POSITION_WIDTH),
      .REACH         (4),
      .EVIDENCE_WIDTH(CHOOSE_EVIDENCE_WIDTH),
      .PENALTY_WIDTH (CHOOSE_PENALTY_WIDTH)
  ) u_choose (
      .clk_i            (clk_i),
      .active_i         (command_i.choosing),
      .command_i        (command_i.choose),
      .evidence_i       (choose_evidence),
      .position_i       (choose_position),
      .penalty_i        (choose_penalty),
      .message_o        (choose_message),
      .other_message_i  (scratch[LEFT_WIDTH+:CHOOSE_MESSAGE_WIDTH]),
      .best_label_o     (best_label),
      .second_label_o   (second_label),
      .best_position_o  (best_cell),
      .second_position_o(second_cell),
      .margin_o         (choose_margin)
  );

  logic decided_rival, unused_loser;
  logic [POSITION_WIDTH-1:0] leader_position, rival_position, lost_position;

  generate
    if (RIVAL_MOVES != 0) begin : g_absolute
      assign leader_position = POSITION_WIDTH'(prepared_q[POINTER_WIDTH-1:0]) << POINTER_SHIFT;
      assign rival_position = POSITION_WIDTH'({prepared_q[POINTER_WIDTH+:RIVAL_WIDTH], 9'h100});
    end else begin : g_relative
      // Leader and rival are candidates of the group, whose word is on the line while the pixel is prepared.
      logic [LABEL_WIDTH-1:0] leader_label, rival_label;
      logic [CELL_WIDTH-1:0] leader_cell_q, rival_cell_q;
      logic signed [17:0] moved;
      assign leader_label = captured_q[POINTER_WIDTH+:LABEL_WIDTH];
      assign rival_label = captured_q[POINTER_WIDTH+LABEL_WIDTH+:LABEL_WIDTH];
      always_ff @(posedge clk_i) begin
        if (advance) begin
          leader_cell_q <= line_q[leader_label*CELL_WIDTH+:CELL_WIDTH];
          rival_cell_q <= line_q[rival_label*CELL_WIDTH+:CELL_WIDTH];
        end
      end
      assign moved = $signed({2'b00, leader_cell_q, 9'd0})
          + $signed({{(18 - POINTER_WIDTH - POINTER_SHIFT) {prepared_q[POINTER_WIDTH-1]}}, prepared_q[POINTER_WIDTH-1:0],
                     {POINTER_SHIFT{1'b0}}});
      // A position beyond the range becomes the end of the range.
      assign leader_position = moved[17] ? '0 : moved[16] ? POSITION_WIDTH'(17'h0ffff) : POSITION_WIDTH'(moved[15:0]);
      assign rival_position = POSITION_WIDTH'({rival_cell_q, 9'd0});
    end
  endgenerate

  dtof_label_chain #(
      .LABELS        (2),
      .POSITION_WIDTH(POSITION_WIDTH),
      .REACH         (2048),
      .EVIDENCE_WIDTH(DECIDE_EVIDENCE_WIDTH),
      .PENALTY_WIDTH (DECIDE_PENALTY_WIDTH)
  ) u_decide (
      .clk_i            (clk_i),
      .active_i         (command_i.deciding),
      .command_i        (command_i.decide),
      .evidence_i       ({{DECIDE_EVIDENCE_WIDTH{1'b0}}, 1'b0, prepared_q[POINT_WIDTH-1-:ADVANTAGE_WIDTH]}),
      .position_i       ({rival_position, leader_position}),
      .penalty_i        (DECIDE_PENALTY_WIDTH'(2)),
      .message_o        (decide_message),
      .other_message_i  (scratch[WINNER_WIDTH+:DECIDE_MESSAGE_WIDTH]),
      .best_label_o     (decided_rival),
      .second_label_o   (unused_loser),
      .best_position_o  (position),
      .second_position_o(lost_position),
      .margin_o         (decide_margin)
  );

  // Choose: first pointer word. The leader's offset has moved through the steps with its pixel.

  logic [15:0] best_start, second_start, left_lead, left_start, start;
  logic [CONFIDENCE_WIDTH-1:0] start_margin;
  logic [PIXEL_WIDTH-1:0] first_word;
  logic [ADVANTAGE_WIDTH-1:0] start_advantage;
  logic [2*PIXEL_WIDTH-1:0] new_pair_q;

  generate
    if (OFFSET_BITS != 0) begin : g_offset
      function automatic logic [15:0] start_of(input logic [LEFT_WIDTH-1:0] lead);
        start_of = {lead[CELL_WIDTH-1:0], 9'd0}
            + {{(10 - OFFSET_BITS) {lead[LEFT_WIDTH-1]}}, lead[CELL_WIDTH+:OFFSET_BITS], 6'd0};
      endfunction
      logic [LABEL_WIDTH-1:0] leader;
      logic [OFFSET_BITS-1:0] offset;
      assign {offset, leader} = last_lead_q;
      assign best_lead = {offset & {OFFSET_BITS{leader == best_label}}, best_cell[CELL_WIDTH-1:0]};
      assign best_start = start_of(best_lead);
      assign second_start = start_of({offset & {OFFSET_BITS{leader == second_label}}, second_cell[CELL_WIDTH-1:0]});
      assign left_start = start_of(left_lead[LEFT_WIDTH-1:0]);
    end else begin : g_no_offset
      assign best_lead = best_cell[CELL_WIDTH-1:0];
      assign best_start = {best_cell[CELL_WIDTH-1:0], 9'd0};
      assign second_start = {second_cell[CELL_WIDTH-1:0], 9'd0};
      assign left_start = {left_lead[CELL_WIDTH-1:0], 9'd0};
    end
  endgenerate

  localparam int HALF_ADVANTAGE = 1 << (ADVANTAGE_WIDTH - 1);
  assign start_advantage = (32'(choose_margin) >= HALF_ADVANTAGE) ? ADVANTAGE_WIDTH'(HALF_ADVANTAGE - 1)
      : ADVANTAGE_WIDTH'(choose_margin);
  generate
    if (RIVAL_MOVES != 0) begin : g_absolute_word
      // The rival is delayed until the leader's start has been moved closer to its neighbours' starts.
      logic [RIVAL_WIDTH-1:0] rival_q, next_rival_q;
      always_ff @(posedge clk_i) begin
        if (command_i.choosing && command_i.take_position) begin
          next_rival_q <= second_start[15:9];
          rival_q <= next_rival_q;
        end
      end
      assign first_word = PIXEL_WIDTH'({start_margin[ADVANTAGE_WIDTH-1:0], rival_q, start[15:POINTER_SHIFT]});
    end else begin : g_relative_word
      assign first_word = PIXEL_WIDTH'({start_advantage, second_label, best_label, {POINTER_WIDTH{1'b0}}});
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
          left_used_q <= line_q[GROUP_WIDTH+:LABELS];
        end
        if (command_i.take_choice) begin
          so_far_q <= (command_i.next_group ? left_used_q : so_far_q) | (LABELS'(1) << best_label);
        end
        if (command_i.next_group) begin
          used_q <= so_far_q;
        end
      end
      assign done_word = command_i.giving_used ? HALF_WIDTH'(used_q) << GROUP_WIDTH : HALF_WIDTH'(new_pair_q);
    end else begin : g_not_used
      assign done_word = HALF_WIDTH'(new_pair_q);
      logic unused_commands;
      assign unused_commands = ^{command_i.take_used, command_i.take_choice, command_i.next_group, command_i.giving_used};
    end
  endgenerate

  logic [HALF_WIDTH-1:0] new_evidence;  // significances and tilted flag of the group's candidates
  generate
    if (SIGNIFICANCE_WIDTH != 0) begin : g_new_evidence
      assign new_evidence = HALF_WIDTH'({new_significances, new_tilted}) << EVIDENCE_FIRST;
    end else begin : g_no_new_evidence
      assign new_evidence = '0;
      logic unused_new_evidence;
      assign unused_new_evidence = ^{new_significances, new_tilted};
    end
  endgenerate

  // Registered here because the wires to the pairs are long. A pair registers the word one clock before it writes it. The word is 0
  // while the SRAMs are cleared.
  always_ff @(posedge clk_i) begin
    if (active || was_active_q) begin
      word_o <= ((HALF_WIDTH'({new_background[BACKGROUND_WIDTH-1-:KEPT_WIDTH], new_cells}) | new_evidence)
              & {HALF_WIDTH{command_i.decoding}})
          | (done_word & {HALF_WIDTH{command_i.choosing}});
    end
  end

  // Choose and decide: positions move closer together. Decide: result.

  logic [2:0] near;
  logic [CONFIDENCE_WIDTH-1:0] confidence;

  dtof_smoothing #(
      .NP              (NP),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .CELL_SHIFT      (CELL_SHIFT),
      .SECOND_TARGET   (SECOND_TARGET)
  ) u_smoothing (
      .clk_i           (clk_i),
      .rst_ni          (rst_ni),
      .starts_i        ((RIVAL_MOVES != 0) && command_i.choosing),
      .smooth_i        (smooth_i),
      .has_left_i      (beside.has_left),
      .take_position_i (command_i.take_position),
      .has_position_i  (command_i.has_position),
      .position_i      (command_i.deciding ? position[15:0] : best_start),
      .left_i          (scratch[15:0]),
      .left_position_i (command_i.deciding ? left_lead : left_start),
      .left_o          (left_lead),
      .lost_position_i (lost_position[15:0]),
      .margin_i        (command_i.deciding ? decide_margin[CONFIDENCE_WIDTH-1:0] : CONFIDENCE_WIDTH'(start_advantage)),
      .confidence_i    (confidence),
      .near_o          (near),
      .bright_i        (last_bright_q),
      .take_distances_i(command_i.take_distances),
      .start_o         (start),
      .start_margin_o  (start_margin),
      .take_result_i   (command_i.take_result),
      .result_o        (result_o[DEPTH_WIDTH-1:0])
  );

  // Decide: what a result says about the light.

  generate
    if (AMPLITUDE != 0) begin : g_amplitude
      logic next_prepared, take_winner;  // signals, because Icarus Verilog 12 connects the whole command to a port in a generate block
      assign next_prepared = command_i.decide.advance;
      assign take_winner = command_i.deciding && command_i.take_position;
      dtof_pool_light #(
          .BACKGROUND_WIDTH(KEPT_WIDTH),
          .ADVANTAGE_WIDTH (ADVANTAGE_WIDTH)
      ) u_light (
          .clk_i          (clk_i),
          .advance_i      (next_prepared),
          .background_i   (line_q[LABELS*CELL_WIDTH+:KEPT_WIDTH]),
          .advantage_i    (prepared_q[POINT_WIDTH-1-:ADVANTAGE_WIDTH]),
          .take_position_i(take_winner),
          .rival_wins_i   (decided_rival),
          .take_result_i  (command_i.take_result),
          .light_o        (result_o[RESULT_WIDTH-1:DEPTH_WIDTH])
      );
    end
  endgenerate

  // Decide: confidence. The significances near both labels and the group's background move through the steps with the pixel.

  generate
    if (SIGNIFICANCE_WIDTH != 0) begin : g_confidence
      logic next_pixel;  // a signal, because Icarus Verilog 12 connects the whole command to a port in a generate block
      assign next_pixel = command_i.decide.advance;
      localparam int SKY_WIDTH = dtof_pkg::POOL_SKY_WIDTH;
      localparam int FACTS_WIDTH = 2 * SIGNIFICANCE_WIDTH + 1 + SKY_WIDTH;  // {significance of the rival, of the leader, tilted, sky}
      logic [SIGNIFICANCE_WIDTH-1:0] leader_significance, rival_significance;
      logic [SKY_WIDTH:0] prepared_sky_q;  // {tilted, sky}
      logic [FACTS_WIDTH-1:0] next_facts_q, facts_q, last_facts_q;

      dtof_near_significance #(
          .LABELS    (LABELS),
          .KEPT_WIDTH(SIGNIFICANCE_WIDTH)
      ) u_leader (
          .clk_i          (clk_i),
          .take_i         (next_pixel),
          .cells_i        (line_q[LABELS*CELL_WIDTH-1:0]),
          .significances_i(line_q[EVIDENCE_FIRST+1+:LABELS*SIGNIFICANCE_WIDTH]),
          .cell_i         (captured_q[POINTER_WIDTH-1-:CELL_WIDTH]),
          .significance_o (leader_significance)
      );

      dtof_near_significance #(
          .LABELS    (LABELS),
          .KEPT_WIDTH(SIGNIFICANCE_WIDTH)
      ) u_rival (
          .clk_i          (clk_i),
          .take_i         (next_pixel),
          .cells_i        (line_q[LABELS*CELL_WIDTH-1:0]),
          .significances_i(line_q[EVIDENCE_FIRST+1+:LABELS*SIGNIFICANCE_WIDTH]),
          .cell_i         (captured_q[POINTER_WIDTH+:CELL_WIDTH]),
          .significance_o (rival_significance)
      );

      always_ff @(posedge clk_i) begin
        if (next_pixel) begin
          prepared_sky_q <= {line_q[EVIDENCE_FIRST], line_background[BACKGROUND_WIDTH-1-:SKY_WIDTH]};
          {last_facts_q, facts_q, next_facts_q} <= {facts_q, next_facts_q, rival_significance, leader_significance,
                                                    prepared_sky_q};
        end
      end

      dtof_pool_confidence #(
          .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
          .KEPT_WIDTH      (SIGNIFICANCE_WIDTH)
      ) u_confidence (
          .clk_i           (clk_i),
          .take_position_i (command_i.deciding && command_i.take_position),
          .margin_i        (decide_margin[CONFIDENCE_WIDTH-1:0]),
          .left_margin_i   (scratch[16+:CONFIDENCE_WIDTH]),
          .significance_i  (decided_rival ? last_facts_q[FACTS_WIDTH-1-:SIGNIFICANCE_WIDTH]
                            : last_facts_q[SKY_WIDTH+1+:SIGNIFICANCE_WIDTH]),
          .tilted_i        (last_facts_q[SKY_WIDTH]),
          .sky_i           (last_facts_q[SKY_WIDTH-1:0]),
          .take_distances_i(command_i.deciding && command_i.take_distances),
          .near_i          (near),
          .confidence_o    (confidence)
      );
    end else begin : g_margin
      assign confidence = start_margin;
      logic unused_near;
      assign unused_near = ^near;
    end
  endgenerate

  logic unused;
  assign unused = ^{decided_rival, unused_loser, lost_position, position, decide_margin, best_cell[CELL_WIDTH],
                    second_cell[CELL_WIDTH], second_start, best_label, second_label, last_lead_q, line_q, scratch, best_start,
                    left_lead, left_start, start, start_margin, prepared_q, new_background};

endmodule

`default_nettype wire
