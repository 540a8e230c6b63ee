// SPDX-License-Identifier: Apache-2.0
// Coarse histogram: wide bins over the whole range, for the whole frame; a pulse that is wider than a bin counts in several
// bins, and their counts give its place to a small part of a bin. No part of the frame is spent on finding the
// pulse, and no pixel has a word beside its histogram.
//
// 1. Every timestamp x is counted in bin x >> (NP - NB).
// 2. M4 scans a pixel's bins for the highest pair of neighbours, and for how much the pairs on either side of it differ.
// 3. Behind the last bin, while the pixel before is still being sent, the place between the pair's bins is computed: a
//    difference, a height above the background, and a division, one bit a clock. {bin, place} is code and fraction, the
//    height is the confidence.
// 4. In M4 of a raw frame an address is a scan of its own, and the result its lowest code and its count.
//
//   clock                  what happens
//   T0                     timestamp registered, gated
//   T1                     bin
//   T2 to T5               histogram
//   S2, bins               highest pair so far
//   S2, two addresses past  the pair behind the last one
//   S2, the next           height of the pulse, and how far it leans
//   S2, the next           dividend
//   S2, NP-NB+FRACTION_BITS more  a bit of the place each
//   S3 of the last         result loaded
//
// Cost at the defaults: about 170 flip-flops and a histogram SRAM.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_coarse_histogram_column #(
    `include "dtof_column_parameters.svh"
) (
    `include "dtof_column_ports.svh"
);

  localparam int BINS = 1 << NB;
  localparam int PLACE_WIDTH = NP - NB + FRACTION_BITS;
  localparam int PLACE_BITS = dtof_pkg::max_of(PLACE_WIDTH, 1);
  localparam int POSITION_WIDTH = NP + FRACTION_BITS;

  logic unused_detected, unused_low_bits, detected_t1, full_t5;
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
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR)
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
      .full_t5_o      (full_t5)
  );

  assign unused_low_bits = ^timestamp_t1;

  // Addresses past the last bin are the clocks of the computation.
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

  dtof_full_counter_link u_full_counter_link (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .full_i       (full_t5),
      .next_column_i(next_counter_full_i),
      .full_o       (counter_full_o)
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
