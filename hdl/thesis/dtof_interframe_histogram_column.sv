// SPDX-License-Identifier: Apache-2.0
// SiFH, FiFH and three steps (thesis 2.2.3, 3.3.3, 3.3.4, 4.4): coarse histograms find the region of the pulse, a fine histogram
// of this region finds its position, in the same SRAM.
//
// 1. A coarse pass counts the timestamps; M1 scans for the peak, which extends the pixel's coarse peak by its bits.
// 2. The final pass counts the timestamps of a window at the coarse peak, one bin per code.
// 3. M4 scans for the peak; peak and start of the window give the result.
//
// READOUT selects the window of a pass (dtof_data_filter) and how a pass's peak extends the coarse peak.
// Coarse peaks are words of a small single-port SRAM. They are read one pixel ahead during a pass, read at the last bin of a pixel
// during a scan, and set in M1 at S3. Reads and writes fall on different clocks because the number of bins is even.
//
//   clock     work
//   T0        timestamp and coarse peak registered
//   T1        filter: bin and hit
//   T2 to T5  histogram
//   S3 of M1  the extended coarse peak is set
//   S3 of M4  result loaded
//
// Latency: 3 clocks from the read of a pixel's last bin to its result.
// Cost at the defaults: about 130 flip-flops, a histogram SRAM and PIXELS_PER_SRAM x PEAK_WIDTH bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_interframe_histogram_column #(
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

  localparam int PEAK_WIDTH = dtof_pkg::peak_width(READOUT, NP, NB);

  logic unused_detected, detected_t1;
  logic full_t5, histogram_error, peak_error;
  logic [NP-1:0] timestamp_t1;
  logic [PEAK_WIDTH-1:0] peak_data, peak_q, new_peak;
  logic [BIN_WIDTH-1:0] scan_peak;
  logic signed [NP+1:0] start, peak_code;
  logic [NP-1:0] code;
  logic [COUNT_WIDTH-1:0] unused_count, confidence;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] histogram_cfg, peak_cfg;

  assign sram_cfg_o = histogram_cfg & peak_cfg;

  always_ff @(posedge clk_i) begin
    if (word_read_done_i) begin
      peak_q <= peak_data;
    end
  end

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

  dtof_peak_histogram #(
      .READOUT        (READOUT),
      .NP             (NP),
      .NB             (NB),
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .SLOTS          (SLOTS),
      .COUNT_WIDTH    (COUNT_WIDTH),
      .WINDOW_CENTRED (WINDOW_CENTRED),
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR),
      .PARITY         (PARITY)
  ) u_peak_histogram (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .sram_cfg_i     (sram_cfg_i),
      .sram_cfg_o     (histogram_cfg),
      .build_t1_i     (beat_t1_i && detected_t1),
      .timestamp_t1_i (timestamp_t1),
      .peak_i         (peak_q),
      .pass_i         (pass_i),
      .final_pass_i   (final_pass_i),
      .same_pixel_t3_i(same_pixel_t3_i),
      .beat_t5_i      (beat_t5_i),
      .scan_s0_i      (scan_s0_i),
      .scan_bin_s0_i  (scan_bin_s0_i),
      .read_pixel_i   (histogram_read_pixel_i),
      .clear_s1_i     (clear_s1_i),
      .clear_bin_s1_i (clear_bin_s1_i),
      .write_pixel_i  (histogram_write_pixel_i),
      .clear_all_i    (clear_all_i),
      .scan_s2_i      (scan_s2_i),
      .first_s2_i     (first_s2_i),
      .bin_s2_i       (bin_s2_i),
      .peak_o         (scan_peak),
      .count_o        (unused_count),
      .confidence_o   (confidence),
      .start_o        (start),
      .full_t5_o      (full_t5),
      .parity_error_o (histogram_error)
  );

  dtof_parity_sram #(
      .PORTS(1),
      .DEPTH(PIXELS_PER_SRAM),
      .WIDTH(PEAK_WIDTH),
      .PARITY(PARITY)
  ) u_peak_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (peak_cfg),
      .read_en_i   (word_read_i),
      .read_addr_i (word_read_pixel_i),
      .read_data_o (peak_data),
      .ignore_i    (1'b0),
      .error_o     (peak_error),
      .write_en_i  (word_set_i),
      .write_addr_i(word_set_pixel_i),
      .write_data_i(new_peak)
  );

  generate
    if (READOUT == dtof_pkg::READOUT_THREESTEPS) begin : g_threesteps
      localparam int STEP1 = dtof_pkg::step_shift(NP, 0) - dtof_pkg::step_shift(NP, 1);
      localparam int STEP2 = dtof_pkg::step_shift(NP, 1) - dtof_pkg::step_shift(NP, 2);
      always_comb begin
        case (pass_i)
          2'd0: new_peak = PEAK_WIDTH'(scan_peak);
          2'd1: new_peak = PEAK_WIDTH'(peak_q << STEP1) | PEAK_WIDTH'(scan_peak);
          default: new_peak = PEAK_WIDTH'(peak_q << STEP2) | PEAK_WIDTH'(scan_peak);
        endcase
      end
    end else begin : g_one_step
      assign new_peak = scan_peak[PEAK_WIDTH-1:0];
    end
  endgenerate

  // A window may begin below code 0; an empty fine histogram has its peak there. The peak of a window never lies beyond the
  // last code: only codes that were measured are counted, and the first code of an empty window is in the range. A bin of a
  // raw frame may lie beyond the last code; it gets the code of no detection.
  logic unused_peak_code;
  assign peak_code = start + $signed((NP + 2)'(scan_peak));
  assign code = peak_code[NP+1] ? '0
      : (RAW_HISTOGRAM != 0 && peak_code[NP]) ? {NP{1'b1}} : peak_code[NP-1:0];
  assign unused_peak_code = peak_code[NP];

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
      .event_i      (histogram_error || peak_error),
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
      .result_i     ({code, confidence}),
      .next_column_i(next_column_i),
      .result_o     (result_o)
  );

endmodule

`default_nettype wire
