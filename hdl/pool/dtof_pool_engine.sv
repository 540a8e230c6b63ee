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
// 3. The operation's chain (dtof_pool_choose_chain, dtof_pool_decide_chain) handles one pixel per step. Messages of the first pass are kept
//    in the scratch memory.
// 4. From the best two labels choose makes the pixel's first pointer word (dtof_pool_starts, dtof_pool_engine_word). dtof_smoothing moves the
//    starts of the pointers (with RIVAL_MOVES = 0: not) and decide's winners, and makes decide's result.
//
// An engine has no counters of rows, columns or clocks: in each clock it executes the command, and nothing else.
//
// Schedule: the table of dtof_pool_sequencer. Latency: POOL_ENGINE_*_CLOCKS (dtof_pkg).
// Cost: dtof_pool_candidate_decoder, dtof_beside_evidence, two dtof_label_chain, dtof_pool_starts, dtof_smoothing, dtof_pool_engine_word, a
// single-port SRAM with a word per row, per engine.

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
  localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES);
  localparam int RIVAL_WIDTH = dtof_pkg::POOL_RIVAL_WIDTH;
  localparam int SMOOTH_BRIGHT_FROM = 6;
  localparam int HALF_BINS_WIDTH = dtof_pkg::POOL_BINS_PER_LINE / LINE_HALVES * COUNT_WIDTH;
  localparam int BINS_WIDTH = dtof_pkg::POOL_BINS_PER_LINE * COUNT_WIDTH;
  localparam int CHOOSE_EVIDENCE_WIDTH = dtof_pkg::POOL_EVIDENCE_WIDTH;
  localparam int DECIDE_EVIDENCE_WIDTH = ADVANTAGE_WIDTH + 1;
  localparam int CHOOSE_MESSAGE_WIDTH = LABELS * dtof_pkg::POOL_CHOOSE_PENALTY_WIDTH;
  localparam int DECIDE_MESSAGE_WIDTH = 2 * dtof_pkg::POOL_DECIDE_PENALTY_WIDTH;
  localparam int LEFT_WIDTH = CELL_WIDTH + OFFSET_BITS;  // choose: cell and offset of a column's best label
  // Decide: {margin, position} of the winner; without significances the position alone.
  localparam int WINNER_WIDTH = 16 + ((SIGNIFICANCE_WIDTH != 0) ? CONFIDENCE_WIDTH : 0);
  localparam int EVIDENCE_FIRST = GROUP_WIDTH + ((PRIOR != 0) ? LABELS : 0);  // {significances, tilted} in a group's word
  localparam int SCRATCH_WIDTH = dtof_pkg::max_of(CHOOSE_MESSAGE_WIDTH + LEFT_WIDTH, DECIDE_MESSAGE_WIDTH + WINNER_WIDTH);

  `DTOF_TYPE(dtof_pool_pkg, beside_command_t) beside;
  assign beside = command_i.beside;

  // Outside an operation registers hold.

  logic active;
  logic [LINE_WIDTH-1:0] line_q;

  assign active = command_i.decoding || command_i.choosing || command_i.deciding;

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
  logic prepared_bright_q, next_bright_q, bright_q, last_bright_q;
  logic [SCRATCH_WIDTH-1:0] scratch;
  logic [CELL_WIDTH-1:0] left_cell;

  assign advance = command_i.choose.advance || command_i.decide.advance;
  // The low bits that the group's word does not store are replaced by the middle of their range.
  assign line_background = (BACKGROUND_WIDTH'(line_q[LABELS*CELL_WIDTH+:KEPT_WIDTH]) << (BACKGROUND_WIDTH - KEPT_WIDTH))
      | BACKGROUND_WIDTH'((1 << (BACKGROUND_WIDTH - KEPT_WIDTH)) >> 1);
  assign line_pixel = command_i.odd_pixel ? line_q[PIXEL_WIDTH+:PIXEL_WIDTH] : line_q[PIXEL_WIDTH-1:0];

  always_ff @(posedge clk_i) begin
    if (command_i.take_pixel) begin
      captured_q <= line_pixel;
    end
    if (advance) begin
      prepared_q <= captured_q;
      prepared_bright_q <= (line_background >= BACKGROUND_WIDTH'(SMOOTH_BRIGHT_FROM));
      {last_bright_q, bright_q, next_bright_q} <= {bright_q, next_bright_q, prepared_bright_q};
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

  logic [CHOOSE_MESSAGE_WIDTH-1:0] choose_message;
  logic [DECIDE_MESSAGE_WIDTH-1:0] decide_message;
  logic [SCRATCH_WIDTH-1:0] choose_scratch, decide_scratch;
  logic [LABEL_WIDTH-1:0] best_label, second_label;
  logic [CELL_WIDTH-1:0] best_cell, second_cell;
  logic [CHOOSE_EVIDENCE_WIDTH+1:0] choose_margin;
  logic [LEFT_WIDTH-1:0] best_lead;
  logic decided_rival;
  logic [15:0] position, lost_position;  // winner of decide, and the other label
  logic [WINNER_WIDTH-1:0] winner;
  logic [DECIDE_EVIDENCE_WIDTH+1:0] decide_margin;
  logic [LEFT_WIDTH-1:0] written_left;

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
      assign winner = {decide_margin[CONFIDENCE_WIDTH-1:0], position};
    end else begin : g_winner
      assign winner = position;
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

  dtof_pool_choose_chain #(
      .LABELS(LABELS)
  ) u_choose_chain (
      .clk_i          (clk_i),
      .active_i       (command_i.choosing),
      .command_i      (command_i.choose),
      .evidence_i     (choose_evidence),
      .cells_i        (cells),
      .background_i   (background),
      .message_o      (choose_message),
      .other_message_i(scratch[LEFT_WIDTH+:CHOOSE_MESSAGE_WIDTH]),
      .best_label_o   (best_label),
      .second_label_o (second_label),
      .best_cell_o    (best_cell),
      .second_cell_o  (second_cell),
      .margin_o       (choose_margin)
  );

  dtof_pool_decide_chain #(
      .LABELS         (LABELS),
      .SCORE_BITS     (SCORE_BITS),
      .OFFSET_BITS    (OFFSET_BITS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES)
  ) u_decide_chain (
      .clk_i          (clk_i),
      .active_i       (command_i.deciding),
      .command_i      (command_i.decide),
      .advance_i      (advance),
      .captured_i     (captured_q),
      .cells_i        (line_q[LABELS*CELL_WIDTH-1:0]),
      .prepared_i     (prepared_q),
      .message_o      (decide_message),
      .other_message_i(scratch[WINNER_WIDTH+:DECIDE_MESSAGE_WIDTH]),
      .rival_wins_o   (decided_rival),
      .position_o     (position),
      .lost_position_o(lost_position),
      .margin_o       (decide_margin)
  );

  // Choose: starts of pointers, and the word that the engine gives to a pair.

  logic [15:0] best_start, second_start, left_lead, left_start, start;
  logic [CONFIDENCE_WIDTH-1:0] start_margin;
  logic [ADVANTAGE_WIDTH-1:0] start_advantage;

  dtof_pool_starts #(
      .LABELS         (LABELS),
      .SCORE_BITS     (SCORE_BITS),
      .OFFSET_BITS    (OFFSET_BITS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH)
  ) u_starts (
      .clk_i         (clk_i),
      .advance_i     (advance),
      .word_i        (prepared_q[TRACK_WIDTH-1:0]),
      .best_label_i  (best_label),
      .second_label_i(second_label),
      .best_cell_i   (best_cell),
      .second_cell_i (second_cell),
      .left_i        (left_lead[LEFT_WIDTH-1:0]),
      .margin_i      (choose_margin),
      .best_o        (best_lead),
      .best_start_o  (best_start),
      .second_start_o(second_start),
      .left_start_o  (left_start),
      .advantage_o   (start_advantage)
  );

  dtof_pool_engine_word #(
      .LABELS         (LABELS),
      .SCORE_BITS     (SCORE_BITS),
      .OFFSET_BITS    (OFFSET_BITS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES),
      .PRIOR          (PRIOR)
  ) u_word (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .command_i      (command_i),
      .cells_i        (new_cells),
      .background_i   (new_background[BACKGROUND_WIDTH-1-:KEPT_WIDTH]),
      .significances_i(new_significances),
      .tilted_i       (new_tilted),
      .best_label_i   (best_label),
      .second_label_i (second_label),
      .second_cell_i  (second_start[15-:RIVAL_WIDTH]),
      .start_i        (start),
      .advantage_i    ((RIVAL_MOVES != 0) ? ADVANTAGE_WIDTH'(start_margin) : start_advantage),
      .group_i        (line_q[HALF_WIDTH-1:0]),
      .word_o         (word_o)
  );

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
      .position_i      (command_i.deciding ? position : best_start),
      .left_i          (scratch[15:0]),
      .left_position_i (command_i.deciding ? left_lead : left_start),
      .left_o          (left_lead),
      .lost_position_i (lost_position),
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

  // Decide: confidence.

  generate
    if (SIGNIFICANCE_WIDTH != 0) begin : g_confidence
      logic next_pixel;  // a signal, because Icarus Verilog 12 connects the whole command to a port in a generate block
      assign next_pixel = command_i.decide.advance;
      logic [SIGNIFICANCE_WIDTH-1:0] significance;
      logic tilted;
      logic [dtof_pkg::POOL_SKY_WIDTH-1:0] sky;

      dtof_pool_label_evidence #(
          .LABELS    (LABELS),
          .KEPT_WIDTH(SIGNIFICANCE_WIDTH)
      ) u_label_evidence (
          .clk_i          (clk_i),
          .advance_i      (next_pixel),
          .cells_i        (line_q[LABELS*CELL_WIDTH-1:0]),
          .significances_i(line_q[EVIDENCE_FIRST+1+:LABELS*SIGNIFICANCE_WIDTH]),
          .tilted_i       (line_q[EVIDENCE_FIRST]),
          .sky_i          (line_background[BACKGROUND_WIDTH-1-:dtof_pkg::POOL_SKY_WIDTH]),
          .leader_cell_i  (captured_q[POINTER_WIDTH-1-:CELL_WIDTH]),
          .rival_cell_i   (captured_q[POINTER_WIDTH+:CELL_WIDTH]),
          .rival_wins_i   (decided_rival),
          .significance_o (significance),
          .tilted_o       (tilted),
          .sky_o          (sky)
      );

      dtof_pool_confidence #(
          .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
          .KEPT_WIDTH      (SIGNIFICANCE_WIDTH)
      ) u_confidence (
          .clk_i           (clk_i),
          .take_position_i (command_i.deciding && command_i.take_position),
          .margin_i        (decide_margin[CONFIDENCE_WIDTH-1:0]),
          .left_margin_i   (scratch[16+:CONFIDENCE_WIDTH]),
          .significance_i  (significance),
          .tilted_i        (tilted),
          .sky_i           (sky),
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
  assign unused = ^{decided_rival, decide_margin, second_start, line_q, scratch, best_start, left_lead, left_start, start, start_margin,
                    prepared_q, new_background};

endmodule

`default_nettype wire
