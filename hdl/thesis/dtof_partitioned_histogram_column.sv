// SPDX-License-Identifier: Apache-2.0
// PiFH (thesis 2.2.3, Eq. 2.1): the range is scanned partition by partition in one small histogram; the best peak over
// all runs is the result. With NB = NP there is one run: the full histogram.
//
// 1. A run histograms the timestamps of its partition, one code a bin.
// 2. Its scan, M1 or for the last run M4, finds the peak. It replaces the pixel's best so far only if its count is
//    strictly larger.
// 3. The best {count, code, confidence} is a word of a small single-port SRAM, read at the last bin of the pixel's scan
//    and set at S3; of the last run it is the result.
//
//   clock              what happens
//   T0                 timestamp registered, gated
//   T1                 filter: is it of this run's partition, and in which bin
//   T2 to T5           histogram
//   a pixel's last bin  the best so far is read
//   S3                 the better of the two is set (M1) or loaded as result (M4)
//
// Cost: about 140 flip-flops, a histogram SRAM, and PIXELS_PER_SRAM x (2 COUNT_WIDTH + NP) bits if NB < NP.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_partitioned_histogram_column #(
    `include "dtof_column_parameters.svh"
) (
    `include "dtof_column_ports.svh"
);

  logic unused_detected, detected_t1;
  logic full_t5;
  logic [NP-1:0] timestamp_t1;
  logic [BIN_WIDTH-1:0] scan_peak;
  logic [NP-1:0] scan_code;
  logic [COUNT_WIDTH-1:0] scan_count, scan_confidence;
  logic [RESULT_WIDTH-1:0] loaded_result;
  logic load_result;
  logic signed [NP+1:0] unused_start;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] histogram_cfg;

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
      .FREEZE         ((dtof_pkg::coarse_passes(READOUT, NP, NB) == 0) ? 1 : 0),
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR)
  ) u_peak_histogram (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .sram_cfg_i     (sram_cfg_i),
      .sram_cfg_o     (histogram_cfg),
      .build_t1_i     (beat_t1_i && detected_t1),
      .timestamp_t1_i (timestamp_t1),
      .peak_i         (dtof_pkg::peak_width(READOUT, NP, NB)'(0)),
      .pass_i         (pass_i),
      .final_pass_i   (1'b0),
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
      .count_o        (scan_count),
      .confidence_o   (scan_confidence),
      .start_o        (unused_start),
      .full_t5_o      (full_t5)
  );

  generate
    if (dtof_pkg::coarse_passes(READOUT, NP, NB) > 0) begin : g_partitions
      localparam int BEST_WIDTH = COUNT_WIDTH + RESULT_WIDTH;
      logic [BEST_WIDTH-1:0] best_data, best_q, best;
      logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] best_cfg;
      logic [COUNT_WIDTH-1:0] best_count_q;

      assign sram_cfg_o = histogram_cfg & best_cfg;
      assign scan_code = {pass_i, scan_peak};

      always_ff @(posedge clk_i) begin
        if (word_read_done_i) begin
          best_count_q <= best_data[RESULT_WIDTH+:COUNT_WIDTH];
        end
      end

      // While scanning, the result chain's register holds the best code and confidence so far.
      assign best_q = {best_count_q, result_o};
      assign load_result = result_load_i || word_read_done_i;
      assign loaded_result = word_read_done_i ? best_data[RESULT_WIDTH-1:0] : best[RESULT_WIDTH-1:0];

      // The broadcast flag selects late, behind the comparator.
      logic better;
      assign better = first_pass_i ? (scan_count != '0) : (scan_count > best_q[RESULT_WIDTH+:COUNT_WIDTH]);
      always_comb begin
        best = first_pass_i ? '0 : best_q;
        if (better) begin
          best = {scan_count, scan_code, scan_confidence};
        end
      end

      dtof_sram #(
          .PORTS(1),
          .DEPTH(PIXELS_PER_SRAM),
          .WIDTH(BEST_WIDTH)
      ) u_best_sram (
          .clk_i       (clk_i),
          .rst_ni      (rst_ni),
          .cfg_i       (sram_cfg_i),
          .cfg_o       (best_cfg),
          .read_en_i   (word_read_i),
          .read_addr_i (word_read_pixel_i),
          .read_data_o (best_data),
          .write_en_i  (word_set_i),
          .write_addr_i(word_set_pixel_i),
          .write_data_i(best)
      );
    end else begin : g_one_run
      logic unused_count;
      assign unused_count = ^scan_count;
      assign sram_cfg_o = histogram_cfg;
      assign scan_code = scan_peak;
      assign load_result = result_load_i;
      assign loaded_result = {scan_code, scan_confidence};
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
      .load_i       (load_result),
      .shift_i      (result_shift_i),
      .result_i     (loaded_result),
      .next_column_i(next_column_i),
      .result_o     (result_o)
  );

endmodule

`default_nettype wire
