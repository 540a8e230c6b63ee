// SPDX-License-Identifier: Apache-2.0
// Read-out of a SPAD array: SRAM_NUM columns of PIXELS_PER_SRAM pixels; input TDC timestamps, output depth codes. Equations:
// docs/reference/readouts.md.
//
// 1. start_i begins a frame: the number of acquisitions and the time gate are sampled, and the memories are cleared.
// 2. Timestamps stream in, acquisition by acquisition, the same pixel of all columns in a clock. Every column counts
//    them in its histogram, or moves its pointer.
// 3. If a read-out takes several passes, the histograms are scanned for their peaks and cleared after each pass but the
//    last. The peaks select the timestamps of the next pass.
// 4. After the last pass the pixels are scanned row by row for their results. The results of a row leave through a chain of
//    one register per column, column 0 first, while the next row is scanned.
//
// Logic that all columns share exists once: state, counters, clear and scan addresses in dtof_array_control, the result handshake in
// dtof_result_output. A column has its SRAMs and its arithmetic. READOUT selects the column (dtof_columns.svh). The numbers of passes and bins of
// a read-out, and whether it has a word per pixel, come from dtof_readouts.svh. Both files are written from readouts.toml.
//
// Frame: start_i samples acq_num_i (0 and 1 are legal) and the gate; busy_o stays high up to the clock of done_o
//   (docs/user/integration.md).
// TDC stream: an acquisition starts in the clock in which tdc_valid_i and tdc_ready_o are high; this clock has pixel 0, slot 0
//   of every column. The other PIXELS_PER_SRAM * SLOTS - 1 timestamps follow in consecutive clocks with valid and ready
//   high. Between acquisitions the source may pause. All ones: no detection.
// Result: AXI4-Stream, tdata = {column, row, code, fraction, confidence}; row by row, column by column in a row.
// Raw frame (RAW_HISTOGRAM = 1, raw_i with start_i): the array sends histograms instead of results: those that it holds at the
//   frame's end, of rows raw_first_row_i to raw_last_row_i, row by row, bin by bin, column by column. code is the lowest code of
//   the bin, limited to 0 .. 2^NP - 1, fraction is 0, confidence is the count.
// Borders: every signal between the shared logic and the columns runs from a register to a register (dtof_broadcast.sv). The
//   heads of the result chain and of the chain of full counters come back. Timestamps run from the port, which counts as the
//   TDC's register, to the registers of their column (dtof_timestamp_input.sv).
// Schedule: clocks T0 to T5 of a timestamp (dtof_pixel_sequencer) and S0 to S3 of a scanned address (dtof_scan_sequencer).
// Latency: the first result leaves after the frame's last acquisition and the scan of the first row.
// Cycles of a frame: ACQ_NUM * PIXELS_PER_SRAM * SLOTS + addresses to clear and to scan in M1 + for each row the
// larger of SRAM_NUM + BROADCAST_STAGES + 2 and the addresses to scan in M4.
// Cost at the defaults: see reports/area.md.
`include "dtof_macros.svh"
`include "dtof_readout_range.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_array #(
    parameter int READOUT = dtof_pkg::READOUT_EZPOINTER,  // dtof_pkg::READOUT_*
    parameter int NP = 10,               // bits of a timestamp, 3 to 16
    parameter int NB = 5,                // bits of the coarse index, 1 to NP
    parameter int PIXELS_PER_SRAM = 160,  // pixels of a column
    parameter int SRAM_NUM = 200,        // columns
    parameter int SLOTS = 2,             // timestamps per pixel and acquisition, 1 to 16
    parameter int COUNT_WIDTH = 10,      // bits of a histogram bin, 1 to 16
    parameter int POINTER_STEP = 1,      // bins that a pointer moves, 1 to 2^(NP-1) - 1
    parameter int FRACTION_BITS = 0,     // fractional bits of a pointer, 0 to 8, with NP at most 16
    parameter int CONFIDENCE_WIDTH = 4,  // bits of a pointer's confidence, 0 for none, at most 8
    parameter int GUARD = 46,            // hisPointer v2: ceil(FWHM / T_res), at most 2^NP
    parameter int WINDOW_CENTRED = 0,    // SiFH: 1 centres the window on the coarse bin
    parameter int POINTER_PORTS = 2,     // ports of the pointer SRAM; 1 needs SLOTS >= 2
    parameter int SIGNALLED_CLEAR = 0,   // 1: a status bit per address replaces clearing
    parameter int PARITY = 0,            // 1: each word of the SRAMs has a parity bit, which is checked at each read
    parameter int TIME_GATE = 0,         // 1: timestamps outside [gate_begin_i, gate_end_i) are no detections
    parameter int RAW_HISTOGRAM = 0,     // 1: raw_i has an effect; a confidence has at least COUNT_WIDTH bits
    parameter int ACQ_WIDTH = 16,        // bits of the run-time number of acquisitions
    parameter int BROADCAST_STAGES = 2,  // registers between the shared logic and the columns, 1 to 8
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int KEPT_CONFIDENCE_WIDTH = dtof_pkg::kept_confidence_width(CONFIDENCE_WIDTH, COUNT_WIDTH, RAW_HISTOGRAM),
    localparam int RESULT_WIDTH = dtof_pkg::result_width(READOUT, NP, COUNT_WIDTH, FRACTION_BITS, KEPT_CONFIDENCE_WIDTH),
    localparam int TDATA_WIDTH = COLUMN_WIDTH + ROW_WIDTH + RESULT_WIDTH
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    // side band of the SRAM macros, the same for all; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,  // AND of the cfg_o of all SRAM macros
    // frame
    input  logic                   start_i,          // ignored while busy_o is high, also in the clock of done_o
    input  logic [  ACQ_WIDTH-1:0] acq_num_i,        // acquisitions of the frame, sampled with start_i
    input  logic [         NP-1:0] gate_begin_i,     // time gate of the frame, sampled with start_i
    input  logic [         NP-1:0] gate_end_i,
    input  logic                   raw_i,            // 1: a raw frame; raw_i and its rows are sampled with start_i
    input  logic [  ROW_WIDTH-1:0] raw_first_row_i,
    input  logic [  ROW_WIDTH-1:0] raw_last_row_i,   // raw_first_row_i to PIXELS_PER_SRAM - 1
    output logic                   busy_o,           // from the clock after start_i to the clock of done_o
    output logic                   done_o,           // for one clock, after the last result was taken
    output logic [            2:0] state_o,          // dtof_pkg::STATE_*
    output logic [dtof_pkg::ERROR_WIDTH-1:0] error_o,  // dtof_pkg::ERROR_*, one clock per error (dtof_array_errors)
    output logic                   counter_full_o,   // the first counter of a histogram is full; only while busy_o is high
    output logic                   parity_error_o,   // with PARITY = 1: a word with a wrong parity was read; only while busy_o is high
    // TDC stream
    input  logic                   tdc_valid_i,      // high for a whole acquisition
    output logic                   tdc_ready_o,      // an acquisition may start, or is in progress
    input  logic [SRAM_NUM*NP-1:0] tdc_timestamp_i,  // column 0 in the lowest bits
    // results, AXI4-Stream
    output logic                   result_tvalid_o,
    input  logic                   result_tready_i,
    output logic [TDATA_WIDTH-1:0] result_tdata_o,
    output logic                   result_tlast_o    // last column of the last row
);

  `DTOF_REQUIRE(g_illegal_readout, dtof_pkg::is_readout(READOUT), `DTOF_READOUT_RANGE)
  `DTOF_REQUIRE(g_illegal_np, NP >= 3 && NP <= 16, "dtof_array: NP must be 3 to 16")
  `DTOF_REQUIRE(g_illegal_nb, NB >= 1 && NB <= NP, "dtof_array: NB must be 1 to NP")
  `DTOF_REQUIRE(g_illegal_pixels, PIXELS_PER_SRAM >= 1, "dtof_array: PIXELS_PER_SRAM must be at least 1")
  `DTOF_REQUIRE(g_illegal_srams, SRAM_NUM >= 1, "dtof_array: SRAM_NUM must be at least 1")
  `DTOF_REQUIRE(g_illegal_slots, SLOTS >= 1 && SLOTS <= 16, "dtof_array: SLOTS must be 1 to 16")
  `DTOF_REQUIRE(g_illegal_count, COUNT_WIDTH >= 1 && COUNT_WIDTH <= 16, "dtof_array: COUNT_WIDTH must be 1 to 16")
  `DTOF_REQUIRE(g_illegal_step, POINTER_STEP >= 1 && POINTER_STEP < (1 << (NP - 1)),
                "dtof_array: POINTER_STEP must be 1 to 2^(NP-1) - 1")
  `DTOF_REQUIRE(g_illegal_fraction, FRACTION_BITS >= 0 && FRACTION_BITS <= 8 && NP + FRACTION_BITS <= 16,
                "dtof_array: FRACTION_BITS must be 0 to 8 and NP + FRACTION_BITS at most 16")
  `DTOF_REQUIRE(g_illegal_confidence, CONFIDENCE_WIDTH >= 0 && CONFIDENCE_WIDTH <= 8,
                "dtof_array: CONFIDENCE_WIDTH must be 0 to 8")
  `DTOF_REQUIRE(g_illegal_guard,
                READOUT != dtof_pkg::READOUT_HISPOINTER || (GUARD >= 0 && GUARD <= (1 << NP)),
                "dtof_array: GUARD must be 0 to 2^NP")
  `DTOF_REQUIRE(g_illegal_ports, POINTER_PORTS == 2 || (POINTER_PORTS == 1 && SLOTS >= 2),
                "dtof_array: POINTER_PORTS must be 2, or 1 with SLOTS of at least 2")
  `DTOF_REQUIRE(g_illegal_raw, RAW_HISTOGRAM == 0 || (RAW_HISTOGRAM == 1 && dtof_pkg::has_whole_histogram(READOUT, NP, NB)),
                "dtof_array: RAW_HISTOGRAM must be 0, or 1 with a histogram that is whole at a frame's end")
  `DTOF_REQUIRE(g_illegal_parity, PARITY == 0 || PARITY == 1, "dtof_array: PARITY must be 0 or 1")
  `DTOF_REQUIRE(g_illegal_acq_width, ACQ_WIDTH >= 1 && ACQ_WIDTH <= 24, "dtof_array: ACQ_WIDTH must be 1 to 24")

  `DTOF_REQUIRE(g_illegal_broadcast, BROADCAST_STAGES >= 1 && BROADCAST_STAGES <= 8,
                "dtof_array: BROADCAST_STAGES must be 1 to 8")

  localparam int HISTOGRAM = dtof_pkg::has_histogram(READOUT) ? 1 : 0;
  localparam int COARSE_PASSES = dtof_pkg::coarse_passes(READOUT, NP, NB);
  localparam int PASS_WIDTH = dtof_pkg::index_width(COARSE_PASSES + 1);
  localparam int BIN_WIDTH = dtof_pkg::bin_width(READOUT, NP, NB);
  localparam int SCAN_WIDTH = dtof_pkg::scan_address_width(READOUT, NP, NB, FRACTION_BITS);
  localparam int STEP_WIDTH = dtof_pkg::step_width(POINTER_STEP, dtof_pkg::fraction_width(READOUT, FRACTION_BITS));
  localparam int COMMAND_WIDTH = dtof_pkg::command_width(READOUT, NP, NB, PIXELS_PER_SRAM, POINTER_STEP, FRACTION_BITS);

  // Control, once per array. Commands of all columns go through the registers of the broadcast.

  `include "dtof_column_commands.svh"

  logic [COMMAND_WIDTH-1:0] sent;
  command_t received;
  logic result_start, result_shift, result_done, result_busy, last_row;
  logic [ROW_WIDTH-1:0] row;

  dtof_array_control #(
      .READOUT        (READOUT),
      .NP             (NP),
      .NB             (NB),
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .SLOTS          (SLOTS),
      .POINTER_STEP   (POINTER_STEP),
      .FRACTION_BITS  (FRACTION_BITS),
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR),
      .TIME_GATE      (TIME_GATE),
      .RAW_HISTOGRAM  (RAW_HISTOGRAM),
      .ACQ_WIDTH      (ACQ_WIDTH)
  ) u_control (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .start_i        (start_i),
      .acq_num_i      (acq_num_i),
      .gate_begin_i   (gate_begin_i),
      .gate_end_i     (gate_end_i),
      .raw_i          (raw_i),
      .raw_first_row_i(raw_first_row_i),
      .raw_last_row_i (raw_last_row_i),
      .busy_o         (busy_o),
      .done_o         (done_o),
      .state_o        (state_o),
      .error_o        (error_o),
      .tdc_valid_i    (tdc_valid_i),
      .tdc_ready_o    (tdc_ready_o),
      .sent_o         (sent),
      .result_start_o (result_start),
      .last_row_o     (last_row),
      .row_o          (row),
      .result_shift_i (result_shift),
      .result_done_i  (result_done),
      .result_busy_i  (result_busy)
  );

  dtof_broadcast #(
      .WIDTH (COMMAND_WIDTH),
      .STAGES(BROADCAST_STAGES)
  ) u_broadcast (
      .clk_i (clk_i),
      .rst_ni(rst_ni),
      .from_i(sent),
      .to_o  (received)
  );

  // Columns and their result chain: chain[c] is the result of column c; column SRAM_NUM - 1 shifts zeros in.

  logic [(SRAM_NUM+1)*RESULT_WIDTH-1:0] chain;
  assign chain[SRAM_NUM*RESULT_WIDTH+:RESULT_WIDTH] = '0;

  // Events of full counters move in the same direction, one column per clock, while timestamps stream in. The last event arrives before
  // the results of the first row have left.
  logic [SRAM_NUM:0] full_chain, parity_chain;
  assign full_chain[SRAM_NUM] = 1'b0;
  assign parity_chain[SRAM_NUM] = 1'b0;

  // Column c of any read-out: all columns have the same ports. (Only signals are connected, because Yosys 0.23 stops at an
  // expression that takes its width from a port of a module with included ports.)
