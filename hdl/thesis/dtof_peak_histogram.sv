// SPDX-License-Identifier: Apache-2.0
// Histogram of a pass, with its three parts: the selection of timestamps (dtof_data_filter), the counts (dtof_histogram_builder), and the
// search for the peak (dtof_peak_detector). Every column with a histogram uses this module, except the coarse histogram.
//
// 1. Counting: at T1 the filter finds a timestamp's bin; if the filter keeps the timestamp, the builder counts it.
// 2. Scanning: the builder shows one bin's count per clock and, except in M4, clears it; the detector keeps the largest count and
//    the sum.
// 3. At S3, one clock after a pixel's last bin, peak, count and confidence are final, for one clock.
//
// Latency: 4 clocks from a timestamp at T1 to its count in the SRAM; 3 clocks from the read of a pixel's last bin (S0) to its peak.
// Cost: its three parts.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_peak_histogram #(
    parameter int READOUT = dtof_pkg::READOUT_SIFH,  // selects the filter
    parameter int NP = 10,               // bits of a timestamp
    parameter int NB = 6,                // bits of the coarse index
    parameter int PIXELS_PER_SRAM = 160,  // histograms
    parameter int SLOTS = 2,             // consecutive timestamps of a pixel
    parameter int COUNT_WIDTH = 10,      // bits of a bin
    parameter int FREEZE = 1,            // 1: a pixel's first full bin ends its counting; 0: full bins stay full
    parameter int WINDOW_CENTRED = 0,    // SiFH: 1 centres the window on the coarse bin
    parameter int SIGNALLED_CLEAR = 0,   // 1: a status bit per address replaces clearing
    parameter int PARITY = 0,            // 1: each word of the SRAM has a parity bit
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int BIN_WIDTH = dtof_pkg::bin_width(READOUT, NP, NB),
    localparam int PEAK_WIDTH = dtof_pkg::peak_width(READOUT, NP, NB),
    localparam int PASS_WIDTH = dtof_pkg::index_width(dtof_pkg::coarse_passes(READOUT, NP, NB) + 1)
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,           // for assertions and the check of parity only
    // side band of the SRAM macros; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // timestamp at T1
    input  logic                   build_t1_i,       // the timestamp is a detection in a pass with a histogram
    input  logic [         NP-1:0] timestamp_t1_i,
    input  logic [ PEAK_WIDTH-1:0] peak_i,           // coarse peak so far of the timestamp's pixel
    input  logic [ PASS_WIDTH-1:0] pass_i,           // pass of the timestamp
    input  logic                   final_pass_i,
    // schedule, the same for all columns; no scan and no clear while a timestamp is in the pipeline
    input  logic [            3:1] same_pixel_t3_i,  // [d]: the timestamp d clocks ahead is of the same pixel
    input  logic                   beat_t5_i,        // a timestamp is at T5
    input  logic                   scan_s0_i,        // read for a scan
    input  logic [  BIN_WIDTH-1:0] scan_bin_s0_i,
    input  logic [  ROW_WIDTH-1:0] read_pixel_i,     // pixel of T2 or S0
    input  logic                   clear_s1_i,       // clear the address that was read
    input  logic [  BIN_WIDTH-1:0] clear_bin_s1_i,
    input  logic [  ROW_WIDTH-1:0] write_pixel_i,    // pixel of T5 or S1
    input  logic                   clear_all_i,      // clears all frozen flags, and all status bits with SIGNALLED_CLEAR = 1
    input  logic                   scan_s2_i,        // the count of bin_s2_i is available
    input  logic                   first_s2_i,       // with scan_s2_i: first bin of its pixel
    input  logic [  BIN_WIDTH-1:0] bin_s2_i,
    // results of the scanned pixel, at S3
    output logic [  BIN_WIDTH-1:0] peak_o,           // lowest bin with the largest count
    output logic [COUNT_WIDTH-1:0] count_o,          // its count
    output logic [COUNT_WIDTH-1:0] confidence_o,     // height of the peak above the mean of the other bins
    output logic signed [NP+1:0]   start_o,          // code of bin 0 in the final pass, from peak_i
    output logic                   full_t5_o,        // a bin becomes full now; with FREEZE = 0 also if it was full before
    output logic                   parity_error_o    // with PARITY = 1: the count that was read two clocks ago is damaged
);

  logic keep;
  logic [BIN_WIDTH-1:0] bin_t1;
  logic [COUNT_WIDTH-1:0] count_s2;

  dtof_data_filter #(
      .READOUT       (READOUT),
      .NP            (NP),
      .NB            (NB),
      .WINDOW_CENTRED(WINDOW_CENTRED)
  ) u_data_filter (
      .timestamp_i (timestamp_t1_i),
      .peak_i      (peak_i),
      .pass_i      (pass_i),
      .final_pass_i(final_pass_i),
      .keep_o      (keep),
      .bin_o       (bin_t1),
      .start_o     (start_o)
  );

  dtof_histogram_builder #(
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .BIN_WIDTH      (BIN_WIDTH),
      .SLOTS          (SLOTS),
      .COUNT_WIDTH    (COUNT_WIDTH),
      .FREEZE         (FREEZE),
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR),
      .PARITY         (PARITY)
  ) u_histogram_builder (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .sram_cfg_i     (sram_cfg_i),
      .sram_cfg_o     (sram_cfg_o),
      .hit_t1_i       (build_t1_i && keep),
      .bin_t1_i       (bin_t1),
      .same_pixel_t3_i(same_pixel_t3_i),
      .beat_t5_i      (beat_t5_i),
      .scan_s0_i      (scan_s0_i),
      .scan_bin_s0_i  (scan_bin_s0_i),
      .read_pixel_i   (read_pixel_i),
      .clear_s1_i     (clear_s1_i),
      .clear_bin_s1_i (clear_bin_s1_i),
      .write_pixel_i  (write_pixel_i),
      .clear_all_i    (clear_all_i),
      .count_s2_o     (count_s2),
      .full_t5_o      (full_t5_o),
      .parity_error_o (parity_error_o)
  );

  dtof_peak_detector #(
      .BIN_WIDTH  (BIN_WIDTH),
      .COUNT_WIDTH(COUNT_WIDTH),
      .SHARE_SHIFT(dtof_pkg::scan_width(READOUT, NP, NB))
  ) u_peak_detector (
      .clk_i       (clk_i),
      .read_s2_i   (scan_s2_i),
      .first_s2_i  (first_s2_i),
      .bin_s2_i    (bin_s2_i),
      .count_s2_i  (count_s2),
      .peak_o      (peak_o),
      .count_o     (count_o),
      .confidence_o(confidence_o)
  );

endmodule

`default_nettype wire
