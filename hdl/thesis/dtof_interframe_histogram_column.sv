// SPDX-License-Identifier: Apache-2.0
// SiFH, FiFH and three steps (thesis 2.2.3, 3.3.3, 3.3.4, 4.4): coarse histograms find where the pulse is, a fine one
// of that place finds it exactly, in the same SRAM.
//
// 1. A coarse pass histograms the timestamps; M1 scans for the peak, which lengthens the pixel's coarse peak by its bits.
// 2. The final pass histograms a window at the coarse peak, one code a bin.
// 3. M4 scans for its peak; peak and begin of the window are the result.
//
// What differs is the window of a pass (dtof_data_filter) and how a pass's peak lengthens the coarse peak, both by READOUT.
// Coarse peaks are words of a small single-port SRAM: read one pixel ahead while building, at the last bin of a pixel
// while scanning, and set in M1 at S3; reads and writes fall on different clocks because the number of bins is even.
//
//   clock     what happens
//   T0        timestamp and coarse peak registered
//   T1        filter: bin and hit
//   T2 to T5  histogram
//   S3 of M1  the longer coarse peak is set
//   S3 of M4  result loaded
//
// Cost at the defaults: about 130 flip-flops, a histogram SRAM and PIXELS_PER_SRAM x PEAK_WIDTH bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_interframe_histogram_column #(
    `include "dtof_column_parameters.svh"
) (
    `include "dtof_column_ports.svh"
);

  localparam int PEAK_WIDTH = dtof_pkg::peak_width(READOUT, NP, NB);

  logic unused_detected, detected_t1;
  logic full_t5;
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
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR)
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
      .full_t5_o      (full_t5)
  );

  dtof_sram #(
      .PORTS(1),
      .DEPTH(PIXELS_PER_SRAM),
      .WIDTH(PEAK_WIDTH)
  ) u_peak_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (peak_cfg),
      .read_en_i   (word_read_i),
      .read_addr_i (word_read_pixel_i),
      .read_data_o (peak_data),
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

  // A window may begin below code 0, where an empty fine histogram has its peak. No window's peak lies beyond the
  // last code: only codes that were measured are counted, and an empty window's first code is in the range. A bin of a
  // raw frame may; it gets the code of no detection.
  logic unused_peak_code;
  assign peak_code = start + $signed((NP + 2)'(scan_peak));
  assign code = peak_code[NP+1] ? '0
      : (RAW_HISTOGRAM != 0 && peak_code[NP]) ? {NP{1'b1}} : peak_code[NP-1:0];
  assign unused_peak_code = peak_code[NP];

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
      .result_i     ({code, confidence}),
      .next_column_i(next_column_i),
      .result_o     (result_o)
  );

endmodule

`default_nettype wire