`define DTOF_COLUMN(MODULE) \
  MODULE #( \
      .READOUT         (READOUT), \
      .NP              (NP), \
      .NB              (NB), \
      .PIXELS_PER_SRAM (PIXELS_PER_SRAM), \
      .SLOTS           (SLOTS), \
      .COUNT_WIDTH     (COUNT_WIDTH), \
      .POINTER_STEP    (POINTER_STEP), \
      .FRACTION_BITS   (FRACTION_BITS), \
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH), \
      .GUARD           (GUARD), \
      .WINDOW_CENTRED  (WINDOW_CENTRED), \
      .POINTER_PORTS   (POINTER_PORTS), \
      .SIGNALLED_CLEAR (SIGNALLED_CLEAR), \
      .PARITY          (PARITY), \
      .TIME_GATE       (TIME_GATE), \
      .RAW_HISTOGRAM   (RAW_HISTOGRAM), \
      .BROADCAST_STAGES(BROADCAST_STAGES) \
  ) u_column ( \
      .clk_i                  (clk_i), \
      .rst_ni                 (rst_ni), \
      .sram_cfg_i             (sram_cfg_i), \
      .sram_cfg_o             (column_cfg[c*dtof_pkg::SRAM_CFG_WIDTH+:dtof_pkg::SRAM_CFG_WIDTH]), \
      .timestamp_i            (tdc_timestamp_i[c*NP+:NP]), \
      .gate_begin_i           (received.gate_begin), \
      .gate_end_i             (received.gate_end), \
      .pass_i                 (received.pass), \
      .first_pass_i           (received.first_pass), \
      .final_pass_i           (received.final_pass), \
      .first_slot_t0_i        (received.first_slot_t0), \
      .beat_t1_i              (received.beat_t1), \
      .visit_t1_i             (received.visit_t1), \
      .first_acq_t1_i         (received.first_acq_t1), \
      .step_t0_i              (received.step_t0), \
      .same_pixel_t3_i        (received.same_pixel_t3), \
      .beat_t5_i              (received.beat_t5), \
      .histogram_read_pixel_i (received.histogram_read_pixel), \
      .histogram_write_pixel_i(received.histogram_write_pixel), \
      .scan_s0_i              (received.scan_s0), \
      .scan_bin_s0_i          (received.scan_bin_s0), \
      .clear_s1_i             (received.clear_s1), \
      .clear_bin_s1_i         (received.clear_bin_s1), \
      .clear_all_i            (received.clear_all), \
      .scan_s2_i              (received.scan_s2), \
      .first_s2_i             (received.first_s2), \
      .bin_s2_i               (received.bin_s2), \
      .word_read_i            (received.word_read), \
      .word_read_pixel_i      (received.word_read_pixel), \
      .word_read_done_i       (received.word_read_done), \
      .word_set_i             (received.word_set), \
      .word_set_pixel_i       (received.word_set_pixel), \
      .word_write_i           (received.word_write), \
      .word_write_pixel_i     (received.word_write_pixel), \
      .result_load_i          (received.result_load), \
      .result_shift_i         (received.result_shift), \
      .next_column_i          (chain[(c+1)*RESULT_WIDTH+:RESULT_WIDTH]), \
      .result_o               (chain[c*RESULT_WIDTH+:RESULT_WIDTH]), \
      .next_counter_full_i    (full_chain[c+1]), \
      .counter_full_o         (full_chain[c]), \
      .next_parity_error_i    (parity_chain[c+1]), \
      .parity_error_o         (parity_chain[c]) \
  );

  logic [SRAM_NUM*dtof_pkg::SRAM_CFG_WIDTH-1:0] column_cfg;
  integer i;

  always_comb begin
    sram_cfg_o = '1;
    for (i = 0; i < SRAM_NUM; i = i + 1) begin
      sram_cfg_o = sram_cfg_o & column_cfg[i*dtof_pkg::SRAM_CFG_WIDTH+:dtof_pkg::SRAM_CFG_WIDTH];
    end
  end

  genvar c;
  generate
    for (c = 0; c < SRAM_NUM; c = c + 1) begin : g_column
      `include "dtof_columns.svh"
    end
  endgenerate
