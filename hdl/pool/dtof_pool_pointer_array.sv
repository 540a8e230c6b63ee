// SPDX-License-Identifier: Apache-2.0
// poolPointer for a SPAD array: SRAM_NUM columns of PIXELS_PER_SRAM pixels; input TDC timestamps, output depth codes. Equations:
// docs/reference/poolpointer.md. Four columns share an SRAM. ENGINE_COLUMNS columns share an engine, which decodes, chooses and
// decides for one column after the other.
//
// Frame: start_i samples acq_num_i and the schedule, 0 <= coarse_end_i <= track_end_i <= acq_num_i; busy_o stays high up to the clock of done_o.
//   Recommended: coarse_end = A C >> 6 and track_end = A (C + T) >> 6 with A = acq_num and (C, T) = (14, 30), lean (14, 20). start_i also samples
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

module dtof_pool_pointer_array #(
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
  localparam int SRAM_WORDS = GROUPS * (GROUP_SIZE / 2) + (GROUPS + 1) / 2;
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
  `DTOF_REQUIRE(g_illegal_count, COUNT_WIDTH >= 4 && COUNT_WIDTH <= 8, "dtof_pool_pointer_array: COUNT_WIDTH must be 4 to 8")
  `DTOF_REQUIRE(g_illegal_group, GROUP_SIZE >= 4 && GROUP_SIZE <= 32 && (1 << $clog2(GROUP_SIZE)) == GROUP_SIZE,
                "dtof_pool_pointer_array: GROUP_SIZE must be a power of two from 4 to 32")
  `DTOF_REQUIRE(g_illegal_labels, LABELS >= 2 && LABELS <= 8, "dtof_pool_pointer_array: LABELS must be 2 to 8")
  `DTOF_REQUIRE(g_illegal_score, SCORE_BITS >= 1 && SCORE_BITS <= 4, "dtof_pool_pointer_array: SCORE_BITS must be 1 to 4")
  `DTOF_REQUIRE(g_illegal_offset, OFFSET_BITS == 0 || (OFFSET_BITS >= 2 && OFFSET_BITS <= 6),
                "dtof_pool_pointer_array: OFFSET_BITS must be 0 or 2 to 6")
  `DTOF_REQUIRE(g_illegal_advantage, ADVANTAGE_WIDTH == 4 || ADVANTAGE_WIDTH == 7, "dtof_pool_pointer_array: ADVANTAGE_WIDTH must be 4 or 7")
  `DTOF_REQUIRE(g_illegal_shift, POINTER_SHIFT >= 0 && POINTER_SHIFT <= ((ADVANTAGE_WIDTH == 4) ? 4 : 2),
                "dtof_pool_pointer_array: POINTER_SHIFT must be 0 to 2, or 0 to 4 if ADVANTAGE_WIDTH is 4")
  `DTOF_REQUIRE(g_illegal_rival, RIVAL_MOVES == 0 || RIVAL_MOVES == 1, "dtof_pool_pointer_array: RIVAL_MOVES must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_resting, RIVAL_MOVES == 1 || OFFSET_BITS == 0, "dtof_pool_pointer_array: OFFSET_BITS must be 0 if RIVAL_MOVES is 0")
  `DTOF_REQUIRE(g_illegal_cell_shift, CELL_SHIFT >= 8 && CELL_SHIFT <= 10, "dtof_pool_pointer_array: CELL_SHIFT must be 8 to 10")
  `DTOF_REQUIRE(g_illegal_second, SECOND_TARGET == 0 || SECOND_TARGET == 1, "dtof_pool_pointer_array: SECOND_TARGET must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_amplitude, AMPLITUDE == 0 || AMPLITUDE == 1, "dtof_pool_pointer_array: AMPLITUDE must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_prior, PRIOR == 0 || PRIOR == 1, "dtof_pool_pointer_array: PRIOR must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_used, PRIOR == 0 || dtof_pkg::pool_group_width(LABELS, PIXEL_WIDTH) + LABELS <= HALF_WIDTH,
                "dtof_pool_pointer_array: a group's word and a bit for each candidate must fit two pixel words if PRIOR is 1")
  `DTOF_REQUIRE(g_illegal_histogram,
                dtof_pkg::POOL_BINS_PER_LINE * COUNT_WIDTH < LINE_WIDTH && GROUP_SIZE >= 4 * LINE_HALVES,
                "dtof_pool_pointer_array: 32 bins of COUNT_WIDTH and a bit more must fit the words of GROUP_SIZE rows")
  `DTOF_REQUIRE(g_illegal_engine, ENGINE_COLUMNS >= 2 && ENGINE_COLUMNS % 2 == 0,
                "dtof_pool_pointer_array: ENGINE_COLUMNS must be even and at least 2, for two columns share an SRAM")
  `DTOF_REQUIRE(g_illegal_acq_width, ACQ_WIDTH >= 4 && ACQ_WIDTH <= 24, "dtof_pool_pointer_array: ACQ_WIDTH must be 4 to 24")
  `DTOF_REQUIRE(g_illegal_broadcast, BROADCAST_STAGES >= 1 && BROADCAST_STAGES <= 8, "dtof_pool_pointer_array: BROADCAST_STAGES must be 1 to 8")

  // Control. Commands of all pairs and engines go through the registers of the broadcast.

  `include "dtof_pool_commands.svh"

  localparam int SENT_WIDTH = dtof_pkg::pool_sent_width(NP, ADDR_WIDTH, ROW_WIDTH, STEP_PAIRS + LAST_PAIRS, PART_WIDTH);

  logic [SENT_WIDTH-1:0] sent;
  sent_t received;
  logic send, send_last, send_waits, send_busy;
  logic [STEP_WIDTH-1:0] send_column;
  logic [ROW_WIDTH-1:0] send_row;

  dtof_pool_control #(
      .NP             (NP),
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .SLOTS          (SLOTS),
      .GROUP_SIZE     (GROUP_SIZE),
      .LABELS         (LABELS),
      .RIVAL_MOVES    (RIVAL_MOVES),
      .LINE_HALVES    (LINE_HALVES),
      .SIGNIFICANCE_WIDTH(SIGNIFICANCE_WIDTH),
      .PARITY         (PARITY),
      .TIME_GATE      (TIME_GATE),
      .PRIOR          (PRIOR),
      .ENGINE_COLUMNS (STEPS),
      .LAST_COLUMNS   (LAST_COLUMNS),
      .ACQ_WIDTH      (ACQ_WIDTH)
  ) u_control (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .start_i      (start_i),
      .acq_num_i    (acq_num_i),
      .gate_begin_i (gate_begin_i),
      .gate_end_i   (gate_end_i),
      .coarse_end_i (coarse_end_i),
      .track_end_i  (track_end_i),
      .smooth_i     (smooth_i),
      .template_i   (template_i),
      .prior_i      (prior_i),
      .busy_o       (busy_o),
      .done_o       (done_o),
      .state_o      (state_o),
      .error_o      (error_o),
      .tdc_valid_i  (tdc_valid_i),
      .tdc_ready_o  (tdc_ready_o),
      .sent_o       (sent),
      .send_o       (send),
      .send_column_o(send_column),
      .send_row_o   (send_row),
      .send_last_o  (send_last),
      .send_waits_i (send_waits),
      .send_busy_i  (send_busy)
  );

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

  // Damaged words: of the SRAMs by their parities, of the engines along a chain.
  logic [QUADS-1:0] quad_accessed, quad_parities;
  logic [ENGINES:0] engine_errors;
  assign engine_errors[ENGINES] = 1'b0;

  dtof_pool_parity #(
      .PARITY(PARITY),
      .SRAMS (QUADS),
      .DEPTH (SRAM_WORDS),
      .STAGES(RESULT_STAGES)
  ) u_parity (
      .clk_i         (clk_i),
      .rst_ni        (rst_ni),
      .sram_cfg_i    (sram_cfg_i),
      .sram_cfg_o    (parity_cfg),
      .read_i        (received.read),
      .write_i       (received.write),
      .address_i     (received.address),
      .accessed_i    (quad_accessed),
      .parity_i      (quad_parities),
      .engine_error_i(engine_errors[0]),
      .error_o       (parity_error_o)
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
          .optional_i      (received.optional),
          .late_i          (received.late),
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
          .clk_i   (clk_i),
          .active_i(received.engine),
          .words_i (segment_words),
          .line_o  (line)
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

  dtof_pool_result_path #(
      .ENGINES        (ENGINES),
      .ENGINE_COLUMNS (STEPS),
      .SRAM_NUM       (SRAM_NUM),
      .ROW_WIDTH      (ROW_WIDTH),
      .DEPTH_WIDTH    (DEPTH_WIDTH),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .KEPT_WIDTH     (KEPT_WIDTH),
      .AMPLITUDE      (AMPLITUDE),
      .LATENCY        (BROADCAST_STAGES),
      .STAGES         (RESULT_STAGES)
  ) u_result_path (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .send_i   (send),
      .column_i (send_column),
      .row_i    (send_row),
      .last_i   (send_last),
      .waits_o  (send_waits),
      .busy_o   (send_busy),
      .results_i(results),
      .tvalid_o (result_tvalid_o),
      .tready_i (result_tready_i),
      .tdata_o  (result_tdata_o),
      .tlast_o  (result_tlast_o)
  );

endmodule

`default_nettype wire
