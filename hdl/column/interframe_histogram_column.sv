// SPDX-License-Identifier: Apache-2.0
// SiFH, FiFH and three steps (thesis 2.2.3, 3.3.3, 3.3.4, 4.4): coarse histogram passes find a peak, the final
// pass builds a fine histogram around it in the same SRAM.
//
// What differs is the data filter and how a pass's peak extends the pixel's coarse peak, both by READOUT.
// The coarse peaks live in a small single-port SRAM: read one pixel ahead while building, at the last bin of a
// pixel while scanning, written in M1 at S3 (reads and writes fall on different clocks, as bins are even).
// Schedule: T0 timestamp and peak registered, T1 filter, then histogram_builder; result loaded at S3 of M4.
// Cost at the defaults: about 130 flip-flops, a histogram SRAM and PIXELS_PER_SRAM x PEAK_WIDTH bits.
module interframe_histogram_column #(
    parameter int READOUT = dtof_pkg::READOUT_SIFH,
    parameter int NP = 10,
    parameter int NB = 6,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SLOTS = 2,
    parameter int COUNT_WIDTH = 10,
    parameter int WINDOW_CENTRED = 0,
    parameter int SIGNALLED_CLEAR = 0,
    parameter int TIME_GATE = 0,
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int BIN_WIDTH = dtof_pkg::bin_width(READOUT, NP, NB),
    localparam int PASS_WIDTH = dtof_pkg::index_width(dtof_pkg::coarse_passes(READOUT, NP, NB) + 1),
    localparam int RESULT_WIDTH = NP + COUNT_WIDTH
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    input  logic [          NP-1:0] timestamp_i,
    input  logic [          NP-1:0] gate_begin_i,
    input  logic [          NP-1:0] gate_end_i,
    // pass
    input  logic [  PASS_WIDTH-1:0] pass_i,
    input  logic                    final_pass_i,
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
    // peak schedule
    input  logic                    peak_read_i,
    input  logic [   ROW_WIDTH-1:0] peak_read_pixel_i,
    input  logic                    peak_read_done_i,
    input  logic                    peak_write_s3_i,
    input  logic [   ROW_WIDTH-1:0] peak_write_pixel_s3_i,
    // result chain
    input  logic                    result_load_i,
    input  logic                    result_shift_i,
    input  logic [RESULT_WIDTH-1:0] next_column_i,
    output logic [RESULT_WIDTH-1:0] result_o
);

  localparam int PEAK_WIDTH = dtof_pkg::peak_width(READOUT, NP, NB);
  localparam int FINE_WIDTH = (READOUT == dtof_pkg::READOUT_FIFH) ? NP - NB : BIN_WIDTH;

  logic [NP-1:0] timestamp_t1;
  logic [PEAK_WIDTH-1:0] peak_data, peak_q, new_peak;
  logic keep;
  logic [BIN_WIDTH-1:0] bin_t1, scan_peak;
  logic signed [NP+1:0] start, peak_code;
  logic [NP-1:0] code;
  logic [COUNT_WIDTH-1:0] count, unused_peak_count, confidence;

  always_ff @(posedge clk_i) begin
    if (peak_read_done_i) begin
      peak_q <= peak_data;
    end
  end

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
      .READOUT       (READOUT),
      .NP            (NP),
      .NB            (NB),
      .WINDOW_CENTRED(WINDOW_CENTRED)
  ) u_data_filter (
      .timestamp_i (timestamp_t1),
      .peak_i      (peak_q),
      .pass_i      (pass_i),
      .final_pass_i(final_pass_i),
      .keep_o      (keep),
      .bin_o       (bin_t1),
      .start_o     (start)
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
      .SHARE_SHIFT(FINE_WIDTH)
  ) u_peak_detector (
      .clk_i       (clk_i),
      .read_s2_i   (scan_s2_i),
      .first_s2_i  (first_s2_i),
      .bin_s2_i    (bin_s2_i),
      .count_s2_i  (count),
      .peak_o      (scan_peak),
      .count_o     (unused_peak_count),
      .confidence_o(confidence)
  );

  dtof_sram #(
      .PORTS(1),
      .DEPTH(PIXELS_PER_SRAM),
      .WIDTH(PEAK_WIDTH)
  ) u_peak_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .read_en_i   (peak_read_i),
      .read_addr_i (peak_read_pixel_i),
      .read_data_o (peak_data),
      .write_en_i  (peak_write_s3_i),
      .write_addr_i(peak_write_pixel_s3_i),
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
  // last code: only codes that were measured are counted, and an empty window's first code is in the range.
  logic unused_peak_code;
  assign peak_code = start + $signed((NP + 2)'(scan_peak));
  assign code = peak_code[NP+1] ? '0 : peak_code[NP-1:0];
  assign unused_peak_code = peak_code[NP];

  result_register #(
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
