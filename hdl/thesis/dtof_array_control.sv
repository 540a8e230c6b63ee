// SPDX-License-Identifier: Apache-2.0
// The control that all columns of dtof_array share, once per array: state machine, sequencers of passes, pixels and scans, settings of a frame.
// sent_o has all commands of a clock, as a command_t (dtof_column_commands.svh).
//
// start_i samples the number of acquisitions, the time gate and the rows of a raw frame. A scan's address goes to the columns' memories before
// a timestamp's, a clear's before a count's; the sequencers never give both in a clock.
// Schedule: of a frame in dtof_controller, of a timestamp (T0 to T5) in dtof_pixel_sequencer, of a scanned address (S0 to S3) in
//   dtof_scan_sequencer.
// Latency: commands leave in the clock in which their sequencer gives them.
// Cost: the modules in it and one flip-flop, with RAW_HISTOGRAM = 1 another 2 ROW_WIDTH + 1, per array.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_array_control #(
    parameter int READOUT = dtof_pkg::READOUT_EZPOINTER,
    parameter int NP = 10,
    parameter int NB = 5,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SLOTS = 2,
    parameter int POINTER_STEP = 1,
    parameter int FRACTION_BITS = 0,
    parameter int SIGNALLED_CLEAR = 0,
    parameter int TIME_GATE = 0,
    parameter int RAW_HISTOGRAM = 0,
    parameter int ACQ_WIDTH = 16,
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int COMMAND_WIDTH = dtof_pkg::command_width(READOUT, NP, NB, PIXELS_PER_SRAM, POINTER_STEP, FRACTION_BITS)
) (
    input  logic                     clk_i,
    input  logic                     rst_ni,
    // as in dtof_array
    input  logic                     start_i,
    input  logic [    ACQ_WIDTH-1:0] acq_num_i,
    input  logic [           NP-1:0] gate_begin_i,
    input  logic [           NP-1:0] gate_end_i,
    input  logic                     raw_i,
    input  logic [    ROW_WIDTH-1:0] raw_first_row_i,
    input  logic [    ROW_WIDTH-1:0] raw_last_row_i,
    output logic                     busy_o,
    output logic                     done_o,
    output logic [              2:0] state_o,
    output logic [dtof_pkg::ERROR_WIDTH-1:0] error_o,
    input  logic                     tdc_valid_i,
    output logic                     tdc_ready_o,
    output logic [COMMAND_WIDTH-1:0] sent_o,
    // dtof_result_output
    output logic                     result_start_o,
    output logic                     last_row_o,
    output logic [    ROW_WIDTH-1:0] row_o,
    input  logic                     result_shift_i,
    input  logic                     result_done_i,
    input  logic                     result_busy_i
);

  localparam int HISTOGRAM = dtof_pkg::has_histogram(READOUT) ? 1 : 0;
  localparam int WORD = dtof_pkg::has_word(READOUT) ? 1 : 0;  // a word per pixel beside the histogram
  localparam int WORD_MOVED = dtof_pkg::is_word_moved(READOUT) ? 1 : 0;  // timestamps change the word
  localparam int WORD_AHEAD = dtof_pkg::is_word_read_ahead(READOUT) ? 1 : 0;  // timestamps need the word
  localparam int THREE_STEPS = (READOUT == dtof_pkg::READOUT_THREESTEPS) ? 1 : 0;
  localparam int COARSE_PASSES = dtof_pkg::coarse_passes(READOUT, NP, NB);
  localparam int PASS_WIDTH = dtof_pkg::index_width(COARSE_PASSES + 1);
  localparam int BIN_WIDTH = dtof_pkg::bin_width(READOUT, NP, NB);
  localparam int BINS = 1 << BIN_WIDTH;
  localparam int FINAL_ADDRESSES = dtof_pkg::final_addresses(READOUT, NP, NB, FRACTION_BITS);
  localparam int SCAN_WIDTH = dtof_pkg::scan_address_width(READOUT, NP, NB, FRACTION_BITS);
  // A raw frame shows the histogram of the final pass. If timestamps move a word in the final pass, it shows the histogram of the
  // first pass instead, which M1 and M2 then do not clear.
  localparam int RAW_OF_FIRST_PASS = (RAW_HISTOGRAM != 0) ? WORD_MOVED : 0;
  localparam int RAW_BINS = (RAW_HISTOGRAM != 0) ? dtof_pkg::raw_bins(READOUT, NP, NB) : 0;
  localparam int GEARS = (WORD_MOVED != 0) ? dtof_pkg::fraction_width(READOUT, FRACTION_BITS) : 0;
  localparam int GEAR_WIDTH = dtof_pkg::index_width(GEARS + 1);
  localparam int STEP_WIDTH = dtof_pkg::step_width(POINTER_STEP, dtof_pkg::fraction_width(READOUT, FRACTION_BITS));

  logic clear_all, coarse_scan, final_scan;
  logic load, next_pass, next_is_final, first_pass, final_pass, more, acq_done;
  logic [ACQ_WIDTH-1:0] acq_num;
  logic [PASS_WIDTH-1:0] pass;
  logic [GEAR_WIDTH-1:0] gear;
  logic stream, stream_idle;
  logic scan_start, scan_reset, scan_final, scan_busy;

  dtof_controller #(
      .COARSE_PASSES(COARSE_PASSES),
      .ACQ_WIDTH    (ACQ_WIDTH)
  ) u_controller (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .start_i        (start_i),
      .acq_num_i      (acq_num_i),
      .busy_o         (busy_o),
      .done_o         (done_o),
      .state_o        (state_o),
      .clear_all_o    (clear_all),
      .coarse_scan_o  (coarse_scan),
      .final_scan_o   (final_scan),
      .load_o         (load),
      .acq_num_o      (acq_num),
      .next_pass_o    (next_pass),
      .final_o        (next_is_final),
      .pass_o         (pass),
      .first_pass_o   (first_pass),
      .final_pass_o   (final_pass),
      .stream_o       (stream),
      .stream_idle_i  (stream_idle),
      .scan_start_o   (scan_start),
      .scan_reset_o   (scan_reset),
      .scan_final_o   (scan_final),
      .scan_busy_i    (scan_busy),
      .scan_last_row_i(last_row_o),
      .result_start_o (result_start_o),
      .result_done_i  (result_done_i)
  );

  dtof_pass_sequencer #(
      .COARSE_PASSES(COARSE_PASSES),
      .THREE_STEPS  (THREE_STEPS),
      .GEARS        (GEARS),
      .ACQ_WIDTH    (ACQ_WIDTH)
  ) u_pass_sequencer (
      .clk_i      (clk_i),
      .rst_ni     (rst_ni),
      .load_i     (load),
      .acq_num_i  (acq_num),
      .next_pass_i(next_pass),
      .final_i    (next_is_final),
      .acq_done_i (acq_done),
      .more_o     (more),
      .gear_o     (gear)
  );

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

  logic raw, keeps_counts, illegal_rows;
  logic [ROW_WIDTH-1:0] raw_first_row, raw_last_row;

  generate
    if (RAW_HISTOGRAM != 0) begin : g_raw_histogram
      logic raw_q;
      logic [ROW_WIDTH-1:0] raw_first_row_q, raw_last_row_q;
      always_ff @(posedge clk_i) begin
        if (start_i && !busy_o) begin
          raw_q <= raw_i;
          raw_first_row_q <= raw_first_row_i;
          raw_last_row_q <= raw_last_row_i;
        end
      end
      assign illegal_rows = start_i && !busy_o && raw_i
          && (raw_first_row_i > raw_last_row_i || 32'(raw_last_row_i) >= PIXELS_PER_SRAM);
      assign raw = raw_q;
      assign raw_first_row = raw_first_row_q;
      assign raw_last_row = raw_last_row_q;
    end else begin : g_no_raw_histogram
      logic unused_raw;
      assign unused_raw = ^{raw_i, raw_first_row_i, raw_last_row_i};
      assign illegal_rows = 1'b0;
      assign raw = 1'b0;
      assign raw_first_row = '0;
      assign raw_last_row = '0;
    end
  endgenerate

  assign keeps_counts = (RAW_OF_FIRST_PASS != 0) && raw;

  logic underrun;

  dtof_array_errors u_errors (
      .clk_i             (clk_i),
      .rst_ni            (rst_ni),
      .start_i           (start_i),
      .busy_i            (busy_o),
      .underrun_i        (underrun),
      .illegal_schedule_i(illegal_rows),
      .error_o           (error_o)
  );

  logic fetch, beat_t1, first_slot_t0, visit_t1, first_acq_t1, last_slot_t2, beat_t5;
  logic [ROW_WIDTH-1:0] fetch_pixel, pixel_t2, pixel_t5;
  logic [3:1] same_pixel_t3;

  dtof_pixel_sequencer #(
      .PIXELS_PER_SRAM    (PIXELS_PER_SRAM),
      .SLOTS              (SLOTS),
      .FETCH_ON_FIRST_SLOT(WORD_MOVED)
  ) u_pixel_sequencer (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .stream_i       (stream),
      .more_i         (more),
      .tdc_valid_i    (tdc_valid_i),
      .tdc_ready_o    (tdc_ready_o),
      .acq_done_o     (acq_done),
      .idle_o         (stream_idle),
      .underrun_o     (underrun),
      .fetch_o        (fetch),
      .fetch_pixel_o  (fetch_pixel),
      .beat_t1_o      (beat_t1),
      .first_slot_t0_o(first_slot_t0),
      .visit_t1_o     (visit_t1),
      .first_acq_t1_o (first_acq_t1),
      .last_slot_t2_o (last_slot_t2),
      .pixel_t2_o     (pixel_t2),
      .same_pixel_t3_o(same_pixel_t3),
      .beat_t5_o      (beat_t5),
      .pixel_t5_o     (pixel_t5)
  );

  logic scan_s0, last_s0, clear_s1, scan_s2, first_s2, last_s3;
  logic [ROW_WIDTH-1:0] pixel_s0, pixel_s1, pixel_s3;
  logic [SCAN_WIDTH-1:0] bin_s0, bin_s1, bin_s2;
  logic unused_bin_s1;
  assign unused_bin_s1 = ^bin_s1;  // the high bits are not used beyond the bins

  dtof_scan_sequencer #(
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .BIN_WIDTH      (SCAN_WIDTH),
      .RESET_BINS     ((HISTOGRAM != 0) ? BINS : 1),
      .FINAL_BINS     (FINAL_ADDRESSES),
      .SKIP_RESET     ((HISTOGRAM != 0) ? SIGNALLED_CLEAR : 0),
      .RAW_BINS       (RAW_BINS)
  ) u_scan_sequencer (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .start_i      (scan_start),
      .reset_state_i(scan_reset),
      .final_state_i(scan_final),
      .hold_i       (result_busy_i),
      .raw_i        (raw),
      .raw_first_i  (raw_first_row),
      .raw_last_i   (raw_last_row),
      .busy_o       (scan_busy),
      .row_o        (row_o),
      .last_row_o   (last_row_o),
      .read_s0_o    (scan_s0),
      .last_s0_o    (last_s0),
      .pixel_s0_o   (pixel_s0),
      .bin_s0_o     (bin_s0),
      .clear_s1_o   (clear_s1),
      .pixel_s1_o   (pixel_s1),
      .bin_s1_o     (bin_s1),
      .read_s2_o    (scan_s2),
      .first_s2_o   (first_s2),
      .bin_s2_o     (bin_s2),
      .last_s3_o    (last_s3),
      .pixel_s3_o   (pixel_s3)
  );

  // Memory accesses of the columns, the same for all columns.

  logic result_load;
  logic [ROW_WIDTH-1:0] histogram_read_pixel, histogram_write_pixel;
  logic word_read, word_read_done_q, word_set, word_write;
  logic [ROW_WIDTH-1:0] word_read_pixel, word_set_pixel;
  logic [STEP_WIDTH-1:0] step_t0;

  assign histogram_read_pixel = scan_s0 ? pixel_s0 : pixel_t2;
  assign histogram_write_pixel = clear_s1 ? pixel_s1 : pixel_t5;
  assign result_load = last_s3 && final_scan;

  // A pixel's word is read before its timestamps and for its scan, in the passes that have words.
  logic word_known, word_read_ahead, word_read_scan;
  assign word_known = (COARSE_PASSES <= 1) ? final_pass : !first_pass;
  assign word_read_ahead = (WORD_AHEAD != 0) && fetch;
  assign word_read_scan = (WORD_MOVED != 0) ? scan_s0 : last_s0;
  assign word_read = (WORD != 0) && word_known && (word_read_ahead || word_read_scan);
  assign word_read_pixel = ((WORD_AHEAD == 0) || scan_s0) ? pixel_s0 : fetch_pixel;

  // The word is set before the timestamps that need it, and written after the timestamps that change it.
  assign word_set = (WORD != 0) && ((COARSE_PASSES == 0) ? clear_s1 : last_s3 && coarse_scan);
  assign word_set_pixel = (COARSE_PASSES == 0) ? pixel_s1 : pixel_s3;
  assign word_write = (WORD_MOVED != 0) && last_slot_t2 && final_pass;
  assign step_t0 = STEP_WIDTH'(POINTER_STEP << GEARS) >> gear;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      word_read_done_q <= 1'b0;
    end else begin
      word_read_done_q <= word_read;
    end
  end

  dtof_column_rules #(
      .COARSE_PASSES(COARSE_PASSES),
      .WORD_MOVED   (WORD_MOVED)
  ) u_column_rules (
      .clk_i           (clk_i),
      .rst_ni          (rst_ni),
      .first_pass_i    (first_pass),
      .final_pass_i    (final_pass),
      .beat_t1_i       (beat_t1),
      .visit_t1_i      (visit_t1),
      .beat_t5_i       (beat_t5),
      .scan_s0_i       (scan_s0),
      .clear_s1_i      (clear_s1),
      .scan_s2_i       (scan_s2),
      .word_read_i     (word_read),
      .word_read_done_i(word_read_done_q),
      .word_set_i      (word_set),
      .word_write_i    (word_write),
      .result_load_i   (result_load),
      .result_shift_i  (result_shift_i)
  );

  // Commands to the columns. A command that the read-out does not use is zero: synthesis keeps the columns as modules with all ports,
  // and would otherwise keep the logic that drives the unused ports.

  `include "dtof_column_commands.svh"

  command_t sent;

  assign sent.gate_begin = gate_begin;
  assign sent.gate_end = gate_end;
  assign sent.pass = (COARSE_PASSES != 0) ? pass : '0;
  assign sent.first_pass = (COARSE_PASSES != 0) ? first_pass : 1'b1;
  assign sent.final_pass = (COARSE_PASSES != 0) ? final_pass && !(keeps_counts && final_scan) : 1'b1;
  assign sent.first_slot_t0 = (WORD_MOVED != 0) ? first_slot_t0 : 1'b0;
  assign sent.beat_t1 = beat_t1;
  assign sent.visit_t1 = (WORD_MOVED != 0) ? visit_t1 : 1'b0;
  assign sent.first_acq_t1 = (WORD_MOVED != 0) ? first_acq_t1 : 1'b0;
  assign sent.step_t0 = (WORD_MOVED != 0) ? step_t0 : '0;
  assign sent.same_pixel_t3 = (HISTOGRAM != 0) ? same_pixel_t3 : '0;
  assign sent.beat_t5 = (HISTOGRAM != 0) ? beat_t5 : 1'b0;
  assign sent.histogram_read_pixel = (HISTOGRAM != 0) ? histogram_read_pixel : '0;
  assign sent.histogram_write_pixel = (HISTOGRAM != 0) ? histogram_write_pixel : '0;
  assign sent.scan_s0 = (HISTOGRAM != 0) ? scan_s0 && (32'(bin_s0) < BINS) : 1'b0;
  assign sent.scan_bin_s0 = (HISTOGRAM != 0) ? BIN_WIDTH'(bin_s0) : '0;
  assign sent.clear_s1 = (HISTOGRAM != 0) ? clear_s1 && !(keeps_counts && coarse_scan) : 1'b0;
  assign sent.clear_bin_s1 = (HISTOGRAM != 0) ? BIN_WIDTH'(bin_s1) : '0;
  assign sent.clear_all = (HISTOGRAM != 0) ? clear_all && !(keeps_counts && next_pass) : 1'b0;
  assign sent.scan_s2 = (HISTOGRAM != 0) ? scan_s2 : 1'b0;
  assign sent.first_s2 = (HISTOGRAM != 0) ? first_s2 : 1'b0;
  assign sent.bin_s2 = (HISTOGRAM != 0) ? bin_s2 : '0;
  assign sent.word_read = word_read;
  assign sent.word_read_pixel = (WORD != 0) ? word_read_pixel : '0;
  assign sent.word_read_done = word_read_done_q;
  assign sent.word_set = word_set;
  assign sent.word_set_pixel = (WORD != 0) ? word_set_pixel : '0;
  assign sent.word_write = word_write;
  assign sent.word_write_pixel = (WORD_MOVED != 0) ? pixel_t2 : '0;
  assign sent.result_load = result_load;
  assign sent.result_shift = result_shift_i;
  assign sent_o = sent;

endmodule

`default_nettype wire
