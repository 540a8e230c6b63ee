// SPDX-License-Identifier: Apache-2.0
// poolPointer for a SPAD array: SRAM_NUM columns of PIXELS_PER_SRAM pixels; input TDC timestamps, output depth codes. Equations:
// docs/reference/poolpointer.md. Four columns share an SRAM. ENGINE_COLUMNS columns share an engine, which decodes, chooses and
// decides for one column after the other.
//
// Frame: start_i samples acq_num_i and the schedule, 0 <= coarse_end_i <= track_end_i <= acq_num_i; busy_o stays high up to the clock of done_o.
//   Recommended: coarse_end = A C >> 6 and track_end = A (C + T) >> 6 with A = acq_num and (C, T) = (14, 20). start_i also samples
//   smooth_i, which switches S1 on, and prior_i: with PRIOR = 1 the candidates used in the last frame then raise their pair sums.
// TDC stream: as in dtof_array. If PIXELS_PER_SRAM is no multiple of four (of eight if eight coarse bins need a whole word, as in
//   lean), SLOTS clocks without timestamps pass for each missing row.
// Result: AXI4-Stream, tdata = {column, row, code, fraction, confidence}, in three nested loops: column of an engine (outer), row,
//   engine (inner); column = engine * ENGINE_COLUMNS + column of the engine. With SECOND_TARGET = 1 tdata = {column, row,
//   second code, second fraction, code, fraction, confidence}: the second code is that of the label that lost the decision, not
//   smoothed; the confidence holds for it, too. With AMPLITUDE = 1 tdata = {column, row, ambient, amplitude, ...}.
// Borders: every signal between the shared logic and columns or engines runs from a register to a register (dtof_broadcast.sv).
//   Timestamps run from the port, which counts as the TDC's register, to the registers of their column (dtof_timestamp_input.sv). The
//   words of an engine's pairs are combined by OR on their way to the engine (dtof_pool_line.sv).
// Latency: the first result leaves in DECIDE, after the frame's last acquisition.
// Cycles of a frame: ACQ_NUM * (PIXELS_PER_SRAM, rounded up to that multiple) * SLOTS, plus the cycle budget in
//   docs/reference/poolpointer.md. Cost: reports/area.md.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_pointer_array `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int NP = 10,                // bits of a timestamp, 8 to 16
    parameter int PIXELS_PER_SRAM = 160,  // pixels of a column
    parameter int SRAM_NUM = 200,         // columns
    parameter int SLOTS = 2,              // timestamps per pixel and acquisition, 2 to 4: the SRAM has one port
    parameter int COUNT_WIDTH = 7,        // bits of a coarse bin, 4 to 8
    parameter int GROUP_SIZE = 4,         // rows of two columns that share a coarse histogram, a power of two, 4 to 32
    parameter int LABELS = 5,             // candidates of a group, 2 to 8
    parameter int SCORE_BITS = 4,         // bits of a candidate's score, 1 to 4
    parameter int OFFSET_BITS = 6,        // bits of a leader's offset in the track phase, 2 to 6; 0: none
    parameter int ADVANTAGE_WIDTH = 7,    // bits of the leader's advantage, 4 or 7
    parameter int POINTER_SHIFT = 1,      // unit of a pointer: 2^(POINTER_SHIFT - 11) coarse bins; 0 to 2, with ADVANTAGE_WIDTH = 4 to 4
    parameter int RIVAL_MOVES = 1,        // 1: the rival has a pointer; 0: it stays at its candidate
    parameter int CELL_SHIFT = 9,         // log2 of a settled pointer's cells in positions, 8 to 10, by the pulse's width
    parameter int PARITY = 0,              // 1: each word of the SRAMs has a parity bit, which is checked at each read
    parameter int TIME_GATE = 0,           // 1: timestamps outside [gate_begin_i, gate_end_i) are no detections
    parameter int SECOND_TARGET = 0,      // 1: a result also has the position of the label that lost
    parameter int AMPLITUDE = 0,          // 1: a result also has amplitude and ambient
    parameter int PRIOR = 0,              // 1: with prior_i, candidates used in the last frame raise their pair sums
    parameter int ENGINE_COLUMNS = 34,    // columns that share an engine, an even number
    parameter int ACQ_WIDTH = 16,         // bits of the run-time number of acquisitions
    parameter int BROADCAST_STAGES = 2,   // registers between the shared logic and columns and engines, 1 to 8
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int DEPTH_WIDTH = dtof_pkg::pool_result_width(ADVANTAGE_WIDTH, SECOND_TARGET),
    localparam int RESULT_WIDTH = DEPTH_WIDTH + dtof_pkg::pool_light_width(ADVANTAGE_WIDTH, AMPLITUDE),
    localparam int TDATA_WIDTH = COLUMN_WIDTH + ROW_WIDTH + RESULT_WIDTH
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    // side band of the SRAM macros, the same for all; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,  // AND of the cfg_o of all SRAM macros
    input  logic                   start_i,  // ignored while busy_o is high, also in the clock of done_o
    input  logic [  ACQ_WIDTH-1:0] acq_num_i,
    input  logic [         NP-1:0] gate_begin_i,  // time gate of the frame, sampled with start_i
    input  logic [         NP-1:0] gate_end_i,
    input  logic [  ACQ_WIDTH-1:0] coarse_end_i,
    input  logic [  ACQ_WIDTH-1:0] track_end_i,
    input  logic                   smooth_i,  // 1: S1 is on in this frame
    // TEMPLATE, entry 0 lowest: decode subtracts it from the bins' sums; stable while busy_o is high
    input  logic [dtof_pkg::POOL_COARSE_BINS*dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] template_i,
    input  logic                   prior_i,   // with PRIOR = 1: this frame uses the last frame's choices; ignored in the first frame after reset
    output logic                   busy_o,
    output logic                   done_o,
    output logic [            2:0] state_o,
    output logic [dtof_pkg::ERROR_WIDTH-1:0] error_o,  // dtof_pkg::ERROR_*, one clock per error (dtof_array_errors)
    output logic                   parity_error_o,  // with PARITY = 1: a word with a wrong parity was read; only while busy_o is high
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
  localparam int SRAM_WORDS = PIXEL_WORDS + (GROUPS + 1) / 2;
  localparam int ADDR_WIDTH = dtof_pkg::index_width(SRAM_WORDS);
  localparam int STEPS = dtof_pkg::max_of((SRAM_NUM < ENGINE_COLUMNS) ? SRAM_NUM : ENGINE_COLUMNS, 1);  // columns of a full engine
  localparam int STEP_WIDTH = dtof_pkg::index_width(STEPS);
  localparam int STEP_PAIRS = (STEPS + 1) / 2;
  localparam int ENGINES = (SRAM_NUM + STEPS - 1) / STEPS;
  localparam int ALL_PAIRS = (SRAM_NUM + 1) / 2;
  // All engines select the same pair number at a time. If an engine has one pair only, two engines would select both pairs of an SRAM.
  localparam int SRAM_COLUMNS = (ENGINES > 1 && STEP_PAIRS == 1) ? 2 : 4;
  localparam int SRAM_PAIRS = SRAM_COLUMNS / 2;
  localparam int QUADS = (SRAM_NUM + SRAM_COLUMNS - 1) / SRAM_COLUMNS;
  localparam int PART_WIDTH = dtof_pkg::pool_part_width(LINE_HALVES);
  localparam int LAST_COLUMNS = SRAM_NUM - (ENGINES - 1) * STEPS;  // columns of the last engine
  localparam int LAST_PAIRS = (LAST_COLUMNS + 1) / 2;
  // Registers on the way of results and parities to the shared logic. In a wide array no wire may be longer than those to the engines.
  localparam int RESULT_STAGES = (BROADCAST_STAGES > 2) ? BROADCAST_STAGES - 2 : 0;

  `DTOF_REQUIRE(g_illegal_parity, PARITY == 0 || PARITY == 1, "dtof_pool_pointer_array: PARITY must be 0 or 1")
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
  `DTOF_REQUIRE(g_illegal_amplitude, AMPLITUDE == 0 || AMPLITUDE == 1, "dtof_pool_pointer_array: AMPLITUDE must be 0 or 1")
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
  logic [dtof_pkg::POOL_ACQUISITION_WIDTH-1:0] acquisition_t1;
  logic decode, choose, decide, engine_done, underrun, illegal_schedule;
  logic [ADDR_WIDTH-1:0] clear_address, stream_address, engine_address;
  logic [ACQ_WIDTH-1:0] acq_num;

  logic keep_groups;

  dtof_pool_controller #(
      .CLEAR_WORDS(PIXEL_WORDS),
      .FIRST_CLEAR_WORDS((PARITY != 0) ? SRAM_WORDS : PIXEL_WORDS),
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
      .keep_groups_i  (keep_groups),
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
  logic [dtof_pkg::POOL_THINNING_WIDTH-1:0] thinning_t2;
  logic [PART_WIDTH-1:0] part;
  logic sweep, make_room, groups;

  // With RIVAL_MOVES = 1 the pointer phase does not use candidates.
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
      .thinning_t2_o    (thinning_t2),
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
  `DTOF_TYPE(dtof_pool_pkg, pool_engine_command_t) command;
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

  logic [dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] template_entry;
  logic template_hidden;

  dtof_coarse_template u_coarse_template (
      .clk_i     (clk_i),
      .template_i(template_i),
      .bin_i     (template_bin),
      .entry_o   (template_entry),
      .hidden_o  (template_hidden)
  );

  // The SRAMs hold groups' words of a last frame only if a frame has ended since reset. With PARITY = 1 these words are cleared when
  // nobody needs them, because an engine replaces a part of a word, and writes back the other parts as it has read them.

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
      assign keep_groups = ended_q;
    end else begin : g_no_prior
      assign prior_q = 1'b0;
      assign keep_groups = 1'b0;
      logic unused_prior;
      assign unused_prior = prior_i;
    end
  endgenerate

  // Commands to pairs and engines. The last engine may have fewer columns; its last pair then replaces the missing neighbour to its
  // right.

  logic read_q, write_q, has_right, last_has_right;
  logic [ADDR_WIDTH-1:0] address_q;
  logic [LAST_PAIRS-1:0] last_select, last_part;

  // The sequencers give read, write and address one clock before the other commands; this register aligns them, in time for the data that
  // a pair prepares before it writes.
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      read_q <= 1'b0;
      write_q <= 1'b0;
    end else begin
      read_q <= stream_read || engine_read;
      write_q <= stream_write || engine_write || clear;
    end
  end

  logic coarse_q, point_q, engine_q, group_load_q, group_upper_q;

  always_ff @(posedge clk_i) begin
    coarse_q <= coarse;
    point_q <= point;
    engine_q <= !stream;
    address_q <= clear ? clear_address : (stream ? stream_address : engine_address);
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
      // The engines work on the last pair's missing second column, too; its choices must not count as used.
      assign last_select = last_part & {LAST_PAIRS{!(command.giving_used && engine_column == STEP_WIDTH'(LAST_COLUMNS))}};
    end else begin : g_no_missing_column
      assign last_select = last_part;
    end
  endgenerate

  // In decode engine_column is the first column of the pair in work.
  assign has_right = (engine_column != STEP_WIDTH'(command.decoding ? (STEPS - 1) / 2 * 2 : STEPS - 1));
  assign last_has_right = (engine_column != STEP_WIDTH'(command.decoding ? (LAST_COLUMNS - 1) / 2 * 2 : LAST_COLUMNS - 1));

  localparam int SENT_WIDTH = 2 * NP + 4 + ADDR_WIDTH + dtof_pkg::POOL_COMMAND_WIDTH + ROW_WIDTH + STEP_PAIRS + LAST_PAIRS + PART_WIDTH + 27
      + dtof_pkg::POOL_SIGNIFICANCE_OFFSET_WIDTH + dtof_pkg::POOL_TEMPLATE_WIDTH + dtof_pkg::POOL_THINNING_WIDTH + 1;

  // All commands of a clock.
  typedef struct packed {
    logic template_hidden;
    logic [dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] template_entry;
    logic [dtof_pkg::POOL_SIGNIFICANCE_OFFSET_WIDTH-1:0] significance_offset;
    logic [NP-1:0] gate_begin;
    logic [NP-1:0] gate_end;
    logic smooth;
    logic coarse;
    logic point;
    logic beat_t1;
    logic first_slot_t1;
    logic last_slot_t1;
    logic odd_t1;
    logic second_row_t0;
    logic first_row_t2;
    logic second_row_t2;
    logic [3:0] acquisition_t2;
    logic [dtof_pkg::POOL_THINNING_WIDTH-1:0] thinning_t2;
    logic keep_first;
    logic keep_last;
    logic load;
    logic [PART_WIDTH-1:0] part;
    logic sweep;
    logic make_room;
    logic read;
    logic write;
    logic [ADDR_WIDTH-1:0] address;
    logic word_load;
    logic group_load;
    logic group_upper;
    logic engine;
    logic replace;
    logic clear;
    logic [STEP_PAIRS-1:0] select;
    logic [LAST_PAIRS-1:0] last_select;
    logic upper;
    logic used;
    logic has_right;
    logic last_has_right;
    logic [ROW_WIDTH-1:0] scratch_row;
    logic [dtof_pkg::POOL_COMMAND_WIDTH-1:0] command;  // a pool_engine_command_t; Yosys 0.23 cannot nest that type here
  } sent_t;

  sent_t sent, received;

  assign sent.template_hidden = template_hidden;
  assign sent.template_entry = template_entry;
  assign sent.significance_offset = significance_offset;
  assign sent.gate_begin = gate_begin;
  assign sent.gate_end = gate_end;
  assign sent.smooth = smooth_q;
  assign sent.coarse = coarse_q;
  assign sent.point = point_q;
  assign sent.beat_t1 = beat_t1;
  assign sent.first_slot_t1 = first_slot_t1;
  assign sent.last_slot_t1 = last_slot_t1;
  assign sent.odd_t1 = odd_t1;
  assign sent.second_row_t0 = second_row_t0;
  assign sent.first_row_t2 = first_row_t2;
  assign sent.second_row_t2 = second_row_t2;
  assign sent.acquisition_t2 = acquisition_t2;
  assign sent.thinning_t2 = thinning_t2;
  assign sent.keep_first = keep_first;
  assign sent.keep_last = keep_last;
  assign sent.load = load;
  assign sent.part = part;
  assign sent.sweep = sweep;
  assign sent.make_room = make_room;
  assign sent.read = read_q;
  assign sent.write = write_q;
  assign sent.address = address_q;
  assign sent.word_load = stream_word_load;
  assign sent.group_load = group_load_q;
  assign sent.group_upper = group_upper_q;
  assign sent.engine = engine_q;
  assign sent.replace = engine_write;
  assign sent.clear = clear;
  assign sent.select = engine_select;
  assign sent.last_select = last_select;
  assign sent.upper = engine_upper;
  assign sent.used = command.giving_used;
  assign sent.has_right = has_right;
  assign sent.last_has_right = last_has_right;
  assign sent.scratch_row = scratch_row;
  assign sent.command = command;

  dtof_broadcast #(
      .WIDTH (SENT_WIDTH),
      .STAGES(BROADCAST_STAGES)
  ) u_broadcast (
      .clk_i (clk_i),
      .rst_ni(rst_ni),
      .from_i(sent),
      .to_o  (received)
  );

  generate
    if (ENGINES == 1) begin : g_one_engine
      logic unused_of_the_others;
      assign unused_of_the_others = ^{received.select, received.has_right};
    end
  endgenerate

  // Pairs of columns, two per SRAM, in the order of the columns.

  logic [ALL_PAIRS-1:0] selects;
  logic [ALL_PAIRS*HALF_WIDTH-1:0] engine_words;
  logic [ALL_PAIRS*LINE_WIDTH-1:0] pair_words;
  logic [QUADS*dtof_pkg::SRAM_CFG_WIDTH-1:0] quad_cfg;
  logic [ENGINES*dtof_pkg::SRAM_CFG_WIDTH-1:0] engine_cfg;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] parity_cfg;
  integer i, j;

  // The start at '1 keeps an undriven side band from feeding back; Icarus would otherwise evaluate this block without end.
  always_comb begin
    sram_cfg_o = '1;
    for (i = 0; i < QUADS; i = i + 1) begin
      sram_cfg_o = sram_cfg_o & quad_cfg[i*dtof_pkg::SRAM_CFG_WIDTH+:dtof_pkg::SRAM_CFG_WIDTH];
    end
    for (j = 0; j < ENGINES; j = j + 1) begin
      sram_cfg_o = sram_cfg_o & engine_cfg[j*dtof_pkg::SRAM_CFG_WIDTH+:dtof_pkg::SRAM_CFG_WIDTH];
    end
    sram_cfg_o = sram_cfg_o & parity_cfg;
  end

  // Damaged words: of the SRAMs from dtof_pool_parity_store, of the engines along a chain.
  logic [QUADS-1:0] quad_accessed, quad_parities;
  logic sram_error;
  logic [ENGINES:0] engine_errors;
  assign engine_errors[ENGINES] = 1'b0;

  generate
    if (PARITY != 0) begin : g_parity
      logic [2*QUADS-1:0] parities_there;

      if (RESULT_STAGES > 0) begin : g_stages
        dtof_broadcast #(
            .WIDTH (2 * QUADS),
            .STAGES(RESULT_STAGES)
        ) u_parity_stages (
            .clk_i (clk_i),
            .rst_ni(rst_ni),
            .from_i({quad_accessed, quad_parities}),
            .to_o  (parities_there)
        );
      end else begin : g_no_stages
        assign parities_there = {quad_accessed, quad_parities};
      end

      dtof_pool_parity_store #(
          .SRAMS     (QUADS),
          .DEPTH     (SRAM_WORDS),
          .WAY_CLOCKS(RESULT_STAGES)
      ) u_parity_store (
          .clk_i     (clk_i),
          .rst_ni    (rst_ni),
          .sram_cfg_i(sram_cfg_i),
          .sram_cfg_o(parity_cfg),
          .read_i    (received.read),
          .write_i   (received.write),
          .address_i (received.address),
          .accessed_i(parities_there[2*QUADS-1:QUADS]),
          .parity_i  (parities_there[QUADS-1:0]),
          .error_o   (sram_error)
      );
    end else begin : g_no_parity
      assign parity_cfg = '1;
      assign sram_error = 1'b0;
      logic unused_parities;
      assign unused_parities = ^{quad_accessed, quad_parities};
    end
  endgenerate

  dtof_event_link #(
      .PRESENT(PARITY)
  ) u_parity_head (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .event_i      (sram_error),
      .next_column_i(engine_errors[0]),
      .event_o      (parity_error_o)
  );

  `DTOF_ASSERT(a_parity_error_in_frame, !parity_error_o || busy_o, "a word was found damaged outside of a frame")

  genvar q, p;
  generate
    for (q = 0; q < QUADS; q = q + 1) begin : g_quad
      localparam int LEFT = SRAM_NUM - SRAM_COLUMNS * q;  // columns from this SRAM on
      localparam int QUAD_COLUMNS = (LEFT < SRAM_COLUMNS) ? LEFT : SRAM_COLUMNS;
      localparam int FIRST = SRAM_PAIRS * q;  // number of the first pair
      localparam int QUAD_PAIRS = (QUAD_COLUMNS + 1) / 2;
      logic [LINE_WIDTH-1:0] second_word;

      for (p = 0; p < 2; p = p + 1) begin : g_pair
        localparam int ENGINE = (FIRST + p) / STEP_PAIRS;
        localparam int PLACE = (FIRST + p) % STEP_PAIRS;  // number within the engine's pairs
        localparam int PAIRS = (ENGINE == ENGINES - 1) ? LAST_PAIRS : STEP_PAIRS;
        // Each pair ORs the word of the next pair in its segment; the segment's first pair drives dtof_pool_line.
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
          .PARITY          (PARITY),
          .TIME_GATE       (TIME_GATE),
          .PRIOR           (PRIOR),
          .BROADCAST_STAGES(BROADCAST_STAGES)
      ) u_quad (
          .clk_i           (clk_i),
          .rst_ni          (rst_ni),
          .sram_cfg_i      (sram_cfg_i),
          .sram_cfg_o      (quad_cfg[q*dtof_pkg::SRAM_CFG_WIDTH+:dtof_pkg::SRAM_CFG_WIDTH]),
          .accessed_o      (quad_accessed[q]),
          .parity_o        (quad_parities[q]),
          .timestamp_i     (tdc_timestamp_i[2*FIRST*NP+:QUAD_COLUMNS*NP]),
          .read_i          (received.read),
          .write_i         (received.write),
          .address_i       (received.address),
          .gate_begin_i    (received.gate_begin),
          .gate_end_i      (received.gate_end),
          .coarse_i        (received.coarse),
          .point_i         (received.point),
          .beat_t1_i       (received.beat_t1),
          .first_slot_t1_i (received.first_slot_t1),
          .last_slot_t1_i  (received.last_slot_t1),
          .odd_t1_i        (received.odd_t1),
          .second_row_t0_i (received.second_row_t0),
          .first_row_t2_i  (received.first_row_t2),
          .second_row_t2_i (received.second_row_t2),
          .acquisition_t2_i(received.acquisition_t2),
          .thinning_t2_i   (received.thinning_t2),
          .keep_first_i    (received.keep_first),
          .keep_last_i     (received.keep_last),
          .load_i          (received.load),
          .part_i          (received.part),
          .sweep_i         (received.sweep),
          .make_room_i     (received.make_room),
          .word_load_d_i   (received.word_load),
          .group_load_i    (received.group_load),
          .group_upper_i   (received.group_upper),
          .engine_i        (received.engine),
          .replace_i       (received.replace),
          .clear_i         (received.clear),
          .upper_i         (received.upper),
          .used_i          (received.used),
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

  // With AMPLITUDE = 1 engines give background and advantage as their words store them, which are fewer bits than ambient and amplitude.
  localparam int KEPT_WIDTH = dtof_pkg::pool_background_width(LABELS, PIXEL_WIDTH);
  localparam int SENT_RESULT_WIDTH = DEPTH_WIDTH + ((AMPLITUDE != 0) ? KEPT_WIDTH + ADVANTAGE_WIDTH : 0);
  logic [ENGINES*SENT_RESULT_WIDTH-1:0] results;
  logic [COLUMN_WIDTH+ROW_WIDTH+SENT_RESULT_WIDTH-1:0] sent_result;

  genvar e, s;
  generate
    for (e = 0; e < ENGINES; e = e + 1) begin : g_engine
      localparam int COLUMNS = (SRAM_NUM - e * STEPS < STEPS) ? SRAM_NUM - e * STEPS : STEPS;
      localparam int PAIRS = (COLUMNS + 1) / 2;
      localparam int FIRST = e * STEP_PAIRS;  // number of the engine's first pair
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
        assign selects[FIRST+:PAIRS] = received.last_select;
        assign has_right_here = received.last_has_right;
      end else begin : g_full
        assign selects[FIRST+:PAIRS] = received.select;
        assign has_right_here = received.has_right;
      end

      `DTOF_ASSERT(a_clear_with_zeros, !received.clear || word == '0, "words are cleared while an engine gives another one")

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
          .PARITY         (PARITY),
          .SECOND_TARGET  (SECOND_TARGET),
          .AMPLITUDE      (AMPLITUDE),
          .PRIOR          (PRIOR)
      ) u_engine (
          .clk_i        (clk_i),
          .rst_ni       (rst_ni),
          .sram_cfg_i   (sram_cfg_i),
          .sram_cfg_o   (engine_cfg[e*dtof_pkg::SRAM_CFG_WIDTH+:dtof_pkg::SRAM_CFG_WIDTH]),
          .next_parity_error_i(engine_errors[e+1]),
          .parity_error_o(engine_errors[e]),
          .smooth_i     (received.smooth),
          .has_right_i  (has_right_here),
          .significance_offset_i(received.significance_offset),
          .template_i   (received.template_entry),
          .hidden_i     (received.template_hidden),
          .command_i    (received.command),
          .line_i       (line),
          .word_o       (word),
          .scratch_row_i(received.scratch_row),
          .result_o     (results[e*SENT_RESULT_WIDTH+:SENT_RESULT_WIDTH])
      );
    end
  endgenerate

  // Results on their way to the shared logic.

  logic [ENGINES*SENT_RESULT_WIDTH-1:0] results_there;

  generate
    if (RESULT_STAGES > 0) begin : g_result_stages
      dtof_broadcast #(
          .WIDTH (ENGINES * SENT_RESULT_WIDTH),
          .STAGES(RESULT_STAGES)
      ) u_results (
          .clk_i (clk_i),
          .rst_ni(rst_ni),
          .from_i(results),
          .to_o  (results_there)
      );
    end else begin : g_no_result_stages
      assign results_there = '0;
    end
  endgenerate

  dtof_pool_result_output #(
      .ENGINES       (ENGINES),
      .ENGINE_COLUMNS(STEPS),
      .SRAM_NUM      (SRAM_NUM),
      .ROW_WIDTH     (ROW_WIDTH),
      .RESULT_WIDTH  (SENT_RESULT_WIDTH),
      .LATENCY       (BROADCAST_STAGES + RESULT_STAGES)
  ) u_result_output (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .send_i   (send),
      .column_i (send_column),
      .row_i    (send_row),
      .last_i   (send_last),
      .results_i((RESULT_STAGES > 0) ? results_there : results),
      .waits_o  (send_waits),
      .busy_o   (send_busy),
      .tvalid_o (result_tvalid_o),
      .tready_i (result_tready_i),
      .tdata_o  (sent_result),
      .tlast_o  (result_tlast_o)
  );

  generate
    if (AMPLITUDE != 0) begin : g_amplitude
      localparam int LOST_WIDTH = dtof_pkg::POOL_BACKGROUND_WIDTH - KEPT_WIDTH;
      localparam int AMPLITUDE_WIDTH = dtof_pkg::pool_amplitude_width(ADVANTAGE_WIDTH);
      logic [dtof_pkg::POOL_BACKGROUND_WIDTH-1:0] ambient;
      logic [9:0] amplitude;
      // The low bits that the group's word does not store are replaced by the middle of their range.
      assign ambient = (dtof_pkg::POOL_BACKGROUND_WIDTH'(sent_result[DEPTH_WIDTH+ADVANTAGE_WIDTH+:KEPT_WIDTH]) << LOST_WIDTH)
          | dtof_pkg::POOL_BACKGROUND_WIDTH'((1 << LOST_WIDTH) >> 1);
      assign amplitude = dtof_pkg::pool_amplitude(ADVANTAGE_WIDTH, 7'(sent_result[DEPTH_WIDTH+:ADVANTAGE_WIDTH]));
      assign result_tdata_o = {sent_result[SENT_RESULT_WIDTH+:COLUMN_WIDTH+ROW_WIDTH], ambient, amplitude[AMPLITUDE_WIDTH-1:0],
                               sent_result[DEPTH_WIDTH-1:0]};
      if (AMPLITUDE_WIDTH < 10) begin : g_unused
        logic unused_amplitude;
        assign unused_amplitude = ^amplitude[9:AMPLITUDE_WIDTH];
      end
    end else begin : g_depth_alone
      assign result_tdata_o = sent_result;
    end
  endgenerate

endmodule

`default_nettype wire