`undef DTOF_COLUMN

  // Register at the head of the result chain.
  logic [RESULT_WIDTH-1:0] head_q;
  always_ff @(posedge clk_i) begin
    head_q <= chain[RESULT_WIDTH-1:0];
  end

  dtof_event_link u_full_counter_head (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .event_i      (1'b0),
      .next_column_i(HISTOGRAM != 0 && full_chain[0]),  // a constant without histograms, so that synthesis removes the register
      .event_o      (counter_full_o)
  );

  dtof_event_link #(
      .PRESENT(PARITY)
  ) u_parity_head (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .event_i      (1'b0),
      .next_column_i(parity_chain[0]),
      .event_o      (parity_error_o)
  );

  `DTOF_ASSERT(a_parity_error_in_frame, !parity_error_o || busy_o, "a word was found damaged outside of a frame")
  `DTOF_ASSERT(a_counter_full_in_frame, !counter_full_o || busy_o, "a counter got full outside of a frame")

  dtof_result_output #(
      .SRAM_NUM    (SRAM_NUM),
      .ROW_WIDTH   (ROW_WIDTH),
      .RESULT_WIDTH(RESULT_WIDTH),
      .LATENCY     (BROADCAST_STAGES + 1)
  ) u_result_output (
      .clk_i     (clk_i),
      .rst_ni    (rst_ni),
      .start_i   (result_start),
      .last_row_i(last_row),
      .row_i     (row),
      .head_i    (head_q),
      .shift_o   (result_shift),
      .done_o    (result_done),
      .busy_o    (result_busy),
      .tvalid_o  (result_tvalid_o),
      .tready_i  (result_tready_i),
      .tdata_o   (result_tdata_o),
      .tlast_o   (result_tlast_o)
  );

endmodule

`default_nettype wire
