// SPDX-License-Identifier: Apache-2.0
// hisPointer v1 and v2 (thesis 3.3.5, 3.3.6, 4.5): a coarse histogram in measurement 1 gives each pointer its
// start, measurement 2 moves it; v2 lets only a window around the coarse peak through.
//
// Equation: c = (P << (NP-NB)) + ((1 << (NP-NB)) >> 1); v2 keeps c - SB < x <= c + SB, SB = 2^(NB-1) + GUARD
// (Eq. 3.13), signed, no wrap.
// Schedule: measurement 1 as interframe_histogram_column; M1 writes {P, 0, c} into the pointer SRAM at S3;
// measurement 2 as ez_pointer_column, the window tested at T1 beside the move. P travels with its pointer.
// Cost at the defaults: about 140 flip-flops, the coarse histogram SRAM and PIXELS_PER_SRAM x 19 bits.
module his_pointer_column #(
    parameter int READOUT = dtof_pkg::READOUT_HISPOINTER,
    parameter int NP = 10,
    parameter int NB = 5,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SLOTS = 2,
    parameter int COUNT_WIDTH = 10,
    parameter int POINTER_STEP = 1,
    parameter int FRACTION_BITS = 0,
    parameter int CONFIDENCE_WIDTH = 4,
    parameter int GUARD = 46,
    parameter int POINTER_PORTS = 2,
    parameter int SIGNALLED_CLEAR = 0,
    parameter int TIME_GATE = 0,
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int BIN_WIDTH = dtof_pkg::bin_width(READOUT, NP, NB),
    localparam int STEP_WIDTH = dtof_pkg::step_width(POINTER_STEP, FRACTION_BITS),
    localparam int RESULT_WIDTH = NP + FRACTION_BITS + CONFIDENCE_WIDTH
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    input  logic [          NP-1:0] timestamp_i,
    input  logic [          NP-1:0] gate_begin_i,
    input  logic [          NP-1:0] gate_end_i,
    // pass
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
    // pointer schedule
    input  logic                    pointer_read_i,
    input  logic [   ROW_WIDTH-1:0] pointer_read_pixel_i,
    input  logic                    pointer_read_done_i,
    input  logic                    first_slot_t0_i,
    input  logic                    visit_t1_i,
    input  logic                    first_acq_t1_i,
    input  logic                    pointer_write_i,
    input  logic [   ROW_WIDTH-1:0] pointer_write_pixel_i,
    input  logic [  STEP_WIDTH-1:0] step_t0_i,
    input  logic                    start_write_s3_i,
    input  logic [   ROW_WIDTH-1:0] start_pixel_s3_i,
    // result chain
    input  logic                    result_load_i,
    input  logic                    result_shift_i,
    input  logic [RESULT_WIDTH-1:0] next_column_i,
    output logic [RESULT_WIDTH-1:0] result_o
);

  localparam int POINTER_WIDTH = NP + FRACTION_BITS;
  localparam int CONFIDENCE_BITS = dtof_pkg::max_of(CONFIDENCE_WIDTH, 1);
  localparam int WINDOWED = (READOUT == dtof_pkg::READOUT_HISPOINTER) ? 1 : 0;
  localparam int TAG_WIDTH = (WINDOWED != 0) ? NB : 0;
  localparam int TAG_BITS = dtof_pkg::max_of(TAG_WIDTH, 1);
  localparam int HALF_BIN = (1 << (NP - NB)) >> 1;

  logic [NP-1:0] timestamp_t1, centre;
  logic coarse_keep, coarse_hit, hit, in_window;
  logic [BIN_WIDTH-1:0] bin_t1, scan_peak;
  logic [COUNT_WIDTH-1:0] count, unused_peak_count, unused_confidence;
  logic signed [NP+1:0] unused_start;
  logic [TAG_BITS-1:0] tag_t1, start_tag;
  logic [POINTER_WIDTH-1:0] pointer;
  logic [CONFIDENCE_BITS-1:0] confidence;

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
      .pass_i      (1'b0),
      .final_pass_i(1'b0),
      .keep_o      (coarse_keep),
      .bin_o       (bin_t1),
      .start_o     (unused_start)
  );

  assign coarse_hit = beat_t1_i && coarse_keep && !final_pass_i;

  histogram_builder #(
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .BIN_WIDTH      (BIN_WIDTH),
      .SLOTS          (SLOTS),
      .COUNT_WIDTH    (COUNT_WIDTH),
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR)
  ) u_histogram_builder (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .hit_t1_i       (coarse_hit),
      .bin_t1_i       (bin_t1),
      .same_pixel_t3_i(same_pixel_t3_i),
      .beat_t5_i      (beat_t5_i),
      .scan_s0_i      (scan_s0_i && !final_pass_i),
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
      .count_o     (unused_peak_count),
      .confidence_o(unused_confidence)
  );

  generate
    if (NP > NB) begin : g_centre
      assign centre = {scan_peak, (NP - NB)'(HALF_BIN)};
    end else begin : g_bin_is_centre
      assign centre = scan_peak;
    end
    if (WINDOWED != 0) begin : g_window
      localparam int SIDE_BAND = (1 << (NB - 1)) + GUARD;
      // x - c lies in -SB + 1 .. SB; GUARD may exceed the range, so three bits more than a timestamp.
      localparam int OFFSET_WIDTH = dtof_pkg::max_of(NP, $clog2(SIDE_BAND + 1)) + 2;
      localparam logic signed [OFFSET_WIDTH-1:0] LOWEST = OFFSET_WIDTH'(1 - SIDE_BAND);
      localparam logic signed [OFFSET_WIDTH-1:0] HIGHEST = OFFSET_WIDTH'(SIDE_BAND);
      logic signed [OFFSET_WIDTH-1:0] offset;
      assign offset = $signed(OFFSET_WIDTH'(timestamp_t1)) - $signed(OFFSET_WIDTH'(tag_t1) << (NP - NB))
          - $signed(OFFSET_WIDTH'(HALF_BIN));
      assign in_window = (offset >= LOWEST) && (offset <= HIGHEST);
      assign start_tag = scan_peak;
    end else begin : g_no_window
      logic unused_tag;
      assign unused_tag = tag_t1[0];
      assign in_window = 1'b1;
      assign start_tag = '0;
    end
  endgenerate

  assign hit = beat_t1_i && (timestamp_t1 != '1) && in_window;

  pointer_builder #(
      .NP              (NP),
      .PIXELS_PER_SRAM (PIXELS_PER_SRAM),
      .SLOTS           (SLOTS),
      .POINTER_STEP    (POINTER_STEP),
      .FRACTION_BITS   (FRACTION_BITS),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .TAG_WIDTH       (TAG_WIDTH),
      .PORTS           (POINTER_PORTS)
  ) u_pointer_builder (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .read_i         (pointer_read_i),
      .read_pixel_i   (pointer_read_pixel_i),
      .read_done_i    (pointer_read_done_i),
      .first_slot_t0_i(first_slot_t0_i),
      .visit_t1_i     (visit_t1_i),
      .first_acq_t1_i (first_acq_t1_i),
      .write_i        (pointer_write_i),
      .write_pixel_i  (pointer_write_pixel_i),
      .step_t0_i      (step_t0_i),
      .hit_t1_i       (hit),
      .timestamp_t1_i (timestamp_t1),
      .tag_t1_o       (tag_t1),
      .start_write_i  (start_write_s3_i),
      .start_pixel_i  (start_pixel_s3_i),
      .start_pointer_i(POINTER_WIDTH'(centre) << FRACTION_BITS),
      .start_tag_i    (start_tag),
      .pointer_o      (pointer),
      .confidence_o   (confidence)
  );

  result_register #(
      .WIDTH(RESULT_WIDTH)
  ) u_result_register (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .load_i       (result_load_i),
      .shift_i      (result_shift_i),
      .result_i     (RESULT_WIDTH'({pointer, confidence} >> (CONFIDENCE_BITS - CONFIDENCE_WIDTH))),
      .next_column_i(next_column_i),
      .result_o     (result_o)
  );

endmodule
