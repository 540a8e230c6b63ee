// SPDX-License-Identifier: Apache-2.0
// PiFH (thesis 2.2.3, Eq. 2.1): the range is scanned partition by partition in one small histogram; the best
// peak over all runs is the result. With NB = NP there is one run: the full histogram.
//
// A run's peak replaces the best only if its count is strictly larger. The best {count, code, confidence} of a
// pixel lives in a small single-port SRAM, read at the last bin of the pixel's scan and written at S3.
// Schedule: T0 timestamp register, T1 filter, then histogram_builder; result loaded at S3 of M4.
// Cost: about 140 flip-flops, a histogram SRAM, and PIXELS_PER_SRAM x (2 COUNT_WIDTH + NP) bits if NB < NP.
module partitioned_histogram_column #(
    parameter int READOUT = dtof_pkg::READOUT_PIFH,
    parameter int NP = 10,
    parameter int NB = 6,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SLOTS = 2,
    parameter int COUNT_WIDTH = 10,
    parameter int SIGNALLED_CLEAR = 0,
    parameter int TIME_GATE = 0,
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int BIN_WIDTH = dtof_pkg::bin_width(READOUT, NP, NB),
    localparam int COARSE_PASSES = dtof_pkg::coarse_passes(READOUT, NP, NB),
    localparam int PASS_WIDTH = dtof_pkg::index_width(COARSE_PASSES + 1),
    localparam int RESULT_WIDTH = NP + COUNT_WIDTH
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    input  logic [          NP-1:0] timestamp_i,
    input  logic [          NP-1:0] gate_begin_i,
    input  logic [          NP-1:0] gate_end_i,
    // pass
    input  logic [  PASS_WIDTH-1:0] pass_i,
    input  logic                    first_pass_i,
    // histogram schedule
    input  logic                    beat_t1_i,
    input  logic [             3:1] same_pixel_t3_i,
    input  logic                    beat_t5_i,
    input  logic                    scan_s0_i,
    input  logic [   BIN_WIDTH-1:0] scan_bin_s0_i,
    input  logic [   ROW_WIDTH-1:0] histogram_read_pixel_i,
    input  logic                    clear_s1_i,
    input  logic [   BIN_WIDTH-1:0] clear_bin_s1_i,
    input  logic [   ROW_WIDTH-1:0] histogram_write_pixel_i,
    input  logic                    clear_all_i,
    input  logic                    scan_s2_i,
    input  logic                    first_s2_i,
    input  logic [   BIN_WIDTH-1:0] bin_s2_i,
    // schedule of the best peak
    input  logic                    best_read_i,
    input  logic [   ROW_WIDTH-1:0] best_read_pixel_i,
    input  logic                    best_read_done_i,
    input  logic                    best_write_s3_i,
    input  logic [   ROW_WIDTH-1:0] best_write_pixel_s3_i,
    // result chain
    input  logic                    result_load_i,
    input  logic                    result_shift_i,
    input  logic [RESULT_WIDTH-1:0] next_column_i,
    output logic [RESULT_WIDTH-1:0] result_o
);

  logic [NP-1:0] timestamp_t1;
  logic keep;
  logic [BIN_WIDTH-1:0] bin_t1, scan_peak;
  logic [NP-1:0] scan_code;
  logic [COUNT_WIDTH-1:0] count, scan_count, scan_confidence;
  logic [RESULT_WIDTH-1:0] loaded_result;
  logic load_result;
  logic signed [NP+1:0] unused_start;

  time_gate #(
      .NP       (NP),
      .TIME_GATE(TIME_GATE)
  ) u_time_gate (
      .clk_i         (clk_i),
      .timestamp_i   (timestamp_i),
      .gate_begin_i  (gate_begin_i),
      .gate_end_i    (gate_end_i),
      .timestamp_t1_o(timestamp_t1)
  );

  data_filter #(
      .READOUT(READOUT),
      .NP     (NP),
      .NB     (NB)
  ) u_data_filter (
      .timestamp_i (timestamp_t1),
      .peak_i      (dtof_pkg::peak_width(READOUT, NP, NB)'(0)),
      .pass_i      (pass_i),
      .final_pass_i(1'b0),
      .keep_o      (keep),
      .bin_o       (bin_t1),
      .start_o     (unused_start)
  );

  histogram_builder #(
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .BIN_WIDTH      (BIN_WIDTH),
      .SLOTS          (SLOTS),
      .COUNT_WIDTH    (COUNT_WIDTH),
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR)
  ) u_histogram_builder (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .hit_t1_i       (beat_t1_i && keep),
      .bin_t1_i       (bin_t1),
      .same_pixel_t3_i(same_pixel_t3_i),
      .beat_t5_i      (beat_t5_i),
      .scan_s0_i      (scan_s0_i),
      .scan_bin_s0_i  (scan_bin_s0_i),
      .read_pixel_i   (histogram_read_pixel_i),
      .clear_s1_i     (clear_s1_i),
      .clear_bin_s1_i (clear_bin_s1_i),
      .write_pixel_i  (histogram_write_pixel_i),
      .clear_all_i    (clear_all_i),
      .count_s2_o     (count)
  );

  peak_detector #(
      .BIN_WIDTH  (BIN_WIDTH),
      .COUNT_WIDTH(COUNT_WIDTH),
      .SHARE_SHIFT(BIN_WIDTH)
  ) u_peak_detector (
      .clk_i       (clk_i),
      .read_s2_i   (scan_s2_i),
      .first_s2_i  (first_s2_i),
      .bin_s2_i    (bin_s2_i),
      .count_s2_i  (count),
      .peak_o      (scan_peak),
      .count_o     (scan_count),
      .confidence_o(scan_confidence)
  );

  generate
    if (COARSE_PASSES > 0) begin : g_partitions
      localparam int BEST_WIDTH = COUNT_WIDTH + RESULT_WIDTH;
      logic [BEST_WIDTH-1:0] best_data, best_q, best;
      logic [COUNT_WIDTH-1:0] best_count_q;

      assign scan_code = {pass_i, scan_peak};

      always_ff @(posedge clk_i) begin
        if (best_read_done_i) begin
          best_count_q <= best_data[RESULT_WIDTH+:COUNT_WIDTH];
        end
      end

      // While scanning, the result chain's register holds the best code and confidence so far.
      assign best_q = {best_count_q, result_o};
      assign load_result = result_load_i || best_read_done_i;
      assign loaded_result = best_read_done_i ? best_data[RESULT_WIDTH-1:0] : best[RESULT_WIDTH-1:0];

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
          .read_en_i   (best_read_i),
          .read_addr_i (best_read_pixel_i),
          .read_data_o (best_data),
          .write_en_i  (best_write_s3_i),
          .write_addr_i(best_write_pixel_s3_i),
          .write_data_i(best)
      );
    end else begin : g_one_run
      logic unused_best;
      assign unused_best = first_pass_i ^ best_read_i ^ (^best_read_pixel_i) ^ best_read_done_i ^ best_write_s3_i
          ^ (^best_write_pixel_s3_i) ^ (^scan_count);
      assign scan_code = scan_peak;
      assign load_result = result_load_i;
      assign loaded_result = {scan_code, scan_confidence};
    end
  endgenerate

  result_register #(
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
