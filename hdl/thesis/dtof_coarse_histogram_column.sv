// SPDX-License-Identifier: Apache-2.0
// Coarse histogram: one histogram of wide bins over the whole range, for the whole frame. A pulse that is wider than a bin counts in
// several bins, and their counts give its position to a small part of a bin. No part of the frame is needed to find the pulse, and
// no pixel has a word beside its histogram.
//
// Equations: docs/reference/readouts.md, coarsehistogram.
//
// 1. Every timestamp x counts in bin x >> (NP - NB).
// 2. M4 scans a pixel's bins for the highest pair of neighbours, and for the difference of the pairs on its two sides.
// 3. After the last bin, while the results of the row before are still being sent, the position within the pair is
//    computed: a difference, a height above the background, and a division, one bit per clock. {bin, place} is code and
//    fraction; the height is the confidence.
// 4. In M4 of a raw frame each address is a separate scan; the result is the bin's lowest code and its count.
//
//   clock                         work
//   T0                            timestamp registered, gated
//   T1                            bin
//   T2 to T5                      histogram
//   S2, each bin                  highest pair so far
//   S2, the next two addresses    counts of zero: the pair after the last one
//   S2, the next address          height of the pulse, and its lean
//   S2, the next address          dividend
//   S2, NP-NB+FRACTION_BITS more  one bit of the place each
//   S3 of the last address        result loaded
//
// Latency: NP - NB + FRACTION_BITS + 4 addresses after a pixel's last bin. Cost at the defaults: about 170 flip-flops and a
// histogram SRAM.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_coarse_histogram_column #(
    // parameters of a column: written by scripts/generate.py from scripts/templates/column_parameters.svh
    // verilator lint_off UNUSEDPARAM
    parameter int READOUT = dtof_pkg::READOUT_SIFH,  // read-out, of those that this column implements
    parameter int NP = 10,               // bits of a timestamp
    parameter int NB = 5,                // bits of the coarse index
    parameter int PIXELS_PER_SRAM = 160,  // pixels of the column
    parameter int SLOTS = 2,             // timestamps per pixel and acquisition
    parameter int COUNT_WIDTH = 10,      // bits of a histogram bin
    parameter int POINTER_STEP = 1,      // bins that a pointer moves
    parameter int FRACTION_BITS = 0,     // fractional bits of a pointer
    parameter int CONFIDENCE_WIDTH = 4,  // bits of a pointer's confidence, 0 for none
    parameter int GUARD = 46,            // hisPointer v2: window beyond half a coarse bin
    parameter int WINDOW_CENTRED = 0,    // SiFH: 1 centres the window on the coarse bin
    parameter int POINTER_PORTS = 2,     // ports of an SRAM whose words timestamps change
    parameter int SIGNALLED_CLEAR = 0,   // 1: a status bit per address replaces clearing
    parameter int PARITY = 0,            // 1: each word of the SRAMs has a parity bit
    parameter int TIME_GATE = 0,         // 1: timestamps outside [gate_begin_i, gate_end_i) are no detections
    parameter int RAW_HISTOGRAM = 0,     // 1: M4 may scan single bins, whose code and count are the result
    parameter int BROADCAST_STAGES = 2,  // clocks from the array's control to the column; timestamps are delayed as much
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int BIN_WIDTH = dtof_pkg::bin_width(READOUT, NP, NB),  // log2 of a pixel's bins
    localparam int SCAN_WIDTH = dtof_pkg::scan_address_width(READOUT, NP, NB, FRACTION_BITS),
    localparam int PASS_WIDTH = dtof_pkg::index_width(dtof_pkg::coarse_passes(READOUT, NP, NB) + 1),
    localparam int STEP_WIDTH = dtof_pkg::step_width(POINTER_STEP, dtof_pkg::fraction_width(READOUT, FRACTION_BITS)),
    localparam int KEPT_CONFIDENCE_WIDTH = dtof_pkg::kept_confidence_width(CONFIDENCE_WIDTH, COUNT_WIDTH, RAW_HISTOGRAM),
    localparam int RESULT_WIDTH = dtof_pkg::result_width(READOUT, NP, COUNT_WIDTH, FRACTION_BITS, KEPT_CONFIDENCE_WIDTH)
    // verilator lint_on UNUSEDPARAM
    // end of parameters of a column
) (
    // ports of a column: written by scripts/generate.py from scripts/templates/column_ports.svh
    // verilator lint_off UNUSEDSIGNAL
    input  logic                    clk_i,
    input  logic                    rst_ni,                   // for assertions, the chains of events and the check of parity only
    // side band of the SRAM macros; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // timestamp
    input  logic [          NP-1:0] timestamp_i,              // BROADCAST_STAGES clocks before T0; all ones: no detection
    input  logic [          NP-1:0] gate_begin_i,             // time gate, the same for a whole frame
    input  logic [          NP-1:0] gate_end_i,
    // pass over the stream, which changes only while no timestamp is in the pipeline
    input  logic [  PASS_WIDTH-1:0] pass_i,                   // number of the pass: 0, 1, ...
    input  logic                    first_pass_i,
    input  logic                    final_pass_i,             // the scan of this pass gives the result; low in M4 of a raw frame
                                                              // that shows the counts of an earlier pass
    // stages of the timestamps
    input  logic                    beat_t1_i,                // the timestamp at T1 belongs to an acquisition
    input  logic [             3:1] same_pixel_t3_i,          // [d]: the timestamp d clocks ahead is of the same pixel
    input  logic                    beat_t5_i,                // a timestamp is at T5
    // histogram: read at T2 or S0, written at T5 or cleared at S1
    input  logic                    scan_s0_i,                // read for a scan
    input  logic [   BIN_WIDTH-1:0] scan_bin_s0_i,
    input  logic [   ROW_WIDTH-1:0] histogram_read_pixel_i,   // pixel of T2, or of S0 with scan_s0_i
    input  logic                    clear_s1_i,               // clear the address that was read
    input  logic [   BIN_WIDTH-1:0] clear_bin_s1_i,
    input  logic [   ROW_WIDTH-1:0] histogram_write_pixel_i,  // pixel of T5, or of S1 with clear_s1_i
    input  logic                    clear_all_i,              // before a new histogram: clears all frozen flags and, with
                                                              // SIGNALLED_CLEAR = 1, all status bits
    input  logic                    scan_s2_i,                // the count of bin_s2_i is available
    input  logic                    first_s2_i,               // with scan_s2_i: first bin of its pixel
    input  logic [  SCAN_WIDTH-1:0] bin_s2_i,                 // beyond the last bin: a clock of the computation after the scan
    // word of a pixel: read, changed by timestamps, written; or set
    input  logic                    word_read_i,              // read before the pixel's timestamps, or for its scan
    input  logic [   ROW_WIDTH-1:0] word_read_pixel_i,
    input  logic                    word_read_done_i,         // word_read_i one clock later
    input  logic                    first_slot_t0_i,          // first slot of a pixel, also between acquisitions
    input  logic                    visit_t1_i,               // the timestamp at T1 is the first of its pixel's visit
    input  logic                    first_acq_t1_i,           // this visit is in the first acquisition of the pass
    input  logic                    word_write_i,             // write after the pixel's timestamps: last slot at T2
    input  logic [   ROW_WIDTH-1:0] word_write_pixel_i,
    input  logic [  STEP_WIDTH-1:0] step_t0_i,                // step of a pointer, in units of its lowest bit
    input  logic                    word_set_i,               // set before the timestamps: in RESET, or at S3 of M1
    input  logic [   ROW_WIDTH-1:0] word_set_pixel_i,
    // result chain
    input  logic                    result_load_i,            // S3 of M4: load the pixel's result
    input  logic                    result_shift_i,           // load the next column's result; never with result_load_i
    input  logic [RESULT_WIDTH-1:0] next_column_i,
    output logic [RESULT_WIDTH-1:0] result_o,                 // {code, fraction, confidence}
    // chain of full counters, in read-outs with a histogram
    input  logic                    next_counter_full_i,
    output logic                    counter_full_o,           // a counter of this column or of the chain before is full
    // chain of damaged words, with PARITY = 1
    input  logic                    next_parity_error_i,
    output logic                    parity_error_o            // a word that this column or the chain before has read is damaged
    // verilator lint_on UNUSEDSIGNAL
    // end of ports of a column
);

  localparam int BINS = 1 << NB;
  localparam int PLACE_WIDTH = NP - NB + FRACTION_BITS;
  localparam int PLACE_BITS = dtof_pkg::max_of(PLACE_WIDTH, 1);
  localparam int POSITION_WIDTH = NP + FRACTION_BITS;

  logic unused_detected, unused_low_bits, detected_t1, full_t5, histogram_error;
  logic [NP-1:0] timestamp_t1;
  logic [COUNT_WIDTH-1:0] count_s2, last_count, confidence;
  logic [COUNT_WIDTH:0] pair_count;
  logic signed [COUNT_WIDTH+1:0] lean;
  logic [COUNT_WIDTH+NB-1:0] sum;
  logic [NB-1:0] peak;
  logic past_s2, settle, start, divide, one_bin, lower;
  logic [PLACE_BITS-1:0] place;
  logic [POSITION_WIDTH-1:0] position;
  logic [RESULT_WIDTH-1:0] result;

  dtof_timestamp_input #(
      .NP       (NP),
      .TIME_GATE(TIME_GATE),
      .STAGES   (BROADCAST_STAGES)
  ) u_timestamp_input (
      .clk_i         (clk_i),
      .timestamp_i   (timestamp_i),
      .gate_begin_i  (gate_begin_i),
      .gate_end_i    (gate_end_i),
      .detected_t0_o (unused_detected),
      .detected_t1_o (detected_t1),
      .timestamp_t1_o(timestamp_t1)
  );

  dtof_histogram_builder #(
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .BIN_WIDTH      (BIN_WIDTH),
      .SLOTS          (SLOTS),
      .COUNT_WIDTH    (COUNT_WIDTH),
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR),
      .PARITY         (PARITY)
  ) u_histogram_builder (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .sram_cfg_i     (sram_cfg_i),
      .sram_cfg_o     (sram_cfg_o),
      .hit_t1_i       (beat_t1_i && detected_t1),
      .bin_t1_i       (timestamp_t1[NP-1-:NB]),
      .same_pixel_t3_i(same_pixel_t3_i),
      .beat_t5_i      (beat_t5_i),
      .scan_s0_i      (scan_s0_i),
      .scan_bin_s0_i  (scan_bin_s0_i),
      .read_pixel_i   (histogram_read_pixel_i),
      .clear_s1_i     (clear_s1_i),
      .clear_bin_s1_i (clear_bin_s1_i),
      .write_pixel_i  (histogram_write_pixel_i),
      .clear_all_i    (clear_all_i),
      .count_s2_o     (count_s2),
      .full_t5_o      (full_t5),
      .parity_error_o (histogram_error)
  );

  assign unused_low_bits = ^timestamp_t1;

  // Addresses beyond the last bin are the clocks of the computation.
  assign past_s2 = (bin_s2_i >= SCAN_WIDTH'(BINS));
  assign settle = scan_s2_i && (bin_s2_i == SCAN_WIDTH'(BINS + 2));
  assign start = scan_s2_i && (bin_s2_i == SCAN_WIDTH'(BINS + 3));
  assign divide = scan_s2_i && (bin_s2_i > SCAN_WIDTH'(BINS + 3));

  dtof_pair_detector #(
      .BIN_WIDTH  (BIN_WIDTH),
      .COUNT_WIDTH(COUNT_WIDTH)
  ) u_pair_detector (
      .clk_i     (clk_i),
      .read_s2_i (scan_s2_i),
      .first_s2_i(first_s2_i),
      .past_s2_i (past_s2),
      .bin_s2_i  (NB'(bin_s2_i)),
      .count_s2_i(count_s2),
      .peak_o    (peak),
      .count_o   (pair_count),
      .lean_o    (lean),
      .sum_o     (sum),
      .first_o   (one_bin),
      .last_o    (last_count)
  );

  dtof_pair_interpolator #(
      .BIN_WIDTH  (BIN_WIDTH),
      .COUNT_WIDTH(COUNT_WIDTH),
      .PLACE_WIDTH(PLACE_WIDTH)
  ) u_pair_interpolator (
      .clk_i       (clk_i),
      .settle_i    (settle),
      .begin_i     (start),
      .divide_i    (divide),
      .count_i     (pair_count),
      .lean_i      (lean),
      .sum_i       (sum),
      .lower_o     (lower),
      .place_o     (place),
      .confidence_o(confidence)
  );

  assign position = POSITION_WIDTH'({peak - NB'(lower), place} >> (PLACE_BITS - PLACE_WIDTH));

  generate
    if (RAW_HISTOGRAM != 0) begin : g_raw_histogram
      assign result = one_bin ? {POSITION_WIDTH'(peak) << PLACE_WIDTH, last_count} : {position, confidence};
    end else begin : g_results_alone
      logic unused_one_bin;
      assign unused_one_bin = ^{one_bin, last_count};
      assign result = {position, confidence};
    end
  endgenerate

  dtof_event_link u_full_counter_link (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .event_i      (full_t5),
      .next_column_i(next_counter_full_i),
      .event_o      (counter_full_o)
  );

  dtof_event_link #(
      .PRESENT(PARITY)
  ) u_parity_link (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .event_i      (histogram_error),
      .next_column_i(next_parity_error_i),
      .event_o      (parity_error_o)
  );

  dtof_result_register #(
      .WIDTH(RESULT_WIDTH)
  ) u_result_register (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .load_i       (result_load_i),
      .shift_i      (result_shift_i),
      .result_i     (result),
      .next_column_i(next_column_i),
      .result_o     (result_o)
  );

endmodule

`default_nettype wire
