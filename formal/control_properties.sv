// SPDX-License-Identifier: Apache-2.0
// Proves the control of dtof_array as a whole: dtof_controller, dtof_pass_sequencer, dtof_pixel_sequencer, dtof_scan_sequencer,
// dtof_result_output. The columns' data have no part in it. Free: start, number of acquisitions, pauses of the TDC, back-pressure.
//
// Every frame ends if source and sink accept all offers. This follows from three facts: the number of clocks is bounded in which the
// array stays in a state without an offer (ready to the source, a beat to the sink) and without the end of an acquisition
// (a_no_state_lasts); the states follow each other as in the diagram; and passes, rows and acquisitions of a frame are counted.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module control_properties #(
    parameter int COARSE_PASSES = 1,
    parameter int THREE_STEPS = 0,
    parameter int POINTER = 0,
    parameter int PIXELS = 2,
    parameter int SLOTS = 1,
    parameter int SRAM_NUM = 2,
    parameter int BIN_WIDTH = 1,
    parameter int SKIP_RESET = 0,
    parameter int ACQ_WIDTH = 2,
    parameter int LONGEST_STAY = 16,
    parameter int RAW = 0,  // 1: frames may be raw frames
    localparam int BINS = 1 << BIN_WIDTH,
    localparam int RESET_BINS = (POINTER != 0 && COARSE_PASSES == 0) ? 1 : BINS,
    localparam int FINAL_BINS = (POINTER != 0) ? 1 : BINS,
    localparam int PASS_WIDTH = dtof_pkg::index_width(COARSE_PASSES + 1),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS),
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int TDATA_WIDTH = COLUMN_WIDTH + ROW_WIDTH + 1
) (
    input logic                 clk_i,
    input logic                 start_i,
    input logic [ACQ_WIDTH-1:0] acq_num_i,
    input logic                 raw_i,
    input logic [ROW_WIDTH-1:0] raw_first_i,
    input logic [ROW_WIDTH-1:0] raw_last_i,
    input logic                 tdc_valid_i,
    input logic                 tready_i
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic busy, done, clear_all, coarse_scan, final_scan, load, next_pass, next_is_final, first_pass, final_pass;
  logic [2:0] state;
  logic [ACQ_WIDTH-1:0] acq_num;
  logic [PASS_WIDTH-1:0] pass;
  logic stream, stream_idle, scan_start, scan_reset, scan_final, scan_busy, scan_last_row;
  logic result_start, result_done, result_busy, result_shift, more, acq_done, ready, tvalid, tlast;
  logic gear, fetch, beat_t1, first_slot, visit, first_acq, last_slot, beat_t5;
  logic [ROW_WIDTH-1:0] fetch_pixel, pixel_t2, pixel_t5, row, pixel_s0, pixel_s1, pixel_s3;
  logic [3:1] same_pixel;
  logic [BIN_WIDTH-1:0] bin_s0, bin_s1, bin_s2;
  logic scan_s0, last_s0, clear_s1, scan_s2, first_s2, last_s3;
  logic [TDATA_WIDTH-1:0] tdata;

  dtof_controller #(
      .COARSE_PASSES(COARSE_PASSES),
      .ACQ_WIDTH    (ACQ_WIDTH)
  ) u_controller (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .start_i        (start_i),
      .acq_num_i      (acq_num_i),
      .busy_o         (busy),
      .done_o         (done),
      .state_o        (state),
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
      .scan_last_row_i(scan_last_row),
      .result_start_o (result_start),
      .result_done_i  (result_done)
  );

  dtof_pass_sequencer #(
      .COARSE_PASSES(COARSE_PASSES),
      .THREE_STEPS  (THREE_STEPS),
      .ACQ_WIDTH    (ACQ_WIDTH)
  ) u_pass_sequencer (
      .clk_i      (clk_i),
      .rst_ni     (checking),
      .load_i     (load),
      .acq_num_i  (acq_num),
      .next_pass_i(next_pass),
      .final_i    (next_is_final),
      .acq_done_i (acq_done),
      .more_o     (more),
      .gear_o     (gear)
  );

  dtof_pixel_sequencer #(
      .PIXELS_PER_SRAM    (PIXELS),
      .SLOTS              (SLOTS),
      .FETCH_ON_FIRST_SLOT(POINTER)
  ) u_pixel_sequencer (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .stream_i       (stream),
      .more_i         (more),
      .tdc_valid_i    (tdc_valid_i),
      .tdc_ready_o    (ready),
      .acq_done_o     (acq_done),
      .idle_o         (stream_idle),
      .fetch_o        (fetch),
      .fetch_pixel_o  (fetch_pixel),
      .beat_t1_o      (beat_t1),
      .first_slot_t0_o(first_slot),
      .visit_t1_o     (visit),
      .first_acq_t1_o (first_acq),
      .last_slot_t2_o (last_slot),
      .pixel_t2_o     (pixel_t2),
      .same_pixel_t3_o(same_pixel),
      .beat_t5_o      (beat_t5),
      .pixel_t5_o     (pixel_t5)
  );

  logic raw_q;
  logic [ROW_WIDTH-1:0] raw_first_q, raw_last_q;

  dtof_scan_sequencer #(
      .PIXELS_PER_SRAM(PIXELS),
      .BIN_WIDTH      (BIN_WIDTH),
      .RESET_BINS     (RESET_BINS),
      .FINAL_BINS     (FINAL_BINS),
      .SKIP_RESET     (SKIP_RESET),
      .RAW_BINS       ((RAW != 0) ? BINS : 0)
  ) u_scan_sequencer (
      .clk_i        (clk_i),
      .rst_ni       (checking),
      .start_i      (scan_start),
      .reset_state_i(scan_reset),
      .final_state_i(scan_final),
      .hold_i       (result_busy),
      .raw_i        (raw_q),
      .raw_first_i  (raw_first_q),
      .raw_last_i   (raw_last_q),
      .busy_o       (scan_busy),
      .row_o        (row),
      .last_row_o   (scan_last_row),
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

  dtof_result_output #(
      .SRAM_NUM    (SRAM_NUM),
      .ROW_WIDTH   (ROW_WIDTH),
      .RESULT_WIDTH(1)
  ) u_result_output (
      .clk_i     (clk_i),
      .rst_ni    (checking),
      .start_i   (result_start),
      .last_row_i(scan_last_row),
      .row_i     (row),
      .head_i    (1'b0),
      .shift_o   (result_shift),
      .done_o    (result_done),
      .busy_o    (result_busy),
      .tvalid_o  (tvalid),
      .tready_i  (tready_i),
      .tdata_o   (tdata),
      .tlast_o   (tlast)
  );

  // Settings that the array samples with start_i.
  logic [31:0] scans;
  always_ff @(posedge clk_i) begin
    if (start_i && !busy) begin
      raw_q <= (RAW != 0) && raw_i;
      raw_first_q <= raw_first_i;
      raw_last_q <= raw_last_i;
    end
  end
  assign scans = raw_q ? (32'(raw_last_q) - 32'(raw_first_q) + 1) << BIN_WIDTH : PIXELS;

  // A frame, observed at one arbitrary address.
  localparam int COUNT_WIDTH = 4;
  (* anyconst *) logic [ROW_WIDTH-1:0] watched_pixel;
  (* anyconst *) logic [BIN_WIDTH-1:0] watched_bin;
  logic frame_q, accepted_q, accepted_before_q, done_q, stay_ends;
  logic [2:0] state_q;
  logic [ACQ_WIDTH-1:0] acq_num_q, acquisitions_q;
  logic [PASS_WIDTH:0] passes_q;
  logic [ROW_WIDTH+BIN_WIDTH:0] rows_q;  // scans in M4; a raw frame has one scan per bin of a row
  logic [COUNT_WIDTH-1:0] clears_q, reads_q, clears, reads, beats_q;
  logic [1:0] final_reads_q;
  logic [4:0] stay_q;
  logic [7:0] place_q;
  logic accepted, offers;

  assign accepted = checking && ready && tdc_valid_i;
  assign offers = ready || tvalid;
  // Counts since the state was entered. The last clear and the last read are in the state's last clocks.
  assign clears = clears_q
      + COUNT_WIDTH'(clear_s1 && pixel_s1 == watched_pixel && bin_s1 == watched_bin);
  assign reads = reads_q + COUNT_WIDTH'(scan_s0 && pixel_s0 == watched_pixel && bin_s0 == watched_bin);
  assign stay_ends = (state != state_q);

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      frame_q <= 1'b0;
      accepted_q <= 1'b0;
      accepted_before_q <= 1'b0;
      done_q <= 1'b0;
      state_q <= dtof_pkg::STATE_IDLE;
      acquisitions_q <= '0;
      passes_q <= '0;
      rows_q <= '0;
      beats_q <= '0;
      clears_q <= '0;
      reads_q <= '0;
      final_reads_q <= '0;
      stay_q <= '0;
      place_q <= '0;
      acq_num_q <= '0;
    end else begin
      frame_q <= (start_i && !frame_q) || (frame_q && !done);
      accepted_q <= start_i && !frame_q;
      accepted_before_q <= accepted_q;
      done_q <= done;
      state_q <= state;
      if (start_i && !frame_q) begin
        acq_num_q <= acq_num_i;
        acquisitions_q <= '0;
        passes_q <= '0;
        rows_q <= '0;
        beats_q <= '0;
        final_reads_q <= '0;
      end else begin
        if (acq_done) acquisitions_q <= acquisitions_q + 1'b1;
        if (next_pass) passes_q <= passes_q + 1'b1;
        if (result_start) rows_q <= rows_q + 1'b1;
        if (tvalid && tready_i) beats_q <= beats_q + 1'b1;
        if (scan_s0 && final_pass && pixel_s0 == watched_pixel && bin_s0 == watched_bin) begin
          final_reads_q <= final_reads_q + 1'b1;
        end
      end
      clears_q <= stay_ends ? COUNT_WIDTH'(clears - clears_q) : clears;
      reads_q <= stay_ends ? COUNT_WIDTH'(reads - reads_q) : reads;
      stay_q <= (stay_ends || acq_done || offers || state == dtof_pkg::STATE_IDLE) ? '0 : stay_q + 1'b1;
      if (accepted) place_q <= (32'(place_q) == PIXELS * SLOTS - 1) ? '0 : place_q + 1'b1;
    end
  end

  logic coarse_read, in_reset_bins, in_final_bins;
  assign in_reset_bins = 32'(watched_bin) < RESET_BINS;
  assign in_final_bins = raw_q ? (watched_pixel >= raw_first_q && watched_pixel <= raw_last_q)
      : 32'(watched_bin) < FINAL_BINS;

  logic legal;
  always_comb begin
    case (state_q)
      dtof_pkg::STATE_IDLE: legal = (state == dtof_pkg::STATE_IDLE) || (state == dtof_pkg::STATE_RESET);
      dtof_pkg::STATE_RESET:
      legal = (state == dtof_pkg::STATE_RESET)
          || (state == ((COARSE_PASSES == 0) ? dtof_pkg::STATE_M3 : dtof_pkg::STATE_M0));
      dtof_pkg::STATE_M0: legal = (state == dtof_pkg::STATE_M0) || (state == dtof_pkg::STATE_M1);
      dtof_pkg::STATE_M1: legal = (state == dtof_pkg::STATE_M1) || (state == dtof_pkg::STATE_M2);
      dtof_pkg::STATE_M2:
      legal = (state == ((32'(passes_q) == COARSE_PASSES) ? dtof_pkg::STATE_M3 : dtof_pkg::STATE_M0));
      dtof_pkg::STATE_M3: legal = (state == dtof_pkg::STATE_M3) || (state == dtof_pkg::STATE_M4);
      dtof_pkg::STATE_M4: legal = (state == dtof_pkg::STATE_M4) || (state == dtof_pkg::STATE_M5);
      default:
      legal = (state == dtof_pkg::STATE_M5)
          || (state == ((32'(rows_q) == scans) ? dtof_pkg::STATE_IDLE : dtof_pkg::STATE_M4));
    endcase
  end

  `ASSUME(m_contiguous, place_q == '0 || tdc_valid_i)
  `ASSUME(m_watched, 32'(watched_pixel) < PIXELS)
  `ASSUME(m_raw_rows, raw_first_i <= raw_last_i && 32'(raw_last_i) < PIXELS)
  // Starts
  `PROVE(a_busy, busy == frame_q)
  `PROVE(a_start_is_not_lost, !accepted_before_q || state == dtof_pkg::STATE_RESET)
  `PROVE(a_done_ends_a_frame, !done || (frame_q && !done_q))
  `PROVE(a_done_is_complete, !done || (acquisitions_q == acq_num_q && 32'(passes_q) == COARSE_PASSES
                                        && 32'(rows_q) == scans && 32'(beats_q) == scans * SRAM_NUM))
  // Every frame ends
  `PROVE(a_states, legal)
  `PROVE(a_no_state_lasts, 32'(stay_q) < LONGEST_STAY)
  `PROVE(a_passes, 32'(passes_q) <= COARSE_PASSES)
  `PROVE(a_rows, 32'(rows_q) <= scans || !frame_q)
  `PROVE(a_acquisitions, !frame_q || acquisitions_q <= acq_num_q)
  // Addresses
  `PROVE(a_stream_alone, !(accepted && (scan_s0 || clear_s1)))
  `PROVE(a_reset_clears_once, !(stay_ends && state_q == dtof_pkg::STATE_RESET)
         || 32'(clears_q) == ((in_reset_bins && SKIP_RESET == 0) ? 1 : 0))
  `PROVE(a_reset_reads_nothing, !(state == dtof_pkg::STATE_RESET && scan_s0))
  `PROVE(a_scan_clears_once, !(stay_ends && state_q == dtof_pkg::STATE_M1) || clears_q == COUNT_WIDTH'(1))
  `PROVE(a_scan_reads_once, !(stay_ends && state_q == dtof_pkg::STATE_M1) || reads_q == COUNT_WIDTH'(1))
  `PROVE(a_no_clear_elsewhere, !clear_s1 || state == dtof_pkg::STATE_RESET || state == dtof_pkg::STATE_M1)
  `PROVE(a_final_reads_once, !done || 32'(final_reads_q) == (in_final_bins ? 1 : 0))
  // Results
  `PROVE(a_tlast, !(tvalid && tready_i) || tlast == (32'(beats_q) == scans * SRAM_NUM - 1))
  `PROVE(a_rows_in_order, !tvalid || 32'(tdata[ROW_WIDTH:1])
         == (raw_q ? 32'(raw_first_q) + ((32'(rows_q) - 1) >> BIN_WIDTH) : 32'(rows_q) - 1))
  `GOAL(done && (&acq_num_q))

endmodule

`default_nettype wire
