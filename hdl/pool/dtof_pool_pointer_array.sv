// SPDX-License-Identifier: Apache-2.0
// poolPointer for a SPAD array: SRAM_NUM columns of PIXELS_PER_SRAM pixels, TDC timestamps in, depth codes out
// (docs/reference/poolpointer.md). Four columns share an SRAM, ENGINE_COLUMNS an engine, which decodes, chooses and
// decides for one after the other.
//
// Frame: start_i samples acq_num_i and the schedule, 0 <= coarse_end_i <= track_end_i <= acq_num_i; busy_o until done_o.
//   Recommended: coarse_end = A C >> 6 and track_end = A (C + T) >> 6 with (C, T) = (14, 20). smooth_i, sampled with
//   start_i, too, switches S1, and with PRIOR = 1 prior_i what the last frame's choices add to this one's candidates.
// TDC stream: as dtof_array's. Where PIXELS_PER_SRAM is no multiple of four (of eight if eight coarse bins need a whole word, as
//   lean's do), SLOTS clocks pass between acquisitions for each row that is missing.
// Result: AXI4-Stream, tdata = {column, row, code, fraction, confidence}; for each column of an engine, each row,
//   each engine: column engine * ENGINE_COLUMNS + column of the engine. With SECOND_TARGET = 1 tdata = {column, row,
//   second code, second fraction, code, fraction, confidence}: the label that lost the decision, not smoothed, to which
//   the confidence belongs as well.
// Borders: every signal between the shared logic and columns or engines goes from a register to a register (dtof_broadcast.sv),
//   timestamps from the port, which stands for the TDC's register, to those of their column (dtof_timestamp_input.sv). The words
//   of an engine's pairs are combined by OR on the way to it (dtof_pool_line.sv).
// Cycles of a frame: ACQ_NUM * (PIXELS_PER_SRAM, rounded up to that multiple) * SLOTS + what docs/reference/poolpointer.md's
//   cycle budget says.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_pointer_array #(
    parameter int NP = 10,                // bits of a timestamp, 8 to 16
    parameter int PIXELS_PER_SRAM = 160,  // pixels a column serves
    parameter int SRAM_NUM = 200,         // columns
    parameter int SLOTS = 2,              // timestamps per pixel and acquisition, 2 to 4: the SRAM has one port
    parameter int COUNT_WIDTH = 7,        // bits of a coarse bin, 4 to 8
    parameter int GROUP_SIZE = 4,         // rows of two columns that share a coarse histogram, a power of two, 4 to 32
    parameter int LABELS = 5,             // candidates of a group, 2 to 8
    parameter int SCORE_BITS = 4,         // bits of their scores, 1 to 4
    parameter int OFFSET_BITS = 6,        // bits of a leader's offset in the track phase, 2 to 6; 0: none
    parameter int ADVANTAGE_WIDTH = 7,    // bits of the leader's advantage, 4 or 7
    parameter int POINTER_SHIFT = 1,      // a pointer's unit: 2^(POINTER_SHIFT - 11) coarse bins, 0 to 2, or to 4 with 4
    parameter int RIVAL_MOVES = 1,        // 1: the rival has a pointer; 0: it stays at its candidate
    parameter int CELL_SHIFT = 9,         // a settled pointer's cells have 2^CELL_SHIFT positions, 8 to 10: the pulse's width
    parameter int TIME_GATE = 0,           // 1: timestamps outside [gate_begin_i, gate_end_i) are no detections
    parameter int SECOND_TARGET = 0,      // 1: a result has the position of the label that lost, too
    parameter int PRIOR = 0,              // 1: with prior_i candidates begin from those that were used in the last frame
    parameter int ENGINE_COLUMNS = 34,    // columns that share an engine, even
    parameter int ACQ_WIDTH = 16,         // bits of the run-time number of acquisitions
    parameter int BROADCAST_STAGES = 2,   // registers between the shared logic and columns and engines, 1 to 8
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int RESULT_WIDTH = dtof_pkg::pool_result_width(ADVANTAGE_WIDTH, SECOND_TARGET),
    localparam int TDATA_WIDTH = COLUMN_WIDTH + ROW_WIDTH + RESULT_WIDTH
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    // side band of the SRAM macros, which the technology folder gives a meaning; all get the same
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,  // AND of the cfg_o of all SRAM macros
    input  logic                   start_i,  // ignored while busy_o, also in the clock of done_o
    input  logic [  ACQ_WIDTH-1:0] acq_num_i,
    input  logic [         NP-1:0] gate_begin_i,  // time gate of the frame, sampled with start_i
    input  logic [         NP-1:0] gate_end_i,
    input  logic [  ACQ_WIDTH-1:0] coarse_end_i,
    input  logic [  ACQ_WIDTH-1:0] track_end_i,
    input  logic                   smooth_i,  // S1
    // TEMPLATE, entry 0 lowest: what decode takes from the coarse bins; held while busy_o
    input  logic [dtof_pkg::POOL_COARSE_BINS*dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] template_i,
    input  logic                   prior_i,   // of the frame, with PRIOR = 1; the first frame after reset has none
    output logic                   busy_o,
    output logic                   done_o,
    output logic [            2:0] state_o,
    output logic [dtof_pkg::ERROR_WIDTH-1:0] error_o,  // dtof_pkg::ERROR_*, one clock per error (dtof_array_errors)
    input  logic                   tdc_valid_i,
    output logic                   tdc_ready_o,
    input  logic [SRAM_NUM*NP-1:0] tdc_timestamp_i,
    output logic                   result_tvalid_o,
    input  logic                   result_tready_i,
    output logic [TDATA_WIDTH-1:0] result_tdata_o,
    output logic                   result_tlast_o
);

  localparam int HALF_WIDTH = dtof_pkg::pool_half_width(LABELS, SCORE_BITS, OFFSET_BITS, ADVANTAGE_WIDTH,
                                                         POINTER_SHIFT, RIVAL_MOVES);
  localparam int PIXEL_WIDTH = dtof_pkg::pool_pixel_width(LABELS, SCORE_BITS, OFFSET_BITS, ADVANTAGE_WIDTH,
                                                           POINTER_SHIFT, RIVAL_MOVES);
  localparam int SIGNIFICANCE_WIDTH = dtof_pkg::pool_significance_width(LABELS, PIXEL_WIDTH, ADVANTAGE_WIDTH, RIVAL_MOVES, PRIOR);
  localparam int LINE_HALVES = dtof_pkg::pool_line_halves(HALF_WIDTH, COUNT_WIDTH);
  localparam int LINE_WIDTH = LINE_HALVES * HALF_WIDTH;
  localparam int GROUPS = (PIXELS_PER_SRAM + GROUP_SIZE - 1) / GROUP_SIZE;
  localparam int PIXEL_WORDS = GROUPS * (GROUP_SIZE / 2);
  localparam int ADDR_WIDTH = dtof_pkg::index_width(PIXEL_WORDS + (GROUPS + 1) / 2);
  localparam int STEPS = dtof_pkg::max_of((SRAM_NUM < ENGINE_COLUMNS) ? SRAM_NUM : ENGINE_COLUMNS, 1);  // of an engine
  localparam int STEP_WIDTH = dtof_pkg::index_width(STEPS);
  localparam int STEP_PAIRS = (STEPS + 1) / 2;
  localparam int ENGINES = (SRAM_NUM + STEPS - 1) / STEPS;
  localparam int ALL_PAIRS = (SRAM_NUM + 1) / 2;
  // Engines of one pair ask for all pairs at once, so that these do not share an SRAM.
  localparam int SRAM_COLUMNS = (ENGINES > 1 && STEP_PAIRS == 1) ? 2 : 4;
  localparam int SRAM_PAIRS = SRAM_COLUMNS / 2;
  localparam int QUADS = (SRAM_NUM + SRAM_COLUMNS - 1) / SRAM_COLUMNS;
  localparam int PART_WIDTH = dtof_pkg::pool_part_width(LINE_HALVES);
  localparam int LAST_COLUMNS = SRAM_NUM - (ENGINES - 1) * STEPS;  // of the last engine
  localparam int LAST_PAIRS = (LAST_COLUMNS + 1) / 2;

  `DTOF_REQUIRE(g_illegal_np, NP >= 8 && NP <= 16, "dtof_pool_pointer_array: NP must be 8 to 16")
  `DTOF_REQUIRE(g_illegal_pixels, PIXELS_PER_SRAM >= 1, "dtof_pool_pointer_array: PIXELS_PER_SRAM must be at least 1")
  `DTOF_REQUIRE(g_illegal_srams, SRAM_NUM >= 1, "dtof_pool_pointer_array: SRAM_NUM must be at least 1")
  `DTOF_REQUIRE(g_illegal_slots, SLOTS >= 2 && SLOTS <= 4, "dtof_pool_pointer_array: SLOTS must be 2 to 4")
  `DTOF_REQUIRE(g_illegal_count, COUNT_WIDTH >= 4 && COUNT_WIDTH <= 8,
                "dtof_pool_pointer_array: COUNT_WIDTH must be 4 to 8")
  `DTOF_REQUIRE(g_illegal_group, GROUP_SIZE >= 4 && GROUP_SIZE <= 32 && (1 << $clog2(GROUP_SIZE)) == GROUP_SIZE,
                "dtof_pool_pointer_array: GROUP_SIZE must be a power of two from 4 to 32")
  `DTOF_REQUIRE(g_illegal_labels, LABELS >= 2 && LABELS <= 8, "dtof_pool_pointer_array: LABELS must be 2 to 8")
  `DTOF_REQUIRE(g_illegal_score, SCORE_BITS >= 1 && SCORE_BITS <= 4, "dtof_pool_pointer_array: SCORE_BITS must be 1 to 4")
  `DTOF_REQUIRE(g_illegal_offset, OFFSET_BITS == 0 || (OFFSET_BITS >= 2 && OFFSET_BITS <= 6),
                "dtof_pool_pointer_array: OFFSET_BITS must be 0 or 2 to 6")
  `DTOF_REQUIRE(g_illegal_advantage, ADVANTAGE_WIDTH == 4 || ADVANTAGE_WIDTH == 7,
                "dtof_pool_pointer_array: ADVANTAGE_WIDTH must be 4 or 7")
  `DTOF_REQUIRE(g_illegal_shift, POINTER_SHIFT >= 0 && POINTER_SHIFT <= ((ADVANTAGE_WIDTH == 4) ? 4 : 2),
                "dtof_pool_pointer_array: POINTER_SHIFT must be 0 to 2, or 0 to 4 if ADVANTAGE_WIDTH is 4")
  `DTOF_REQUIRE(g_illegal_rival, RIVAL_MOVES == 0 || RIVAL_MOVES == 1,
                "dtof_pool_pointer_array: RIVAL_MOVES must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_resting, RIVAL_MOVES == 1 || OFFSET_BITS == 0,
                "dtof_pool_pointer_array: OFFSET_BITS must be 0 if RIVAL_MOVES is 0")
  `DTOF_REQUIRE(g_illegal_cell_shift, CELL_SHIFT >= 8 && CELL_SHIFT <= 10,
                "dtof_pool_pointer_array: CELL_SHIFT must be 8 to 10")
  `DTOF_REQUIRE(g_illegal_second, SECOND_TARGET == 0 || SECOND_TARGET == 1,
                "dtof_pool_pointer_array: SECOND_TARGET must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_prior, PRIOR == 0 || PRIOR == 1, "dtof_pool_pointer_array: PRIOR must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_used, PRIOR == 0 || dtof_pkg::pool_group_width(LABELS, PIXEL_WIDTH) + LABELS <= HALF_WIDTH,
                "dtof_pool_pointer_array: a group's word and a bit for each candidate must fit two pixel words if PRIOR is 1")
  `DTOF_REQUIRE(g_illegal_histogram,
                dtof_pkg::POOL_BINS_PER_LINE * COUNT_WIDTH < LINE_WIDTH && GROUP_SIZE >= 4 * LINE_HALVES,
                "dtof_pool_pointer_array: 32 bins of COUNT_WIDTH and a bit more must fit the words of GROUP_SIZE rows")
  `DTOF_REQUIRE(g_illegal_engine, ENGINE_COLUMNS >= 2 && ENGINE_COLUMNS % 2 == 0,
                "dtof_pool_pointer_array: ENGINE_COLUMNS must be even and at least 2, for two columns share an SRAM")
  `DTOF_REQUIRE(g_illegal_acq_width, ACQ_WIDTH >= 4 && ACQ_WIDTH <= 24,
                "dtof_pool_pointer_array: ACQ_WIDTH must be 4 to 24")
  `DTOF_REQUIRE(g_illegal_broadcast, BROADCAST_STAGES >= 1 && BROADCAST_STAGES <= 8,
                "dtof_pool_pointer_array: BROADCAST_STAGES must be 1 to 8")

  // Control, once per array.

  logic stream, coarse, point, more, acq_done, stream_idle, clear;
  logic [dtof_pkg::POOL_SWEEP_WIDTH-1:0] acquisition_t1;
  logic decode, choose, decide, engine_done, underrun, illegal_schedule;
  logic [ADDR_WIDTH-1:0] clear_address, stream_address, engine_address;
  logic [ACQ_WIDTH-1:0] acq_num;

  dtof_pool_controller #(
      .CLEAR_WORDS(PIXEL_WORDS),
      .ADDR_WIDTH (ADDR_WIDTH),
      .ACQ_WIDTH  (ACQ_WIDTH)
  ) u_controller (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .start_i        (start_i),
      .acq_num_i      (acq_num_i),
      .coarse_end_i   (coarse_end_i),
      .track_end_i    (track_end_i),
      .busy_o         (busy_o),
      .done_o         (done_o),
      .state_o        (state_o),
      .illegal_schedule_o(illegal_schedule),
      .acq_num_o      (acq_num),
      .stream_o       (stream),
      .coarse_o       (coarse),
      .point_o        (point),
      .more_o         (more),
      .acquisition_t1_o(acquisition_t1),
      .acq_done_i     (acq_done),
      .stream_idle_i  (stream_idle),
      .clear_o        (clear),
      .clear_address_o(clear_address),
      .decode_o       (decode),
      .choose_o       (choose),
      .decide_o       (decide),
      .engine_done_i  (engine_done)
  );

  logic beat_t1, first_slot_t1, odd_t1, second_row_t0, first_row_t2, second_row_t2, last_slot_t1;
  logic keep_first, keep_last, load, stream_read, stream_write, stream_word_load, group_load, group_upper;
  logic [3:0] acquisition_t2;
  logic [PART_WIDTH-1:0] part;
  logic sweep, make_room, groups;

  // A rival that moves has no use for candidates in the pointer phase.
  assign groups = !coarse && !(RIVAL_MOVES != 0 && point);

  logic [NP-1:0] gate_begin, gate_end;

  dtof_gate_register #(
      .NP       (NP),
      .TIME_GATE(TIME_GATE)
  ) u_gate_register (
      .clk_i       (clk_i),
      .start_i     (start_i),
      .busy_i      (busy_o),
      .gate_begin_i(gate_begin_i),
      .gate_end_i  (gate_end_i),
      .gate_begin_o(gate_begin),
      .gate_end_o  (gate_end)
  );

  dtof_array_errors u_errors (
      .clk_i             (clk_i),
      .rst_ni            (rst_ni),
      .start_i           (start_i),
      .busy_i            (busy_o),
      .underrun_i        (underrun),
      .illegal_schedule_i(illegal_schedule),
      .error_o           (error_o)
  );

  dtof_pair_sequencer #(
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .SLOTS          (SLOTS),
      .GROUP_SIZE     (GROUP_SIZE),
      .LINE_HALVES    (LINE_HALVES)
  ) u_pair_sequencer (
      .clk_i            (clk_i),
      .rst_ni           (rst_ni),
      .stream_i         (stream),
      .coarse_i         (coarse),
      .groups_i         (groups),
      .more_i           (more),
      .acquisition_t1_i (acquisition_t1),
      .tdc_valid_i      (tdc_valid_i),
      .tdc_ready_o      (tdc_ready_o),
      .acq_done_o       (acq_done),
      .idle_o           (stream_idle),
      .underrun_o       (underrun),
      .beat_t1_o        (beat_t1),
      .first_slot_t1_o  (first_slot_t1),
      .last_slot_t1_o   (last_slot_t1),
      .odd_t1_o         (odd_t1),
      .second_row_t0_o  (second_row_t0),
      .first_row_t2_o   (first_row_t2),
      .second_row_t2_o  (second_row_t2),
      .acquisition_t2_o (acquisition_t2),
      .keep_first_o     (keep_first),
      .keep_last_o      (keep_last),
      .load_o           (load),
      .part_o           (part),
      .sweep_o          (sweep),
      .make_room_o      (make_room),
      .read_d_o         (stream_read),
      .write_d_o        (stream_write),
      .address_d_o      (stream_address),
      .word_load_d_o    (stream_word_load),
      .group_load_d_o   (group_load),
      .group_upper_d_o  (group_upper)
  );

  logic [STEP_WIDTH-1:0] engine_column, send_column;
  logic [STEP_PAIRS-1:0] engine_select;
  logic engine_read, engine_write, engine_upper, engine_neighbour;
  `include "dtof_pool_command.svh"
  pool_engine_command_t command;
  logic [ROW_WIDTH-1:0] scratch_row, send_row;
  logic send, send_last, send_waits, send_busy, prior_q;
  logic [$clog2(dtof_pkg::POOL_COARSE_BINS)-1:0] template_bin;

  dtof_pool_sequencer #(
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .GROUP_SIZE     (GROUP_SIZE),
      .LABELS         (LABELS),
      .LINE_HALVES    (LINE_HALVES),
      .ENGINE_COLUMNS (STEPS),
      .SMOOTH_STARTS  (RIVAL_MOVES),
      .PRIOR          (PRIOR),
      .SIGNIFICANCE_WIDTH(SIGNIFICANCE_WIDTH)
  ) u_sequencer (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .decode_i     (decode),
      .choose_i     (choose),
      .decide_i     (decide),
      .prior_i      (prior_q),
      .done_o       (engine_done),
      .read_d_o     (engine_read),
      .write_d_o    (engine_write),
      .address_d_o  (engine_address),
      .select_o     (engine_select),
      .upper_o      (engine_upper),
      .neighbour_o  (engine_neighbour),
      .command_o    (command),
      .template_bin_o(template_bin),
      .scratch_row_o(scratch_row),
      .column_o     (engine_column),
      .send_o       (send),
      .send_column_o(send_column),
      .send_row_o   (send_row),
      .send_last_o  (send_last),
      .send_waits_i (send_waits),
      .send_busy_i  (send_busy)
  );

  logic smooth_q;

  always_ff @(posedge clk_i) begin
    if (start_i && !busy_o) begin
      smooth_q <= smooth_i;
    end
  end

  logic [dtof_pkg::POOL_SIGNIFICANCE_OFFSET_WIDTH-1:0] significance_offset;

  dtof_significance_offset #(
      .ACQ_WIDTH(ACQ_WIDTH)
  ) u_significance_offset (
      .clk_i    (clk_i),
      .acq_num_i(acq_num),
      .offset_o (significance_offset)
  );

  logic [dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] template_entry, heard_template_entry;
  logic template_hidden, heard_template_hidden;

  dtof_coarse_template u_coarse_template (
      .clk_i     (clk_i),
      .template_i(template_i),
      .bin_i     (template_bin),
      .entry_o   (template_entry),
      .hidden_o  (template_hidden)
  );

  // The groups' words are of the last frame only if one has ended since reset.

  generate
    if (PRIOR != 0) begin : g_prior
      logic ended_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          ended_q <= 1'b0;
        end else begin
          ended_q <= ended_q || done_o;
        end
      end
      always_ff @(posedge clk_i) begin
        if (start_i && !busy_o) begin
          prior_q <= prior_i && ended_q;
        end
      end
    end else begin : g_no_prior
      assign prior_q = 1'b0;
      logic unused_prior;
      assign unused_prior = prior_i;
    end
  endgenerate

  // Commands from the shared logic to pairs and engines. The last engine may have fewer columns: its last pair then stands for its
  // own missing neighbour.

  localparam int COMMAND_WIDTH = dtof_pkg::POOL_COMMAND_WIDTH;
  localparam int TOLD_WIDTH = 2 * NP + 4 + ADDR_WIDTH + COMMAND_WIDTH + ROW_WIDTH + STEP_PAIRS + LAST_PAIRS + PART_WIDTH + 27
      + dtof_pkg::POOL_SIGNIFICANCE_OFFSET_WIDTH + dtof_pkg::POOL_TEMPLATE_WIDTH + 1;

  logic told_read, told_write, has_right, last_has_right;
  logic [ADDR_WIDTH-1:0] told_address;
  logic [LAST_PAIRS-1:0] last_select, last_part;

  // Registered once more than the other commands: the sequencers give read, write and address a clock early, because a pair
  // works on the data before it writes.
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      told_read <= 1'b0;
      told_write <= 1'b0;
    end else begin
      told_read <= stream_read || engine_read;
      told_write <= stream_write || engine_write || clear;
    end
  end

  logic coarse_q, point_q, engine_q, group_load_q, group_upper_q;

  always_ff @(posedge clk_i) begin
    coarse_q <= coarse;
    point_q <= point;
    engine_q <= !stream;
    told_address <= clear ? clear_address : (stream ? stream_address : engine_address);
    group_load_q <= group_load;
    group_upper_q <= group_upper;
  end

  generate
    if (LAST_PAIRS < STEP_PAIRS) begin : g_fewer
      assign last_part = engine_select[LAST_PAIRS-1:0]
          | (LAST_PAIRS'(engine_neighbour && engine_select[LAST_PAIRS]) << (LAST_PAIRS - 1));
    end else begin : g_all
      assign last_part = engine_select;
      logic unused_neighbour;
      assign unused_neighbour = engine_neighbour;
    end

    if (PRIOR != 0 && LAST_COLUMNS < STEPS && LAST_COLUMNS % 2 == 1) begin : g_missing_column
      // The last pair's second column is worked on, although it is missing; what it uses does not count.
      assign last_select = last_part & {LAST_PAIRS{!(command.giving_used && engine_column == STEP_WIDTH'(LAST_COLUMNS))}};
    end else begin : g_no_missing_column
      assign last_select = last_part;
    end
  endgenerate

  // Decode works on pairs, whose first column is in work.
  assign has_right = (engine_column != STEP_WIDTH'(command.decoding ? (STEPS - 1) / 2 * 2 : STEPS - 1));
  assign last_has_right = (engine_column != STEP_WIDTH'(command.decoding ? (LAST_COLUMNS - 1) / 2 * 2 : LAST_COLUMNS - 1));

  logic [TOLD_WIDTH-1:0] told, heard;
  logic [COMMAND_WIDTH-1:0] heard_command;
  logic [NP-1:0] heard_gate_begin, heard_gate_end;
  logic [dtof_pkg::POOL_SIGNIFICANCE_OFFSET_WIDTH-1:0] heard_significance_offset;
  logic heard_smooth, heard_coarse, heard_point, heard_beat_t1, heard_first_slot_t1, heard_last_slot_t1, heard_odd_t1;
  logic heard_second_row_t0, heard_first_row_t2, heard_second_row_t2, heard_keep_first, heard_keep_last, heard_load;
  logic heard_sweep, heard_make_room;
  logic heard_read, heard_write, heard_word_load, heard_group_load, heard_group_upper, heard_engine, heard_replace, heard_clear;
  logic heard_upper, heard_used, heard_has_right, heard_last_has_right;
  logic [3:0] heard_acquisition_t2;
  logic [PART_WIDTH-1:0] heard_part;
  logic [ADDR_WIDTH-1:0] heard_address;
  logic [STEP_PAIRS-1:0] heard_select;
  logic [LAST_PAIRS-1:0] heard_last_select;
  logic [ROW_WIDTH-1:0] heard_scratch_row;

  assign told = {template_hidden, template_entry, significance_offset, gate_begin, gate_end, smooth_q, coarse_q, point_q, beat_t1, first_slot_t1, last_slot_t1, odd_t1,
                 second_row_t0, first_row_t2, second_row_t2, acquisition_t2, keep_first, keep_last, load, part, sweep, make_room,
                 told_read, told_write, told_address, stream_word_load, group_load_q, group_upper_q, engine_q, engine_write, clear,
                 engine_select, last_select, engine_upper, command.giving_used, has_right, last_has_right, scratch_row,
                 command};
  assign {heard_template_hidden, heard_template_entry, heard_significance_offset, heard_gate_begin, heard_gate_end, heard_smooth, heard_coarse, heard_point, heard_beat_t1, heard_first_slot_t1,
          heard_last_slot_t1, heard_odd_t1, heard_second_row_t0, heard_first_row_t2, heard_second_row_t2,
          heard_acquisition_t2, heard_keep_first, heard_keep_last, heard_load, heard_part, heard_sweep, heard_make_room,
          heard_read, heard_write, heard_address, heard_word_load, heard_group_load, heard_group_upper, heard_engine, heard_replace, heard_clear,
          heard_select, heard_last_select, heard_upper, heard_used, heard_has_right, heard_last_has_right, heard_scratch_row,
          heard_command} = heard;

  dtof_broadcast #(
      .WIDTH (TOLD_WIDTH),
      .STAGES(BROADCAST_STAGES)
  ) u_broadcast (
      .clk_i (clk_i),
      .rst_ni(rst_ni),
      .from_i(told),
      .to_o  (heard)
  );

  generate
    if (ENGINES == 1) begin : g_one_engine
      logic unused_of_the_others;
      assign unused_of_the_others = ^{heard_select, heard_has_right};
    end
  endgenerate

  // Pairs of columns, two to an SRAM, in the order of the columns.

  logic [ALL_PAIRS-1:0] selects;
  logic [ALL_PAIRS*HALF_WIDTH-1:0] engine_words;
  logic [ALL_PAIRS*LINE_WIDTH-1:0] pair_words;
  logic [QUADS*dtof_pkg::SRAM_CFG_WIDTH-1:0] quad_cfg;
  logic [ENGINES*dtof_pkg::SRAM_CFG_WIDTH-1:0] engine_cfg;
  integer i, j;

  // Without a start at '1 they would copy a side band that floats, on which Icarus would evaluate this block for ever.
  always_comb begin
    sram_cfg_o = '1;
    for (i = 0; i < QUADS; i = i + 1) begin
      sram_cfg_o = sram_cfg_o & quad_cfg[i*dtof_pkg::SRAM_CFG_WIDTH+:dtof_pkg::SRAM_CFG_WIDTH];
    end
    for (j = 0; j < ENGINES; j = j + 1) begin
      sram_cfg_o = sram_cfg_o & engine_cfg[j*dtof_pkg::SRAM_CFG_WIDTH+:dtof_pkg::SRAM_CFG_WIDTH];
    end
  end

  genvar q, p;
  generate
    for (q = 0; q < QUADS; q = q + 1) begin : g_quad
      localparam int LEFT = SRAM_NUM - SRAM_COLUMNS * q;  // columns from here on
      localparam int QUAD_COLUMNS = (LEFT < SRAM_COLUMNS) ? LEFT : SRAM_COLUMNS;
      localparam int FIRST = SRAM_PAIRS * q;  // pair
      localparam int QUAD_PAIRS = (QUAD_COLUMNS + 1) / 2;
      logic [LINE_WIDTH-1:0] second_word;

      for (p = 0; p < 2; p = p + 1) begin : g_pair
        localparam int ENGINE = (FIRST + p) / STEP_PAIRS;
        localparam int PLACE = (FIRST + p) % STEP_PAIRS;  // of the engine's pairs
        localparam int PAIRS = (ENGINE == ENGINES - 1) ? LAST_PAIRS : STEP_PAIRS;
        // The next pair of its segment gives its word to this one, and the first pair gives the OR of all to dtof_pool_line.
        localparam int NEXT = PLACE + 1;
        logic [LINE_WIDTH-1:0] beside_word;
        if (p < QUAD_PAIRS && NEXT % dtof_pkg::POOL_LINE_PAIRS != 0 && NEXT < PAIRS) begin : g_beyond
          assign beside_word = pair_words[(ENGINE*STEP_PAIRS+NEXT)*LINE_WIDTH+:LINE_WIDTH];
        end else begin : g_end
          assign beside_word = '0;
        end
      end

      dtof_pool_quad #(
          .COLUMNS         (QUAD_COLUMNS),
          .NP              (NP),
          .PIXELS_PER_SRAM (PIXELS_PER_SRAM),
          .SLOTS           (SLOTS),
          .COUNT_WIDTH     (COUNT_WIDTH),
          .GROUP_SIZE      (GROUP_SIZE),
          .LABELS          (LABELS),
          .SCORE_BITS      (SCORE_BITS),
          .OFFSET_BITS     (OFFSET_BITS),
          .ADVANTAGE_WIDTH (ADVANTAGE_WIDTH),
          .POINTER_SHIFT   (POINTER_SHIFT),
          .RIVAL_MOVES     (RIVAL_MOVES),
          .CELL_SHIFT      (CELL_SHIFT),
          .TIME_GATE       (TIME_GATE),
          .PRIOR           (PRIOR),
          .BROADCAST_STAGES(BROADCAST_STAGES)
      ) u_quad (
          .clk_i           (clk_i),
          .rst_ni          (rst_ni),
          .sram_cfg_i      (sram_cfg_i),
          .sram_cfg_o      (quad_cfg[q*dtof_pkg::SRAM_CFG_WIDTH+:dtof_pkg::SRAM_CFG_WIDTH]),
          .timestamp_i     (tdc_timestamp_i[2*FIRST*NP+:QUAD_COLUMNS*NP]),
          .read_i          (heard_read),
          .write_i         (heard_write),
          .address_i       (heard_address),
          .gate_begin_i    (heard_gate_begin),
          .gate_end_i      (heard_gate_end),
          .coarse_i        (heard_coarse),
          .point_i         (heard_point),
          .beat_t1_i       (heard_beat_t1),
          .first_slot_t1_i (heard_first_slot_t1),
          .last_slot_t1_i  (heard_last_slot_t1),
          .odd_t1_i        (heard_odd_t1),
          .second_row_t0_i (heard_second_row_t0),
          .first_row_t2_i  (heard_first_row_t2),
          .second_row_t2_i (heard_second_row_t2),
          .acquisition_t2_i(heard_acquisition_t2),
          .keep_first_i    (heard_keep_first),
          .keep_last_i     (heard_keep_last),
          .load_i          (heard_load),
          .part_i          (heard_part),
          .sweep_i         (heard_sweep),
          .make_room_i     (heard_make_room),
          .word_load_d_i   (heard_word_load),
          .group_load_i    (heard_group_load),
          .group_upper_i   (heard_group_upper),
          .engine_i        (heard_engine),
          .replace_i       (heard_replace),
          .clear_i         (heard_clear),
          .upper_i         (heard_upper),
          .used_i          (heard_used),
          .select_i        (selects[FIRST+:QUAD_PAIRS]),
          .engine_word_i   (engine_words[FIRST*HALF_WIDTH+:QUAD_PAIRS*HALF_WIDTH]),
          .first_beside_i  (g_pair[0].beside_word),
          .second_beside_i (g_pair[1].beside_word),
          .first_word_o    (pair_words[FIRST*LINE_WIDTH+:LINE_WIDTH]),
          .second_word_o   (second_word)
      );

      if (QUAD_PAIRS == 2) begin : g_second
        assign pair_words[(FIRST+1)*LINE_WIDTH+:LINE_WIDTH] = second_word;
      end else begin : g_no_second
        logic unused_second;
        assign unused_second = ^second_word;
      end
    end
  endgenerate

  // Engines.

  logic [ENGINES*RESULT_WIDTH-1:0] results;

  genvar e, s;
  generate
    for (e = 0; e < ENGINES; e = e + 1) begin : g_engine
      localparam int COLUMNS = (SRAM_NUM - e * STEPS < STEPS) ? SRAM_NUM - e * STEPS : STEPS;
      localparam int PAIRS = (COLUMNS + 1) / 2;
      localparam int FIRST = e * STEP_PAIRS;  // of all pairs, the engine's first
      localparam int SEGMENTS = (PAIRS + dtof_pkg::POOL_LINE_PAIRS - 1) / dtof_pkg::POOL_LINE_PAIRS;

      logic [HALF_WIDTH-1:0] word;
      logic [LINE_WIDTH-1:0] line;
      logic [SEGMENTS*LINE_WIDTH-1:0] segment_words;
      logic has_right_here;

      for (s = 0; s < SEGMENTS; s = s + 1) begin : g_segment
        assign segment_words[s*LINE_WIDTH+:LINE_WIDTH] = pair_words[(FIRST+s*dtof_pkg::POOL_LINE_PAIRS)*LINE_WIDTH+:LINE_WIDTH];
      end

      dtof_pool_line #(
          .SEGMENTS(SEGMENTS),
          .WIDTH   (LINE_WIDTH)
      ) u_line (
          .clk_i  (clk_i),
          .words_i(segment_words),
          .line_o (line)
      );

      assign engine_words[FIRST*HALF_WIDTH+:PAIRS*HALF_WIDTH] = {PAIRS{word}};

      if (e == ENGINES - 1) begin : g_last
        assign selects[FIRST+:PAIRS] = heard_last_select;
        assign has_right_here = heard_last_has_right;
      end else begin : g_full
        assign selects[FIRST+:PAIRS] = heard_select;
        assign has_right_here = heard_has_right;
      end

      `DTOF_ASSERT(a_clear_with_zeros, !heard_clear || word == '0, "words are cleared while an engine gives another one")

      dtof_pool_engine #(
          .NP             (NP),
          .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
          .COUNT_WIDTH    (COUNT_WIDTH),
          .LABELS         (LABELS),
          .SCORE_BITS     (SCORE_BITS),
          .OFFSET_BITS    (OFFSET_BITS),
          .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
          .POINTER_SHIFT  (POINTER_SHIFT),
          .RIVAL_MOVES    (RIVAL_MOVES),
          .CELL_SHIFT     (CELL_SHIFT),
          .SECOND_TARGET  (SECOND_TARGET),
          .PRIOR          (PRIOR)
      ) u_engine (
          .clk_i        (clk_i),
          .rst_ni       (rst_ni),
          .sram_cfg_i   (sram_cfg_i),
          .sram_cfg_o   (engine_cfg[e*dtof_pkg::SRAM_CFG_WIDTH+:dtof_pkg::SRAM_CFG_WIDTH]),
          .smooth_i     (heard_smooth),
          .has_right_i  (has_right_here),
          .significance_offset_i(heard_significance_offset),
          .template_i   (heard_template_entry),
          .hidden_i     (heard_template_hidden),
          .command_i    (heard_command),
          .line_i       (line),
          .word_o       (word),
          .scratch_row_i(heard_scratch_row),
          .result_o     (results[e*RESULT_WIDTH+:RESULT_WIDTH])
      );
    end
  endgenerate

  dtof_pool_result_output #(
      .ENGINES       (ENGINES),
      .ENGINE_COLUMNS(STEPS),
      .SRAM_NUM      (SRAM_NUM),
      .ROW_WIDTH     (ROW_WIDTH),
      .RESULT_WIDTH  (RESULT_WIDTH),
      .LATENCY       (BROADCAST_STAGES)
  ) u_result_output (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .send_i   (send),
      .column_i (send_column),
      .row_i    (send_row),
      .last_i   (send_last),
      .results_i(results),
      .waits_o  (send_waits),
      .busy_o   (send_busy),
      .tvalid_o (result_tvalid_o),
      .tready_i (result_tready_i),
      .tdata_o  (result_tdata_o),
      .tlast_o  (result_tlast_o)
  );

endmodule

`default_nettype wire
