// SPDX-License-Identifier: Apache-2.0
// An array of any read-out with registers (APB4), lines of timestamps in and results out as AXI4-Streams of whole bytes, and an
// interrupt (docs/user/integration.md). For AXI4-Lite put dtof_axi_lite_to_apb in front.
//
// 1. Software writes the registers (dtof_apb_registers) and CONTROL.START. A frame (dtof_frame_control) uses the settings of the last commit
//    before the frame begins.
// 2. dtof_line_path gives the source's lines of timestamps to the array; shot_o fires laser and TDCs. If the laser runs freely, leave shot_o open.
// 3. dtof_gated_array is the array behind its clock gate.
// 4. dtof_result_path gives the results to the sink. The interrupt follows a frame's last result. In continuous mode the next frame has begun by then.
// 5. Every frame ends, whatever the source does: a watchdog ends the wait for a dead source. CONTROL.ABORT ends a frame at any time.
// 6. With SELF_TEST = 1, CONTROL.SELF_TEST begins a self-test: a frame of pseudo-random lines, whose checksum the hardware compares
//    (dtof_self_test). The source's lines wait, no shot is fired, and the words stay inside.
//
// READOUT selects the read-out: dtof_pkg::READOUT_*. The parameters that follow are those of the arrays, with the default of the read-out.
// Latency: one clock from a line to the array (two if the line buffer is an SRAM), one clock from the array to a result.
// Cost: the array, BUFFER_LINES lines, two bits per column, and the modules of this folder (reports/fpga_check.md).
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_subsystem #(
    parameter int READOUT = dtof_pkg::READOUT_EZPOINTER,
    // parameters of the arrays: written by scripts/generate.py from readouts.toml
    // verilator lint_off UNUSEDPARAM
    parameter int NP = 10,                        // bits of a TDC timestamp
    // bits of the coarse histogram index
    parameter int NB = (READOUT == dtof_pkg::READOUT_SIFH) ? (NP / 2) + 1
        : (READOUT == dtof_pkg::READOUT_PIFH) ? dtof_pkg::min_of(NP, 6)
        : (READOUT == dtof_pkg::READOUT_HISTOGRAM) ? NP
        : (READOUT == dtof_pkg::READOUT_COARSEHISTOGRAM) ? dtof_pkg::min_of(NP, 5)
        : NP / 2,
    parameter int PIXELS_PER_SRAM = 160,          // pixels a column serves
    parameter int SRAM_NUM = 200,                 // columns working in parallel
    parameter int SLOTS = 2,                      // timestamps per pixel and acquisition
    // bits of a histogram bin's counter, which never wraps
    parameter int COUNT_WIDTH = (READOUT == dtof_pkg::READOUT_POOLPOINTER) ? 7
        : 10,
    parameter int POINTER_STEP = 1,               // bins a pointer moves per timestamp
    // fractional bits of the pointer
    parameter int FRACTION_BITS = (READOUT == dtof_pkg::READOUT_COARSEHISTOGRAM) ? dtof_pkg::min_of(2, (16 - NP))
        : 0,
    parameter int CONFIDENCE_WIDTH = 4,           // bits of a pointer's confidence, 0 for none
    parameter int GUARD = ((2 << NP) + 44) / 45,  // hisPointer: codes by which the window is wider than half a coarse bin on either side; default: a FWHM of 2 ns in a range of 45 ns
    parameter int WINDOW_CENTRED = 0,             // SiFH: window centred on the coarse bin (Fig. 3.8) instead of Eq. 2.5
    parameter int POINTER_PORTS = 2,              // ports of the pointer SRAM; with 1 its cells have half the area
    parameter int SIGNALLED_CLEAR = 0,            // 1: one status bit for each address instead of clearing the SRAM
    parameter int PARITY = 0,                     // 1: each word of the SRAMs has a parity bit, which is checked at each read
    parameter int TIME_GATE = 0,                  // 1: only timestamps from `gate_begin_i` to below `gate_end_i` count
    parameter int RAW_HISTOGRAM = 0,              // 1: a frame may send histograms instead of results (`raw_i`)
    parameter int ACQ_WIDTH = 16,                 // bits of the run-time number of acquisitions
    parameter int BROADCAST_STAGES = 2,           // registers between the control and the columns; they add delay and change no result
    parameter int GROUP_SIZE = 4,                 // rows of a group, which shares a coarse histogram
    parameter int LABELS = 5,                     // candidates of a group
    parameter int SCORE_BITS = 4,                 // bits of a candidate's score
    parameter int OFFSET_BITS = 6,                // bits of a leader's offset in the track phase, 0 for none
    parameter int ADVANTAGE_WIDTH = 7,            // bits of the leader's advantage
    parameter int POINTER_SHIFT = 1,              // a pointer's unit is 2^(POINTER_SHIFT - 11) coarse bins
    parameter int RIVAL_MOVES = 1,                // 1: the rival has a pointer of its own
    parameter int CELL_SHIFT = 9,                 // windows of a settled pointer: 8 for pulses below 0.75 coarse bins (FWHM), 10 from 2.25
    parameter int SECOND_TARGET = 0,              // 1: a result has the position of the label that lost, too
    parameter int AMPLITUDE = 0,                  // 1: a result has amplitude and ambient, too
    parameter int PRIOR = 0,                      // 1: candidates may begin from those that were used in the last frame (`prior_i`)
    parameter int ENGINE_COLUMNS = 34,            // columns that share an engine
    parameter int COARSE_SHARE = 14,              // 64ths of a frame that the coarse phase is recommended to take
    parameter int TRACK_SHARE = 30,               // 64ths of a frame that the track phase is recommended to take
    // verilator lint_on UNUSEDPARAM
    // end of parameters of the arrays
    parameter int CLOCK_WAITS = 1,   // 1: the array's clock stops until a late line arrives, which needs a working clock gate; 0: the clock runs on
    parameter int SOURCE_WAITS = 1,  // 0: for TDCs that cannot wait; if there is no room, whole acquisitions are dropped
    // Lines that the line buffer holds, at least two; up to eight are in registers. CLOCK_WAITS = 1: one line, and the lines that come in the
    // array's longest wait for its raster, SLOTS - 1 clocks. CLOCK_WAITS = 0: the lines of an acquisition, and four that come while it is taken.
    parameter int BUFFER_LINES = (CLOCK_WAITS != 0) ? dtof_pkg::max_of(SLOTS, 2) : PIXELS_PER_SRAM * SLOTS + 4,
    parameter int RASTER_ORDER = 0,  // 1: a memory of all results sorts them by row and column
    parameter int SELF_TEST = 0,     // 1: built-in self-test
    localparam int S_TDATA_WIDTH = 8 * ((SRAM_NUM * NP + 7) / 8),
    localparam int M_TDATA_WIDTH = dtof_registers_pkg::RESULT_WIDTH
) (
    input  logic                     clk_i,
    input  logic                     rst_ni,
    input  logic                     scan_mode_i,      // 1: the array's clock is never gated
    // side band of the SRAM macros, the same for all; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,  // AND of the cfg_o of all SRAM macros
    // APB4, registers
    input  logic                     psel_i,
    input  logic                     penable_i,
    input  logic                     pwrite_i,
    input  logic [             11:0] paddr_i,
    input  logic [             31:0] pwdata_i,
    input  logic [              3:0] pstrb_i,
    output logic                     pready_o,
    output logic [             31:0] prdata_o,
    output logic                     pslverr_o,
    output logic                     irq_o,
    output logic                     shot_o,           // fires the laser and starts the TDCs, for one clock
    // AXI4-Stream, lines of timestamps
    input  logic                     s_axis_tvalid_i,
    output logic                     s_axis_tready_o,  // low in reset
    input  logic [S_TDATA_WIDTH-1:0] s_axis_tdata_i,   // a timestamp of every column, column 0 in the lowest bits
    input  logic                     s_axis_tlast_i,   // the last line of an acquisition
    // AXI4-Stream, results
    output logic                     m_axis_tvalid_o,
    input  logic                     m_axis_tready_i,
    output logic [M_TDATA_WIDTH-1:0] m_axis_tdata_o,
    output logic                     m_axis_tuser_o,   // first word of a frame
    output logic                     m_axis_tlast_o    // last word of a frame
);

  localparam int POOL = (READOUT == dtof_pkg::READOUT_POOLPOINTER) ? 1 : 0;
  localparam int ACQUISITION_LINES = PIXELS_PER_SRAM * SLOTS;
  localparam int MOST_RELEASE = (CLOCK_WAITS != 0) ? ACQUISITION_LINES : dtof_pkg::min_of(ACQUISITION_LINES, BUFFER_LINES);
  localparam int FRACTION_WIDTH = (POOL != 0) ? 16 - NP : dtof_pkg::fraction_width(READOUT, FRACTION_BITS);
  localparam int RESULT_CONFIDENCE_WIDTH = (POOL != 0) ? dtof_pkg::pool_confidence_width(ADVANTAGE_WIDTH)
      : dtof_pkg::confidence_width(READOUT, COUNT_WIDTH, CONFIDENCE_WIDTH);
  // In a raw frame the field of the confidence has a count.
  localparam int KEPT_CONFIDENCE_WIDTH = (POOL != 0) ? RESULT_CONFIDENCE_WIDTH
      : dtof_pkg::confidence_width(READOUT, COUNT_WIDTH,
                                   dtof_pkg::kept_confidence_width(CONFIDENCE_WIDTH, COUNT_WIDTH, RAW_HISTOGRAM));
  localparam int RAW_BINS = (RAW_HISTOGRAM != 0) ? dtof_pkg::raw_bins(READOUT, NP, NB) : 0;
  localparam int POOL_NB = $clog2(dtof_pkg::POOL_COARSE_BINS);
  localparam int POSITION_WIDTH = NP + FRACTION_WIDTH;
  localparam int AMPLITUDE_WIDTH = (AMPLITUDE != 0) ? dtof_pkg::pool_amplitude_width(ADVANTAGE_WIDTH) : 0;
  localparam int PLACE_WIDTH = dtof_pkg::index_width(SRAM_NUM) + dtof_pkg::index_width(PIXELS_PER_SRAM)
      + dtof_pkg::pool_light_width(ADVANTAGE_WIDTH, AMPLITUDE);  // column and row, with ambient and amplitude
  localparam int RESULT_WIDTH = PLACE_WIDTH + ((SECOND_TARGET != 0) ? 2 : 1) * POSITION_WIDTH + KEPT_CONFIDENCE_WIDTH;

  `DTOF_REQUIRE(g_illegal_readout, dtof_pkg::is_readout(READOUT) || POOL != 0,
                "dtof_subsystem: READOUT must be one of dtof_pkg::READOUT_*")
  `DTOF_REQUIRE(g_illegal_second, SECOND_TARGET == 0 || POOL != 0,
                "dtof_subsystem: SECOND_TARGET must be 0, or READOUT must be READOUT_POOLPOINTER")
  `DTOF_REQUIRE(g_illegal_amplitude, AMPLITUDE == 0 || (POOL != 0 && RASTER_ORDER == 0),
                "dtof_subsystem: AMPLITUDE must be 0, or READOUT must be READOUT_POOLPOINTER and RASTER_ORDER 0")
  `DTOF_REQUIRE(g_illegal_prior, PRIOR == 0 || POOL != 0,
                "dtof_subsystem: PRIOR must be 0, or READOUT must be READOUT_POOLPOINTER")
  `DTOF_REQUIRE(g_illegal_raw, RAW_HISTOGRAM == 0 || (POOL == 0 && RASTER_ORDER == 0),
                "dtof_subsystem: RAW_HISTOGRAM must be 0 for READOUT_POOLPOINTER, and where RASTER_ORDER is 1")
  `DTOF_REQUIRE(g_illegal_coarse, COARSE_SHARE >= 1 && COARSE_SHARE <= 62, "dtof_subsystem: COARSE_SHARE must be 1 to 62")
  `DTOF_REQUIRE(g_illegal_track, TRACK_SHARE >= 1 && COARSE_SHARE + TRACK_SHARE <= 63,
                "dtof_subsystem: TRACK_SHARE must be at least 1, and at most 63 together with COARSE_SHARE")
  `DTOF_REQUIRE(g_illegal_srams, SRAM_NUM >= 1 && SRAM_NUM <= 1024, "dtof_subsystem: SRAM_NUM must be 1 to 1024")
  `DTOF_REQUIRE(g_illegal_pixels, PIXELS_PER_SRAM >= 1 && PIXELS_PER_SRAM <= 4096,
                "dtof_subsystem: PIXELS_PER_SRAM must be 1 to 4096")
  `DTOF_REQUIRE(g_illegal_acquisition, ACQUISITION_LINES <= 65535,
                "dtof_subsystem: PIXELS_PER_SRAM times SLOTS must be at most 65535")
  `DTOF_REQUIRE(g_illegal_buffer, BUFFER_LINES >= 2 && BUFFER_LINES <= 65534,
                "dtof_subsystem: BUFFER_LINES must be 2 to 65534")
  `DTOF_REQUIRE(g_illegal_wait, SOURCE_WAITS == 1 || BUFFER_LINES >= SLOTS,
                "dtof_subsystem: BUFFER_LINES must be at least SLOTS with SOURCE_WAITS = 0")
  `DTOF_REQUIRE(g_illegal_clock, CLOCK_WAITS == 0 || CLOCK_WAITS == 1, "dtof_subsystem: CLOCK_WAITS must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_source, SOURCE_WAITS == 0 || SOURCE_WAITS == 1, "dtof_subsystem: SOURCE_WAITS must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_parity, PARITY == 0 || PARITY == 1, "dtof_subsystem: PARITY must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_self_test, SELF_TEST == 0 || SELF_TEST == 1, "dtof_subsystem: SELF_TEST must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_raster_order, RASTER_ORDER == 0 || RASTER_ORDER == 1, "dtof_subsystem: RASTER_ORDER must be 0 or 1")

  // Commands and settings.
  logic start, flush, flushes, abort, continuous, second, amplitude, raw, short_words, smooth, prior, self_test, shot_reseed;
  logic [ACQ_WIDTH-1:0] acquisitions, coarse_end, track_end;
  logic [NP-1:0] gate_begin, gate_end;
  logic [SRAM_NUM-1:0] enable, frame_enable;  // frame_enable: of the present frame
  logic [2:0] shot_bits;
  logic [7:0] shot_unit;
  logic [11:0] raw_first, raw_last;
  logic [15:0] release_lines, weak_below, settle, shot_seed;
  logic [23:0] watchdog;
  logic [31:0] test_seed, test_expected;
  logic [255:0] coarse_template;

  // Status and events.
  logic begin_frame, running, busy, done, frame, starting, resetting, in_reset, array_rst_n, stream_rst_n;
  logic start_ignored, illegal_schedule, underrun, short_acquisition, long_acquisition, overrun, counter_full, aborted, timeout, stalled;
  logic dropped, words_left, words_unfinished, word_ends, frame_crc_pending, line_parity_error, result_parity_error, array_parity_error;
  logic test_chosen, test_refused, test_frame, test_busy, test_passed, test_failed;  // test_frame: the frame that began last is a self-test
  logic [2:0] state;
  logic [15:0] level, shot_state;
  logic [31:0] frame_count, frame_cycles, frame_crc, lost_lines, lost_acquisitions, parity_errors;

  // Lines to the array and results of the array; array_waits: the array's clock is stopped, because a line is late.
  logic array_valid, array_ready, array_waits, result_tvalid, result_tready, result_tlast;
  logic [SRAM_NUM*NP-1:0] array_line, test_line;
  logic [RESULT_WIDTH-1:0] result_tdata;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] line_cfg, array_cfg, result_cfg;

  assign sram_cfg_o = line_cfg & array_cfg & result_cfg;
  assign flushes = flush && (abort || !running);
  assign frame = word_ends && !test_frame;
  assign overrun = ((s_axis_tvalid_i && !s_axis_tready_o) || dropped) && m_axis_tvalid_o && !m_axis_tready_i;

  dtof_apb_registers #(
      .READOUT(READOUT), .HAS_SCHEDULE(POOL), .TIME_GATE(TIME_GATE), .RASTER_ORDER(RASTER_ORDER), .PARITY(PARITY), .SELF_TEST(SELF_TEST),
      .CLOCK_WAITS(CLOCK_WAITS), .SOURCE_WAITS(SOURCE_WAITS), .SECOND_TARGET(SECOND_TARGET), .AMPLITUDE(AMPLITUDE), .PRIOR(PRIOR),
      .RAW_HISTOGRAM(RAW_HISTOGRAM), .RAW_BINS(RAW_BINS), .NP(NP), .SRAM_NUM(SRAM_NUM), .PIXELS_PER_SRAM(PIXELS_PER_SRAM), .SLOTS(SLOTS),
      .FRACTION_WIDTH(FRACTION_WIDTH), .CONFIDENCE_WIDTH(RESULT_CONFIDENCE_WIDTH), .ACQ_WIDTH(ACQ_WIDTH), .COUNT_WIDTH(COUNT_WIDTH),
      .NB((POOL != 0) ? POOL_NB : NB), .WINDOW_CENTRED(WINDOW_CENTRED), .POINTER_STEP(POINTER_STEP),
      .GUARD((READOUT == dtof_pkg::READOUT_HISPOINTER) ? GUARD : 0), .GROUP_SIZE(GROUP_SIZE), .LABELS(LABELS), .SCORE_BITS(SCORE_BITS),
      .OFFSET_BITS(OFFSET_BITS), .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH), .POINTER_SHIFT(POINTER_SHIFT), .CELL_SHIFT(CELL_SHIFT),
      .RIVAL_MOVES(RIVAL_MOVES), .ENGINE_COLUMNS(ENGINE_COLUMNS), .COARSE_SHARE(COARSE_SHARE), .TRACK_SHARE(TRACK_SHARE),
      .BUFFER_LINES(BUFFER_LINES), .MOST_RELEASE(MOST_RELEASE)
  ) u_registers (
      .clk_i               (clk_i),
      .rst_ni              (rst_ni),
      .starting_i          (starting),
      .psel_i              (psel_i),
      .penable_i           (penable_i),
      .pwrite_i            (pwrite_i),
      .paddr_i             (paddr_i),
      .pwdata_i            (pwdata_i),
      .pstrb_i             (pstrb_i),
      .pready_o            (pready_o),
      .prdata_o            (prdata_o),
      .pslverr_o           (pslverr_o),
      .start_o             (start),
      .self_test_o         (self_test),
      .flush_o             (flush),
      .abort_o             (abort),
      .continuous_o        (continuous),
      .watchdog_o          (watchdog),
      .shot_seed_o         (shot_seed),
      .shot_reseed_o       (shot_reseed),
      .self_test_seed_o    (test_seed),
      .self_test_expected_o(test_expected),
      .second_o            (second),
      .amplitude_o         (amplitude),
      .raw_o               (raw),
      .raw_first_o         (raw_first),
      .raw_last_o          (raw_last),
      .acquisitions_o      (acquisitions),
      .coarse_end_o        (coarse_end),
      .track_end_o         (track_end),
      .smooth_o            (smooth),
      .template_o          (coarse_template),
      .prior_o             (prior),
      .short_words_o       (short_words),
      .gate_begin_o        (gate_begin),
      .gate_end_o          (gate_end),
      .release_o           (release_lines),
      .weak_below_o        (weak_below),
      .enable_o            (enable),
      .shot_bits_o         (shot_bits),
      .shot_unit_o         (shot_unit),
      .settle_o            (settle),
      .busy_i              (busy),
      .state_i             (state),
      .level_i             (level),
      .frame_count_i       (frame_count),
      .frame_cycles_i      (frame_cycles),
      .frame_crc_i         (frame_crc),
      .frame_crc_pending_i (frame_crc_pending),
      .lost_lines_i        (lost_lines),
      .lost_acquisitions_i (lost_acquisitions),
      .shot_state_i        (shot_state),
      .parity_errors_i     (parity_errors),
      .self_test_busy_i    (test_busy),
      .self_test_passed_i  (test_passed),
      .frame_i             (frame),
      .underrun_i          (underrun),
      .start_ignored_i     (start_ignored || test_refused),
      .illegal_schedule_i  (illegal_schedule),
      .overrun_i           (overrun),
      .short_i             (short_acquisition),
      .long_i              (long_acquisition),
      .timeout_i           (timeout),
      .stalled_i           (stalled),
      .flush_ignored_i     (flush && !flushes),
      .parity_error_i      (line_parity_error || result_parity_error || array_parity_error),
      .self_test_failed_i  (test_failed),
      .aborted_i           (aborted),
      .counter_full_i      (counter_full),
      .irq_o               (irq_o)
  );

  dtof_frame_control #(
      .HAS_SCHEDULE   (POOL),
      .ACQ_WIDTH      (ACQ_WIDTH),
      .MOST_RELEASE   (MOST_RELEASE),
      .RAW_HISTOGRAM  (RAW_HISTOGRAM),
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM)
  ) u_frame_control (
      .clk_i             (clk_i),
      .rst_ni            (rst_ni),
      .start_i           (start && !test_refused),
      .abort_i           (abort),
      .resetting_i       (resetting || (test_busy && !running)),
      .continuous_i      (continuous && !test_frame),
      .acquisitions_i    (acquisitions),
      .coarse_end_i      (coarse_end),
      .track_end_i       (track_end),
      .release_i         (release_lines),
      .raw_i             (raw),
      .raw_first_i       (raw_first),
      .raw_last_i        (raw_last),
      .begin_o           (begin_frame),
      .done_i            (done),
      .frame_i           (frame),
      .unfinished_i      (words_unfinished),
      .running_o         (running),
      .busy_o            (busy),
      .start_ignored_o   (start_ignored),
      .illegal_schedule_o(illegal_schedule),
      .aborted_o         (aborted),
      .frame_count_o     (frame_count),
      .frame_cycles_o    (frame_cycles)
  );

  dtof_array_reset u_array_reset (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .scan_mode_i  (scan_mode_i),
      .abort_i      (abort),
      .busy_o       (resetting),
      .reset_o      (in_reset),
      .array_rst_no (array_rst_n),
      .stream_rst_no(stream_rst_n)
  );

  // The array's reset after rst_ni: the first access to a register waits for its end.
  logic starting_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      starting_q <= 1'b1;
    end else begin
      starting_q <= starting;
    end
  end

  assign starting = starting_q && resetting;

  dtof_optional_self_test #(
      .SELF_TEST(SELF_TEST), .NP(NP), .PIXELS_PER_SRAM(PIXELS_PER_SRAM), .SRAM_NUM(SRAM_NUM), .SLOTS(SLOTS)
  ) u_self_test (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .self_test_i (self_test),
      .words_left_i(words_left),
      .busy_i      (busy),
      .begin_i     (begin_frame),
      .abort_i     (abort),
      .seed_i      (test_seed),
      .expected_i  (test_expected),
      .take_i      (array_valid && array_ready),
      .word_ends_i (word_ends),
      .crc_i       (frame_crc),
      .refused_o   (test_refused),
      .chosen_o    (test_chosen),
      .frame_o     (test_frame),
      .line_o      (test_line),
      .busy_o      (test_busy),
      .passed_o    (test_passed),
      .failed_o    (test_failed)
  );

  dtof_line_path #(
      .NP(NP), .PIXELS_PER_SRAM(PIXELS_PER_SRAM), .SRAM_NUM(SRAM_NUM), .SLOTS(SLOTS), .PARITY(PARITY), .TIME_GATE(TIME_GATE),
      .ACQ_WIDTH(ACQ_WIDTH), .CLOCK_WAITS(CLOCK_WAITS), .SOURCE_WAITS(SOURCE_WAITS), .BUFFER_LINES(BUFFER_LINES),
      .MOST_RELEASE(MOST_RELEASE)
  ) u_line_path (
      .clk_i              (clk_i),
      .rst_ni             (rst_ni),
      .sram_cfg_i         (sram_cfg_i),
      .sram_cfg_o         (line_cfg),
      .begin_i            (begin_frame),
      .running_i          (running),
      .done_i             (done),
      .abort_i            (abort),
      .flush_i            (flushes),
      .resetting_i        (resetting),
      .enable_i           (enable),
      .gate_begin_i       (gate_begin),
      .gate_end_i         (gate_end),
      .release_i          (release_lines),
      .acquisitions_i     (acquisitions),
      .settle_i           (settle),
      .watchdog_i         (watchdog),
      .shot_bits_i        (shot_bits),
      .shot_unit_i        (shot_unit),
      .shot_seed_i        (shot_seed),
      .shot_reseed_i      (shot_reseed),
      .test_chosen_i      (test_chosen),
      .test_frame_i       (test_frame),
      .test_line_i        (test_line),
      .s_axis_tvalid_i    (s_axis_tvalid_i),
      .s_axis_tready_o    (s_axis_tready_o),
      .s_axis_tdata_i     (s_axis_tdata_i),
      .s_axis_tlast_i     (s_axis_tlast_i),
      .shot_o             (shot_o),
      .line_valid_o       (array_valid),
      .line_ready_i       (array_ready),
      .line_o             (array_line),
      .waits_o            (array_waits),
      .enable_o           (frame_enable),
      .level_o            (level),
      .lost_lines_o       (lost_lines),
      .lost_acquisitions_o(lost_acquisitions),
      .shot_state_o       (shot_state),
      .underrun_o         (underrun),
      .short_o            (short_acquisition),
      .long_o             (long_acquisition),
      .timeout_o          (timeout),
      .dropped_o          (dropped),
      .parity_error_o     (line_parity_error)
  );

  dtof_gated_array #(
      .READOUT(READOUT), .CLOCK_WAITS(CLOCK_WAITS),
      // parameters of dtof_gated_array: written by scripts/generate.py from readouts.toml
      .NP(NP), .NB(NB), .PIXELS_PER_SRAM(PIXELS_PER_SRAM), .SRAM_NUM(SRAM_NUM), .SLOTS(SLOTS), .COUNT_WIDTH(COUNT_WIDTH),
      .POINTER_STEP(POINTER_STEP), .FRACTION_BITS(FRACTION_BITS), .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH), .GUARD(GUARD),
      .WINDOW_CENTRED(WINDOW_CENTRED), .POINTER_PORTS(POINTER_PORTS), .SIGNALLED_CLEAR(SIGNALLED_CLEAR), .PARITY(PARITY),
      .RAW_HISTOGRAM(RAW_HISTOGRAM), .ACQ_WIDTH(ACQ_WIDTH), .BROADCAST_STAGES(BROADCAST_STAGES), .GROUP_SIZE(GROUP_SIZE),
      .LABELS(LABELS), .SCORE_BITS(SCORE_BITS), .OFFSET_BITS(OFFSET_BITS), .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT(POINTER_SHIFT), .RIVAL_MOVES(RIVAL_MOVES), .CELL_SHIFT(CELL_SHIFT), .SECOND_TARGET(SECOND_TARGET),
      .AMPLITUDE(AMPLITUDE), .PRIOR(PRIOR), .ENGINE_COLUMNS(ENGINE_COLUMNS),
      // end of parameters of dtof_gated_array
      .RESULT_WIDTH(RESULT_WIDTH)
  ) u_gated_array (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .scan_mode_i    (scan_mode_i),
      .array_rst_ni   (array_rst_n),
      .in_reset_i     (in_reset),
      .sram_cfg_i     (sram_cfg_i),
      .sram_cfg_o     (array_cfg),
      .begin_i        (begin_frame),
      .acquisitions_i (acquisitions),
      .coarse_end_i   (coarse_end),
      .track_end_i    (track_end),
      .smooth_i       (smooth),
      .prior_i        (prior),
      .template_i     (coarse_template),
      .raw_i          (raw),
      .raw_first_i    (raw_first),
      .raw_last_i     (raw_last),
      .done_o         (done),
      .state_o        (state),
      .counter_full_o (counter_full),
      .parity_error_o (array_parity_error),
      .waits_i        (array_waits),
      .line_valid_i   (array_valid),
      .line_ready_o   (array_ready),
      .line_i         (array_line),
      .result_tvalid_o(result_tvalid),
      .result_tready_i(result_tready),
      .result_tdata_o (result_tdata),
      .result_tlast_o (result_tlast)
  );

  dtof_result_path #(
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM), .SRAM_NUM(SRAM_NUM), .PARITY(PARITY), .RASTER_ORDER(RASTER_ORDER),
      .SECOND_TARGET(SECOND_TARGET), .AMPLITUDE(AMPLITUDE), .RAW_HISTOGRAM(RAW_HISTOGRAM), .POSITION_WIDTH(POSITION_WIDTH),
      .CONFIDENCE_WIDTH(RESULT_CONFIDENCE_WIDTH), .KEPT_CONFIDENCE_WIDTH(KEPT_CONFIDENCE_WIDTH),
      .COUNTER_WIDTH((POOL != 0) ? 0 : RESULT_CONFIDENCE_WIDTH), .RAW_COUNTER_WIDTH(COUNT_WIDTH), .AMPLITUDE_WIDTH(AMPLITUDE_WIDTH),
      .PLACE_WIDTH(PLACE_WIDTH)
  ) u_result_path (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .stream_rst_ni  (stream_rst_n),
      .sram_cfg_i     (sram_cfg_i),
      .sram_cfg_o     (result_cfg),
      .begin_i        (begin_frame),
      .abort_i        (abort),
      .resetting_i    (resetting),
      .test_frame_i   (test_frame),
      .weak_below_i   (weak_below),
      .short_words_i  (short_words),
      .second_i       (second),
      .amplitude_i    (amplitude),
      .raw_i          (raw),
      .enable_i       (frame_enable),
      .watchdog_i     (watchdog),
      .result_tvalid_i(result_tvalid),
      .result_tready_o(result_tready),
      .result_tdata_i (result_tdata),
      .result_tlast_i (result_tlast),
      .m_axis_tvalid_o(m_axis_tvalid_o),
      .m_axis_tready_i(m_axis_tready_i),
      .m_axis_tdata_o (m_axis_tdata_o),
      .m_axis_tuser_o (m_axis_tuser_o),
      .m_axis_tlast_o (m_axis_tlast_o),
      .words_left_o   (words_left),
      .unfinished_o   (words_unfinished),
      .word_ends_o    (word_ends),
      .crc_o          (frame_crc),
      .crc_pending_o  (frame_crc_pending),
      .stalled_o      (stalled),
      .parity_error_o (result_parity_error)
  );

  dtof_saturating_counter #(
      .STEP_WIDTH(2)
  ) u_parity_errors (
      .clk_i  (clk_i),
      .rst_ni (rst_ni),
      .step_i (2'(line_parity_error) + 2'(result_parity_error) + 2'(array_parity_error)),
      .count_o(parity_errors)
  );

endmodule

`default_nettype wire
