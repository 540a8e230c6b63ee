// SPDX-License-Identifier: Apache-2.0
// An array of any read-out with registers (APB4), lines of timestamps in and results out as AXI4-Streams of whole bytes, and an
// interrupt (docs/user/integration.md). For AXI4-Lite put dtof_axi_lite_to_apb in front.
//
// 1. Software writes the registers and CONTROL.START. A frame uses the settings of the last commit before the frame begins.
// 2. The source may deliver lines of timestamps at any pace, before and during frames. With CLOCK_WAITS = 1 the array takes each line
//    when it arrives, and the array's clock stops while a line is late inside an acquisition. With CLOCK_WAITS = 0, for clocks that
//    cannot be gated, the line buffer offers an acquisition to the array when all its lines have arrived. (A smaller RELEASE offers
//    it earlier, with the risk of an underrun.)
// 3. Timestamps of disabled columns, and timestamps outside the time gate, count as no detection.
// 4. Results leave as words of 64 bits with a status, in the array's order or row by row, or as short words of 32 bits, two in each
//    beat (OUTPUT.SHORT_WORDS). While the sink waits, the array waits.
//    With SECOND_TARGET = 1 a frame can also have a word for each pixel's second target. With AMPLITUDE = 1 a frame's words can have
//    amplitude and ambient in place of row and column. With RAW_HISTOGRAM = 1 a frame can send
//    histograms of chosen rows instead of results.
// 5. After the sink has taken a frame's last result, the subsystem raises the interrupt; in continuous mode the next frame has begun
//    by then. With SETTLE the subsystem drops the acquisitions at a frame's start, in which a laser settles (dtof_settle).
// 6. Between frames the array's clock is gated (dtof_clock_gate of the technology folder).
// 7. Every frame ends, whatever the source does: missing lines count as no detection, a new acquisition begins after each
//    s_axis_tlast_i, and a watchdog ends the wait for a dead source. CONTROL.ABORT ends a frame at any time.
// 8. shot_o fires the laser and starts the TDCs, once for each acquisition that a frame needs. SHOT adds a pseudo-random delay
//    (dtof_shot_dither). If the laser runs freely, leave shot_o unconnected.
// 9. With SELF_TEST = 1, CONTROL.SELF_TEST begins a self-test: a frame of pseudo-random lines, whose checksum the hardware compares
//    (dtof_self_test). The source's lines wait, no shot is fired, and the words stay inside.
//
// READOUT selects the read-out: dtof_pkg::READOUT_*. READOUT_POOLPOINTER is dtof_pool_pointer_array, all others are dtof_array. The
// parameters that follow are those of the arrays, with the default of the read-out.
// Latency: one clock from a line to the array (two if the line buffer is an SRAM), one clock from the array to a result.
// Cost: the array, BUFFER_LINES lines, two bits per column, and the modules of this folder (reports/fpga_check.md).
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_subsystem #(
    parameter int READOUT = dtof_pkg::READOUT_EZPOINTER,
    // parameters of the arrays: written by scripts/generate.py from readouts.toml
    // verilator lint_off UNUSEDPARAM
    // bits of a TDC timestamp
    parameter int NP = 10,
    // bits of the coarse histogram index
    parameter int NB = (READOUT == dtof_pkg::READOUT_SIFH) ? (NP / 2) + 1
        : (READOUT == dtof_pkg::READOUT_PIFH) ? dtof_pkg::min_of(NP, 6)
        : (READOUT == dtof_pkg::READOUT_HISTOGRAM) ? NP
        : (READOUT == dtof_pkg::READOUT_COARSEHISTOGRAM) ? dtof_pkg::min_of(NP, 5)
        : NP / 2,
    // pixels a column serves
    parameter int PIXELS_PER_SRAM = 160,
    // columns working in parallel
    parameter int SRAM_NUM = 200,
    // timestamps per pixel and acquisition
    parameter int SLOTS = 2,
    // bits of a histogram bin, a counter that never wraps
    parameter int COUNT_WIDTH = (READOUT == dtof_pkg::READOUT_POOLPOINTER) ? 7
        : 10,
    // bins a pointer moves per timestamp
    parameter int POINTER_STEP = 1,
    // fractional bits of the pointer
    parameter int FRACTION_BITS = (READOUT == dtof_pkg::READOUT_COARSEHISTOGRAM) ? dtof_pkg::min_of(2, (16 - NP))
        : 0,
    // bits of a pointer's confidence, 0 for none
    parameter int CONFIDENCE_WIDTH = 4,
    // hisPointer: side band beyond half a coarse bin, the FWHM of 2 ns in 45 ns
    parameter int GUARD = ((2 << NP) + 44) / 45,
    // SiFH: window centred on the coarse bin (Fig. 3.8) instead of Eq. 2.5
    parameter int WINDOW_CENTRED = 0,
    // ports of the pointer SRAM; 1 halves its cell
    parameter int POINTER_PORTS = 2,
    // one status bit an address instead of clearing
    parameter int SIGNALLED_CLEAR = 0,
    // 1: each word of the SRAMs has a parity bit, which is checked at each read
    parameter int PARITY = 0,
    // 1: only timestamps from `gate_begin_i` to below `gate_end_i` count
    parameter int TIME_GATE = 0,
    // 1: a frame may send histograms instead of results (`raw_i`)
    parameter int RAW_HISTOGRAM = 0,
    // bits of the run-time number of acquisitions
    parameter int ACQ_WIDTH = 16,
    // registers between the shared logic and the columns; they delay, and change no result
    parameter int BROADCAST_STAGES = 2,
    // rows of a group, which shares a coarse histogram
    parameter int GROUP_SIZE = 4,
    // candidates of a group
    parameter int LABELS = 5,
    // bits of their scores
    parameter int SCORE_BITS = 4,
    // bits of a leader's offset in the track phase, 0 for none
    parameter int OFFSET_BITS = 6,
    // bits of the leader's advantage
    parameter int ADVANTAGE_WIDTH = 7,
    // a pointer's unit is 2^(POINTER_SHIFT - 11) coarse bins
    parameter int POINTER_SHIFT = 1,
    // 1: the rival has a pointer of its own
    parameter int RIVAL_MOVES = 1,
    // windows of a settled pointer: 8 for pulses below 0.75 coarse bins (FWHM), 10 from 2.25
    parameter int CELL_SHIFT = 9,
    // 1: a result has the position of the label that lost, too
    parameter int SECOND_TARGET = 0,
    // 1: a result has amplitude and ambient, too
    parameter int AMPLITUDE = 0,
    // 1: candidates may begin from those that were used in the last frame (`prior_i`)
    parameter int PRIOR = 0,
    // columns that share an engine
    parameter int ENGINE_COLUMNS = 34,
    // 64ths of a frame that the coarse phase is recommended to take
    parameter int COARSE_SHARE = 14,
    // 64ths of a frame that the track phase is recommended to take
    parameter int TRACK_SHARE = 30,
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
  localparam int MOST_REGISTERS = 8;  // lines; a longer buffer is an SRAM
  localparam int LEVEL_WIDTH = $clog2(BUFFER_LINES + 2);
  localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM);
  localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM);
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
  localparam int TARGETS = (SECOND_TARGET != 0) ? 2 : 1;
  localparam int AMPLITUDE_WIDTH = (AMPLITUDE != 0) ? dtof_pkg::pool_amplitude_width(ADVANTAGE_WIDTH) : 0;
  localparam int PLACE_WIDTH = COLUMN_WIDTH + ROW_WIDTH + dtof_pkg::pool_light_width(ADVANTAGE_WIDTH, AMPLITUDE);  // with ambient and amplitude
  localparam int TARGET_WIDTH = PLACE_WIDTH + POSITION_WIDTH + KEPT_CONFIDENCE_WIDTH;
  localparam int RESULT_WIDTH = TARGET_WIDTH + (TARGETS - 1) * POSITION_WIDTH;

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
  `DTOF_REQUIRE(g_illegal_clock, CLOCK_WAITS == 0 || CLOCK_WAITS == 1, "dtof_subsystem: CLOCK_WAITS must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_source, SOURCE_WAITS == 0 || SOURCE_WAITS == 1, "dtof_subsystem: SOURCE_WAITS must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_parity, PARITY == 0 || PARITY == 1, "dtof_subsystem: PARITY must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_self_test, SELF_TEST == 0 || SELF_TEST == 1, "dtof_subsystem: SELF_TEST must be 0 or 1")

  // Registers and control of frames.

  logic [255:0] coarse_template;
  logic start, flush, abort, continuous, second, amplitude, raw, short_words, smooth, prior, begin_frame, running, busy, done, frame;
  logic start_ignored, illegal_schedule, underrun, short_acquisition, long_acquisition, overrun, counter_full, aborted;
  logic timeout, stalled, starting, resetting, in_reset, array_rst_n, stream_rst_n, flushes;
  logic [23:0] watchdog;
  logic [15:0] shot_seed, shot_state;
  logic [2:0] shot_bits;
  logic [7:0] shot_unit;
  logic shot_reseed;
  logic [31:0] lost_lines, lost_acquisitions, parity_errors;
  logic line_parity_error, raster_parity_error, array_parity_error;
  logic [ACQ_WIDTH-1:0] acquisitions, coarse_end, track_end;
  logic [NP-1:0] gate_begin, gate_end;
  logic [15:0] release_lines, weak_below, settle;
  logic [11:0] raw_first, raw_last;
  logic [SRAM_NUM-1:0] enable;
  logic [2:0] state;
  logic [LEVEL_WIDTH-1:0] level;
  logic [31:0] frame_count, frame_cycles, frame_crc;
  logic frame_crc_pending;
  // self_test comes with start; test_frame: the frame that began last is a self-test; words_left: the sink has not taken all words
  logic self_test, test_chosen, test_refused, test_frame, test_busy, test_passed, test_failed, words_left;
  logic [31:0] test_seed, test_expected;

  dtof_apb_registers #(
      .READOUT         (READOUT),
      .HAS_SCHEDULE    (POOL),
      .TIME_GATE       (TIME_GATE),
      .RASTER_ORDER    (RASTER_ORDER),
      .PARITY          (PARITY),
      .SELF_TEST       (SELF_TEST),
      .CLOCK_WAITS     (CLOCK_WAITS),
      .SOURCE_WAITS    (SOURCE_WAITS),
      .SECOND_TARGET   (SECOND_TARGET),
      .AMPLITUDE       (AMPLITUDE),
      .PRIOR           (PRIOR),
      .RAW_HISTOGRAM   (RAW_HISTOGRAM),
      .RAW_BINS        (RAW_BINS),
      .NP              (NP),
      .SRAM_NUM        (SRAM_NUM),
      .PIXELS_PER_SRAM (PIXELS_PER_SRAM),
      .SLOTS           (SLOTS),
      .FRACTION_WIDTH  (FRACTION_WIDTH),
      .CONFIDENCE_WIDTH(RESULT_CONFIDENCE_WIDTH),
      .ACQ_WIDTH       (ACQ_WIDTH),
      .COUNT_WIDTH     (COUNT_WIDTH),
      .NB              ((POOL != 0) ? POOL_NB : NB),
      .WINDOW_CENTRED  (WINDOW_CENTRED),
      .POINTER_STEP    (POINTER_STEP),
      .GUARD           ((READOUT == dtof_pkg::READOUT_HISPOINTER) ? GUARD : 0),
      .GROUP_SIZE      (GROUP_SIZE),
      .LABELS          (LABELS),
      .SCORE_BITS      (SCORE_BITS),
      .OFFSET_BITS     (OFFSET_BITS),
      .ADVANTAGE_WIDTH (ADVANTAGE_WIDTH),
      .POINTER_SHIFT   (POINTER_SHIFT),
      .CELL_SHIFT      (CELL_SHIFT),
      .RIVAL_MOVES     (RIVAL_MOVES),
      .ENGINE_COLUMNS  (ENGINE_COLUMNS),
      .COARSE_SHARE    (COARSE_SHARE),
      .TRACK_SHARE     (TRACK_SHARE),
      .BUFFER_LINES    (BUFFER_LINES),
      .MOST_RELEASE    (MOST_RELEASE)
  ) u_registers (
      .clk_i             (clk_i),
      .rst_ni            (rst_ni),
      .starting_i        (starting),
      .psel_i            (psel_i),
      .penable_i         (penable_i),
      .pwrite_i          (pwrite_i),
      .paddr_i           (paddr_i),
      .pwdata_i          (pwdata_i),
      .pstrb_i           (pstrb_i),
      .pready_o          (pready_o),
      .prdata_o          (prdata_o),
      .pslverr_o         (pslverr_o),
      .start_o           (start),
      .self_test_o       (self_test),
      .flush_o           (flush),
      .abort_o           (abort),
      .continuous_o      (continuous),
      .watchdog_o        (watchdog),
      .shot_seed_o       (shot_seed),
      .shot_reseed_o     (shot_reseed),
      .self_test_seed_o    (test_seed),
      .self_test_expected_o(test_expected),
      .second_o          (second),
      .amplitude_o       (amplitude),
      .raw_o             (raw),
      .raw_first_o       (raw_first),
      .raw_last_o        (raw_last),
      .acquisitions_o    (acquisitions),
      .coarse_end_o      (coarse_end),
      .track_end_o       (track_end),
      .smooth_o          (smooth),
      .template_o        (coarse_template),
      .prior_o           (prior),
      .short_words_o     (short_words),
      .gate_begin_o      (gate_begin),
      .gate_end_o        (gate_end),
      .release_o         (release_lines),
      .weak_below_o      (weak_below),
      .enable_o          (enable),
      .shot_bits_o       (shot_bits),
      .shot_unit_o       (shot_unit),
      .settle_o          (settle),
      .busy_i            (busy),
      .state_i           (state),
      .level_i           (16'(level)),
      .frame_count_i     (frame_count),
      .frame_cycles_i    (frame_cycles),
      .frame_crc_i       (frame_crc),
      .frame_crc_pending_i(frame_crc_pending),
      .lost_lines_i      (lost_lines),
      .lost_acquisitions_i(lost_acquisitions),
      .shot_state_i      (shot_state),
      .parity_errors_i   (parity_errors),
      .self_test_busy_i  (test_busy),
      .self_test_passed_i(test_passed),
      .frame_i           (frame),
      .underrun_i        (underrun),
      .start_ignored_i   (start_ignored || test_refused),
      .illegal_schedule_i(illegal_schedule),
      .overrun_i         (overrun),
      .short_i           (short_acquisition),
      .long_i            (long_acquisition),
      .timeout_i         (timeout),
      .stalled_i         (stalled),
      .flush_ignored_i   (flush && !flushes),
      .parity_error_i    (line_parity_error || raster_parity_error || array_parity_error),
      .self_test_failed_i(test_failed),
      .aborted_i         (aborted),
      .counter_full_i    (counter_full),
      .irq_o             (irq_o)
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

  // A self-test begins when all words have left, so that the words behind its begin are its own.
  assign test_refused = self_test && words_left;
  assign test_chosen = self_test && !words_left && !busy;

  // Settings of the present frame; the array samples its own.

  logic [SRAM_NUM-1:0] frame_enable_q;
  logic [NP-1:0] frame_gate_begin_q, frame_gate_end_q;
  logic [15:0] frame_release_q;
  logic [15:0] frame_weak_below_q;
  logic frame_short_q;  // a raw frame has no short words

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      frame_release_q <= 16'(MOST_RELEASE);
    end else if (begin_frame) begin
      frame_release_q <= release_lines;
    end
  end

  always_ff @(posedge clk_i) begin
    if (begin_frame) begin
      frame_enable_q <= enable;
      frame_gate_begin_q <= gate_begin;
      frame_gate_end_q <= gate_end;
      frame_weak_below_q <= weak_below;
      frame_short_q <= short_words && !raw;
    end
  end

  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] buffer_cfg, array_cfg, raster_cfg;

  assign sram_cfg_o = buffer_cfg & array_cfg & raster_cfg;

  // Lines of timestamps.

  logic tdc_valid, tdc_ready, starved, kept, expired, queued, source_inside, source_early, arrives, rest_ends, taken, dropped;
  logic line_waits;   // a line is late inside an acquisition
  logic drops;        // the acquisition that leaves the line buffer is dropped
  logic settle_takes, line_ready, taken_last, array_valid;
  logic array_waits;  // the array's clock is stopped, because a line is late
  logic [1:0] lost_acquisition;
  logic [LEVEL_WIDTH:0] lost;
  logic [SRAM_NUM*NP-1:0] line, timestamps;

  dtof_line_buffer #(
      .ACQUISITION_LINES(ACQUISITION_LINES),
      .LINES            (BUFFER_LINES),
      .WIDTH            (SRAM_NUM * NP),
      .REGISTERS        ((BUFFER_LINES <= MOST_REGISTERS) ? 1 : 0),
      .CLOCK_WAITS      (CLOCK_WAITS),
      .SOURCE_WAITS     (SOURCE_WAITS),
      .PARITY           (PARITY)
  ) u_line_buffer (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .sram_cfg_i  (sram_cfg_i),
      .sram_cfg_o  (buffer_cfg),
      .flush_i     (flushes),
      .abort_i     (abort),
      .expire_i    (expired && running),
      .done_i      (done),
      .release_i   (frame_release_q),
      .level_o     (level),
      .starved_o   (starved),
      .wait_o      (line_waits),
      .queued_o    (queued),
      .inside_o    (source_inside),
      .early_o     (source_early),
      .kept_o      (kept),
      .arrives_o   (arrives),
      .rest_ends_o (rest_ends),
      .taken_o     (taken),
      .taken_last_o(taken_last),
      .underrun_o  (underrun),
      .short_o     (short_acquisition),
      .long_o      (long_acquisition),
      .dropped_o   (dropped),
      .lost_lines_o(lost),
      .parity_error_o(line_parity_error),
      .lost_acquisitions_o(lost_acquisition),
      .s_tvalid_i  (s_axis_tvalid_i),
      .s_tready_o  (s_axis_tready_o),
      .s_tdata_i   (s_axis_tdata_i[SRAM_NUM*NP-1:0]),
      .s_tlast_i   (s_axis_tlast_i),
      .line_valid_o(tdc_valid),
      .line_ready_i(line_ready && !resetting),
      .line_o      (line)
  );

  assign flushes = flush && (abort || !running);

  dtof_watchdog #(
      .WIDTH(24)
  ) u_line_watchdog (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .limit_i  (watchdog),
      .waits_i  (starved && running && !kept && !test_frame),
      .expired_o(expired)
  );

  assign timeout = expired && running && starved && !abort;

  // Acquisitions that a frame drops, and all that it needs; a frame without acquisitions takes none.
  localparam int NEED_WIDTH = dtof_pkg::max_of(ACQ_WIDTH, 16) + 1;
  logic [15:0] frame_settle;
  logic [NEED_WIDTH-1:0] needed;

  assign frame_settle = (acquisitions == '0 || test_chosen) ? '0 : settle;
  assign needed = test_chosen ? '0 : NEED_WIDTH'(acquisitions) + NEED_WIDTH'(frame_settle);
  assign line_ready = (tdc_ready || settle_takes) && !test_frame;
  assign array_waits = line_waits && !drops;
  assign array_valid = test_frame ? running : tdc_valid && !line_waits && !drops;

  dtof_settle #(
      .WIDTH(16)
  ) u_settle (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .settle_i (frame_settle),
      .begin_i  (begin_frame),
      .abort_i  (abort),
      .give_up_i(timeout),
      .first_i  (taken),
      .last_i   (taken_last),
      .drops_o  (drops),
      .takes_o  (settle_takes)
  );

  dtof_shot_dither #(
      .ACQ_WIDTH(NEED_WIDTH)
  ) u_shot_dither (
      .clk_i         (clk_i),
      .rst_ni        (rst_ni),
      .reseed_i      (shot_reseed),
      .seed_i        (shot_seed),
      .bits_i        (shot_bits),
      .unit_i        (shot_unit),
      .acquisitions_i(needed),
      .begin_i       (begin_frame),
      .abort_i       (abort),
      .flush_i       (flushes),
      .give_up_i     (timeout),
      .arrives_i     (arrives),
      .queued_i      (queued),
      .taken_i       (taken),
      .inside_i      (source_inside),
      .early_i       (source_early),
      .rest_ends_i   (rest_ends),
      .shot_o        (shot_o),
      .first_state_o (shot_state)
  );

  dtof_watchdog #(
      .WIDTH(24)
  ) u_result_watchdog (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .limit_i  (watchdog),
      .waits_i  (m_axis_tvalid_o && !m_axis_tready_i),
      .expired_o(stalled)
  );

  dtof_saturating_counter #(
      .STEP_WIDTH(LEVEL_WIDTH + 1)
  ) u_lost_lines (
      .clk_i  (clk_i),
      .rst_ni (rst_ni),
      .step_i (lost),
      .count_o(lost_lines)
  );

  dtof_saturating_counter #(
      .STEP_WIDTH(2)
  ) u_lost_acquisitions (
      .clk_i  (clk_i),
      .rst_ni (rst_ni),
      .step_i (lost_acquisition),
      .count_o(lost_acquisitions)
  );

  dtof_saturating_counter #(
      .STEP_WIDTH(2)
  ) u_parity_errors (
      .clk_i  (clk_i),
      .rst_ni (rst_ni),
      .step_i (2'(line_parity_error) + 2'(raster_parity_error) + 2'(array_parity_error)),
      .count_o(parity_errors)
  );

  generate
    if (S_TDATA_WIDTH > SRAM_NUM * NP) begin : g_padding
      logic unused_padding;
      assign unused_padding = ^s_axis_tdata_i[S_TDATA_WIDTH-1:SRAM_NUM*NP];
    end
  endgenerate

  logic [SRAM_NUM*NP-1:0] array_line;
  logic word_ends;

  generate
    if (SELF_TEST != 0) begin : g_self_test
      logic [SRAM_NUM*NP-1:0] test_line;
      dtof_self_test #(
          .NP             (NP),
          .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
          .SRAM_NUM       (SRAM_NUM),
          .SLOTS          (SLOTS)
      ) u_self_test (
          .clk_i      (clk_i),
          .rst_ni     (rst_ni),
          .clear_i    (self_test),
          .chosen_i   (test_chosen),
          .begin_i    (begin_frame),
          .abort_i    (abort),
          .seed_i     (test_seed),
          .expected_i (test_expected),
          .take_i     (array_valid && tdc_ready),
          .word_ends_i(word_ends),
          .crc_i      (frame_crc),
          .line_o     (test_line),
          .frame_o    (test_frame),
          .busy_o     (test_busy),
          .passed_o   (test_passed),
          .failed_o   (test_failed)
      );
      assign array_line = test_frame ? test_line : line;
      `DTOF_ASSERT(a_source_rests, !test_frame || !running || (!line_waits && !drops), "lines of the source are inside a self-test")
    end else begin : g_no_self_test
      logic unused_self_test;
      assign unused_self_test = ^{test_seed, test_expected, word_ends};
      assign array_line = line;
      assign {test_frame, test_busy, test_passed, test_failed} = '0;
    end
  endgenerate

  dtof_line_filter #(
      .NP       (NP),
      .SRAM_NUM (SRAM_NUM),
      .TIME_GATE(TIME_GATE)
  ) u_line_filter (
      .line_i      (array_line),
      .enable_i    (frame_enable_q),
      .gate_begin_i(frame_gate_begin_q),
      .gate_end_i  (frame_gate_end_q),
      .line_o      (timestamps)
  );

  // The array. Its clock is stopped between frames, and while a line is late inside an acquisition. In a reset the clock runs, so
  // that the pipelines hold no data from before. While the gate suppresses a clock edge, the array's outputs have no effect: they
  // are still there in the next clock. If the gate does not work, the array's assertion a_contiguous_acquisition fails.

  logic array_clk, array_busy, array_done, array_counter_full, array_damaged;

  dtof_clock_gate #(
      .NEEDED(CLOCK_WAITS)
  ) u_array_clock (
      .clk_i      (clk_i),
      .enable_i   (((begin_frame || array_busy) && !array_waits) || in_reset),
      .scan_mode_i(scan_mode_i),
      .clk_o      (array_clk)
  );

  logic array_tvalid, result_tvalid, result_tready, result_tlast;
  logic [RESULT_WIDTH-1:0] result_tdata;

  assign done = array_done && !array_waits;
  assign counter_full = array_counter_full && !array_waits;
  assign array_parity_error = array_damaged && !array_waits;
  assign result_tvalid = array_tvalid && !array_waits;
  logic [dtof_pkg::ERROR_WIDTH-1:0] array_error;

  generate
    if (POOL != 0) begin : g_pool
      assign array_counter_full = 1'b0;  // no event: sweeps make room in its coarse bins
      dtof_pool_pointer_array #(
          // parameters of dtof_pool_pointer_array: written by scripts/generate.py from readouts.toml
          .NP(NP),
          .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
          .SRAM_NUM(SRAM_NUM),
          .SLOTS(SLOTS),
          .COUNT_WIDTH(COUNT_WIDTH),
          .GROUP_SIZE(GROUP_SIZE),
          .LABELS(LABELS),
          .SCORE_BITS(SCORE_BITS),
          .OFFSET_BITS(OFFSET_BITS),
          .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
          .POINTER_SHIFT(POINTER_SHIFT),
          .RIVAL_MOVES(RIVAL_MOVES),
          .CELL_SHIFT(CELL_SHIFT),
          .PARITY(PARITY),
          .SECOND_TARGET(SECOND_TARGET),
          .AMPLITUDE(AMPLITUDE),
          .PRIOR(PRIOR),
          .ENGINE_COLUMNS(ENGINE_COLUMNS),
          .ACQ_WIDTH(ACQ_WIDTH),
          .BROADCAST_STAGES(BROADCAST_STAGES)
          // end of parameters of dtof_pool_pointer_array
      ) u_array (
          .clk_i          (array_clk),
          .rst_ni         (array_rst_n),
          .sram_cfg_i     (sram_cfg_i),
          .sram_cfg_o     (array_cfg),
          .start_i        (begin_frame),
          .acq_num_i      (acquisitions),
          .gate_begin_i   ({NP{1'b0}}),
          .gate_end_i     ({NP{1'b0}}),
          .coarse_end_i   (coarse_end),
          .track_end_i    (track_end),
          .smooth_i       (smooth),
          .prior_i        (prior),
          .template_i     (coarse_template),
          .busy_o         (array_busy),
          .done_o         (array_done),
          .state_o        (state),
          .error_o        (array_error),
          .parity_error_o (array_damaged),
          .tdc_valid_i    (array_valid),
          .tdc_ready_o    (tdc_ready),
          .tdc_timestamp_i(timestamps),
          .result_tvalid_o(array_tvalid),
          .result_tready_i(result_tready),
          .result_tdata_o (result_tdata),
          .result_tlast_o (result_tlast)
      );
    end else begin : g_array
      logic unused_settings;
      assign unused_settings = ^{smooth, prior, coarse_template};
      dtof_array #(
          .READOUT(READOUT),
          // parameters of dtof_array: written by scripts/generate.py from readouts.toml
          .NP(NP),
          .NB(NB),
          .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
          .SRAM_NUM(SRAM_NUM),
          .SLOTS(SLOTS),
          .COUNT_WIDTH(COUNT_WIDTH),
          .POINTER_STEP(POINTER_STEP),
          .FRACTION_BITS(FRACTION_BITS),
          .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
          .GUARD(GUARD),
          .WINDOW_CENTRED(WINDOW_CENTRED),
          .POINTER_PORTS(POINTER_PORTS),
          .SIGNALLED_CLEAR(SIGNALLED_CLEAR),
          .PARITY(PARITY),
          .RAW_HISTOGRAM(RAW_HISTOGRAM),
          .ACQ_WIDTH(ACQ_WIDTH),
          .BROADCAST_STAGES(BROADCAST_STAGES)
          // end of parameters of dtof_array
      ) u_array (
          .clk_i          (array_clk),
          .rst_ni         (array_rst_n),
          .sram_cfg_i     (sram_cfg_i),
          .sram_cfg_o     (array_cfg),
          .start_i        (begin_frame),
          .acq_num_i      (acquisitions),
          .gate_begin_i   ({NP{1'b0}}),
          .gate_end_i     ({NP{1'b0}}),
          .raw_i          (raw),
          .raw_first_row_i(ROW_WIDTH'(raw_first)),
          .raw_last_row_i (ROW_WIDTH'(raw_last)),
          .busy_o         (array_busy),
          .done_o         (array_done),
          .state_o        (state),
          .error_o        (array_error),
          .counter_full_o (array_counter_full),
          .parity_error_o (array_damaged),
          .tdc_valid_i    (array_valid),
          .tdc_ready_o    (tdc_ready),
          .tdc_timestamp_i(timestamps),
          .result_tvalid_o(array_tvalid),
          .result_tready_i(result_tready),
          .result_tdata_o (result_tdata),
          .result_tlast_o (result_tlast)
      );
    end
  endgenerate

  // The array cannot report an error: line buffer and frame control detect errors before and report them in the registers.
  `DTOF_ASSERT(a_no_array_error, array_error == '0 || array_waits, "the array met a master's error that should have been kept from it")

  `DTOF_ASSERT(a_begin_when_idle, !(begin_frame && array_busy), "a frame begins while another is under way")

  // Results: one word per target.

  logic target_tvalid, target_tready, target_second, target_tlast;
  logic [TARGET_WIDTH-1:0] target_tdata;

  generate
    if (SECOND_TARGET != 0) begin : g_second_target
      logic frame_second_q;
      always_ff @(posedge clk_i) begin
        if (begin_frame) begin
          frame_second_q <= second;
        end
      end

      dtof_target_words #(
          .PLACE_WIDTH     (PLACE_WIDTH),
          .POSITION_WIDTH  (POSITION_WIDTH),
          .CONFIDENCE_WIDTH(RESULT_CONFIDENCE_WIDTH)
      ) u_target_words (
          .clk_i     (clk_i),
          .rst_ni    (stream_rst_n),
          .both_i    (frame_second_q),
          .s_tvalid_i(result_tvalid),
          .s_tready_o(result_tready),
          .s_tdata_i (result_tdata),
          .s_tlast_i (result_tlast),
          .m_tvalid_o(target_tvalid),
          .m_tready_i(target_tready),
          .m_tdata_o (target_tdata),
          .m_second_o(target_second),
          .m_tlast_o (target_tlast)
      );
    end else begin : g_one_target
      logic unused_here;
      assign unused_here = ^{second, stream_rst_n};
      assign result_tready = target_tready;
      assign target_tvalid = result_tvalid;
      assign target_tdata = result_tdata;
      assign target_second = 1'b0;
      assign target_tlast = result_tlast;
    end
  endgenerate

  logic frame_amplitude;

  generate
    if (AMPLITUDE != 0) begin : g_amplitude
      logic frame_amplitude_q;
      always_ff @(posedge clk_i) begin
        if (begin_frame) begin
          frame_amplitude_q <= amplitude;
        end
      end
      assign frame_amplitude = frame_amplitude_q;
    end else begin : g_no_amplitude
      logic unused_amplitude;
      assign unused_amplitude = amplitude;
      assign frame_amplitude = 1'b0;
    end
  endgenerate

  logic frame_raw;

  generate
    if (RAW_HISTOGRAM != 0) begin : g_raw_histogram
      logic frame_raw_q;
      always_ff @(posedge clk_i) begin
        if (begin_frame) begin
          frame_raw_q <= raw;
        end
      end
      assign frame_raw = frame_raw_q;
    end else begin : g_results_alone
      logic unused_raw;
      assign unused_raw = ^{raw, raw_first, raw_last};
      assign frame_raw = 1'b0;
    end
  endgenerate

  // Words are stored for a slow sink at one place only, which keeps the rules of the stream when a frame is cut off: in u_stream_output, or in
  // raster order in u_raster_buffer.
  logic word_tvalid, word_tready, word_tuser, word_tlast, word_short, output_rst_n, output_cut, aborted_word;
  logic out_tvalid, out_tready, out_taken;  // of the port, and of words of a self-test, which stay inside

  assign m_axis_tvalid_o = out_tvalid && !test_frame;
  assign out_tready = m_axis_tready_i || test_frame;
  assign out_taken = out_tvalid && out_tready;
  assign word_ends = out_taken && m_axis_tlast_o && !aborted_word;
  logic [M_TDATA_WIDTH-1:0] word_tdata;
  logic ordered_tvalid, ordered_tready, ordered_tuser, ordered_tlast, ordered_short;  // in the order in which the words leave
  logic [M_TDATA_WIDTH-1:0] ordered_tdata;

  dtof_stream_output #(
      .SRAM_NUM         (SRAM_NUM),
      .ROW_WIDTH        (ROW_WIDTH),
      .POSITION_WIDTH   (POSITION_WIDTH),
      .CONFIDENCE_WIDTH (KEPT_CONFIDENCE_WIDTH),
      .HAS_CONFIDENCE   ((RESULT_CONFIDENCE_WIDTH > 0) ? 1 : 0),
      .COUNTER_WIDTH    ((POOL != 0) ? 0 : RESULT_CONFIDENCE_WIDTH),
      .RAW_COUNTER_WIDTH(COUNT_WIDTH),
      .AMPLITUDE_WIDTH  (AMPLITUDE_WIDTH)
  ) u_stream_output (
      .clk_i          (clk_i),
      .rst_ni         (output_rst_n),
      .weak_below_i   (frame_weak_below_q),
      .enable_i       (frame_enable_q),
      .raw_i          (frame_raw),
      .amplitude_i    (frame_amplitude),
      .short_i        (frame_short_q),
      .cut_i          (output_cut),
      .result_tvalid_i(target_tvalid && !resetting),
      .result_tready_o(target_tready),
      .result_tdata_i (target_tdata),
      .result_second_i(target_second),
      .result_tlast_i (target_tlast),
      .m_axis_tvalid_o(word_tvalid),
      .m_axis_tready_i(word_tready),
      .m_axis_tdata_o (word_tdata),
      .m_axis_tuser_o (word_tuser),
      .m_axis_tlast_o (word_tlast),
      .m_axis_short_o (word_short)
  );

  generate
    if (RASTER_ORDER != 0) begin : g_raster_order
      localparam int COLUMN_LSB = dtof_registers_pkg::RESULT_COLUMN_LSB;
      localparam int ROW_LSB = dtof_registers_pkg::RESULT_ROW_LSB;
      localparam int STATUS_LSB = dtof_registers_pkg::RESULT_VALID_LSB;
      localparam int STATUS_WIDTH = dtof_registers_pkg::RESULT_SATURATED_LSB + 1 - STATUS_LSB;
      localparam int CONFIDENCE_LSB = dtof_registers_pkg::RESULT_CONFIDENCE_LSB;
      localparam int KEPT_CONFIDENCE = dtof_pkg::max_of(RESULT_CONFIDENCE_WIDTH, 1);
      localparam int KEPT_WIDTH = STATUS_WIDTH + KEPT_CONFIDENCE + POSITION_WIDTH;

      logic [STATUS_WIDTH-1:0] status;
      logic [KEPT_CONFIDENCE-1:0] confidence;
      logic [POSITION_WIDTH-1:0] position;
      logic [COLUMN_WIDTH-1:0] column;
      logic [ROW_WIDTH-1:0] row;
      logic second_word;

      assign output_rst_n = stream_rst_n;
      assign output_cut = 1'b0;
      assign words_left = word_tvalid || !word_tready;

      dtof_raster_buffer #(
          .SRAM_NUM       (SRAM_NUM),
          .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
          .WIDTH          (KEPT_WIDTH),
          .PARITY         (PARITY),
          .TARGETS        (TARGETS)
      ) u_raster_buffer (
          .clk_i     (clk_i),
          .rst_ni    (rst_ni),
          .sram_cfg_i(sram_cfg_i),
          .sram_cfg_o(raster_cfg),
          .parity_error_o(raster_parity_error),
          .cut_i     (abort),
          .s_tvalid_i(word_tvalid),
          .s_tready_o(word_tready),
          .s_result_i({word_tdata[STATUS_LSB+:STATUS_WIDTH], word_tdata[CONFIDENCE_LSB+:KEPT_CONFIDENCE],
                       word_tdata[dtof_registers_pkg::RESULT_POSITION_LSB+:POSITION_WIDTH]}),
          .s_column_i(word_tdata[COLUMN_LSB+:COLUMN_WIDTH]),
          .s_row_i   (word_tdata[ROW_LSB+:ROW_WIDTH]),
          .s_second_i(word_tdata[dtof_registers_pkg::RESULT_SECOND_LSB]),
          .s_tlast_i (word_tlast),
          .m_tvalid_o(ordered_tvalid),
          .m_tready_i(ordered_tready),
          .m_result_o({status, confidence, position}),
          .m_column_o(column),
          .m_row_o   (row),
          .m_second_o(second_word),
          .m_aborted_o(aborted_word),
          .m_tlast_o (ordered_tlast)
      );

      // The frame that leaves the buffer: the next frame's words are not accepted before its end.
      logic short_q;
      always_ff @(posedge clk_i) begin
        if (word_tvalid && word_tready) begin
          short_q <= word_short;
        end
      end
      assign ordered_short = short_q;

      always_comb begin
        ordered_tdata = '0;
        if (aborted_word) begin
          ordered_tdata[dtof_registers_pkg::RESULT_ABORTED_LSB] = 1'b1;
        end else begin
          ordered_tdata[STATUS_LSB+:STATUS_WIDTH] = status;
          ordered_tdata[CONFIDENCE_LSB+:KEPT_CONFIDENCE] = confidence;
          ordered_tdata[dtof_registers_pkg::RESULT_POSITION_LSB+:POSITION_WIDTH] = position;
          ordered_tdata[COLUMN_LSB+:COLUMN_WIDTH] = column;
          ordered_tdata[ROW_LSB+:ROW_WIDTH] = row;
          ordered_tdata[dtof_registers_pkg::RESULT_SECOND_LSB] = second_word;
        end
      end
      assign ordered_tuser = (column == '0) && (row == '0) && !second_word && !aborted_word;

      logic unused_word;
      assign unused_word = ^{word_tuser, word_tdata};
    end else begin : g_array_order
      assign output_rst_n = rst_ni;
      assign output_cut = abort;
      assign aborted_word = word_tdata[dtof_registers_pkg::RESULT_ABORTED_LSB];
      assign raster_cfg = '1;
      assign raster_parity_error = 1'b0;
      assign words_left = word_tvalid;
      assign word_tready = ordered_tready;
      assign ordered_tvalid = word_tvalid;
      assign ordered_tdata = word_tdata;
      assign ordered_tuser = word_tuser;
      assign ordered_tlast = word_tlast;
      assign ordered_short = word_short;
    end
  endgenerate

  dtof_word_packer u_word_packer (
      .clk_i     (clk_i),
      .rst_ni    (rst_ni),
      .short_i   (ordered_short),
      .s_tvalid_i(ordered_tvalid),
      .s_tready_o(ordered_tready),
      .s_tdata_i (ordered_tdata),
      .s_tuser_i (ordered_tuser),
      .s_tlast_i (ordered_tlast),
      .m_tvalid_o(out_tvalid),
      .m_tready_i(out_tready),
      .m_tdata_o (m_axis_tdata_o),
      .m_tuser_o (m_axis_tuser_o),
      .m_tlast_o (m_axis_tlast_o)
  );

  dtof_frame_crc #(
      .WIDTH(M_TDATA_WIDTH)
  ) u_frame_crc (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .taken_i  (out_taken),
      .word_i   (m_axis_tdata_o),
      .first_i  (m_axis_tuser_o),
      .last_i   (m_axis_tlast_o),
      .aborted_i(aborted_word),
      .pending_o(frame_crc_pending),
      .crc_o    (frame_crc)
  );

  assign frame = word_ends && !test_frame;
  assign overrun = ((s_axis_tvalid_i && !s_axis_tready_o) || dropped) && m_axis_tvalid_o && !m_axis_tready_i;

endmodule

`default_nettype wire
