// SPDX-License-Identifier: Apache-2.0
// hisPointer v1 and v2 (thesis 3.3.5, 3.3.6, 4.5): a coarse histogram finds the pulse, then a pointer finds its middle.
//
// 1. Measurement 1 builds a coarse histogram of each pixel.
// 2. M1 scans it: the middle c of the peak's bin P is where the pixel's pointer starts, c = (P << (NP-NB)) +
//    ((1 << (NP-NB)) >> 1).
// 3. Measurement 2 moves the pointers as ezPointer's. v2 lets only a window around the coarse peak through, c - SB < x
//    <= c + SB with SB = 2^(NB-1) + GUARD (Eq. 3.13), signed, no wrap; P travels with its pointer, as its tag.
// 4. In M4 the pointers are read. In that of a raw frame, which final_pass_i does not mark, it is a bin of the coarse
//    histogram: its lowest code and its count.
//
//   clock     measurement 1                            measurement 2
//   T0        timestamp registered, gated              the same
//   T1        coarse bin                               window tested beside the move of the pointer
//   T2 to T5  histogram                                pointer's word
//   S3 of M1  {P, confidence 0, c} set as the word
//   S3 of M4                                           result loaded
//
// Cost at the defaults: about 140 flip-flops, the coarse histogram SRAM and PIXELS_PER_SRAM x 19 bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_his_pointer_column #(
    `include "dtof_column_parameters.svh"
) (
    `include "dtof_column_ports.svh"
);

  localparam int POINTER_WIDTH = NP + FRACTION_BITS;
  localparam int CONFIDENCE_BITS = dtof_pkg::max_of(CONFIDENCE_WIDTH, 1);
  localparam int WINDOWED = (READOUT == dtof_pkg::READOUT_HISPOINTER) ? 1 : 0;
  localparam int TAG_WIDTH = (WINDOWED != 0) ? NB : 0;
  localparam int TAG_BITS = dtof_pkg::max_of(TAG_WIDTH, 1);
  localparam int HALF_BIN = (1 << (NP - NB)) >> 1;

  logic detected_t0, detected_t1;
  logic full_t5;
  logic [NP-1:0] timestamp_t1, centre;
  logic hit, in_window;
  logic [BIN_WIDTH-1:0] scan_peak;
  logic [COUNT_WIDTH-1:0] scan_count, unused_confidence;
  logic signed [NP+1:0] unused_start;
  logic [TAG_BITS-1:0] tag_t1, start_tag;
  logic [POINTER_WIDTH-1:0] pointer;
  logic [CONFIDENCE_BITS-1:0] confidence;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] histogram_cfg, pointer_cfg;

  assign sram_cfg_o = histogram_cfg & pointer_cfg;

  dtof_timestamp_input #(
      .NP       (NP),
      .TIME_GATE(TIME_GATE),
      .STAGES   (BROADCAST_STAGES)
  ) u_timestamp_input (
      .clk_i         (clk_i),
      .timestamp_i   (timestamp_i),
      .gate_begin_i  (gate_begin_i),
      .gate_end_i    (gate_end_i),
      .detected_t0_o (detected_t0),
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
      .FREEZE         (WINDOWED),
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR)
  ) u_peak_histogram (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .sram_cfg_i     (sram_cfg_i),
      .sram_cfg_o     (histogram_cfg),
      .build_t1_i     (beat_t1_i && detected_t1 && !final_pass_i),
      .timestamp_t1_i (timestamp_t1),
      .peak_i         (dtof_pkg::peak_width(READOUT, NP, NB)'(0)),
      .pass_i         (1'b0),
      .final_pass_i   (1'b0),
      .same_pixel_t3_i(same_pixel_t3_i),
      .beat_t5_i      (beat_t5_i),
      .scan_s0_i      (scan_s0_i && !final_pass_i),
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
      .confidence_o   (unused_confidence),
      .start_o        (unused_start),
      .full_t5_o      (full_t5)
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

  assign hit = beat_t1_i && final_pass_i && detected_t1 && in_window;

  dtof_pointer_builder #(
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
      .sram_cfg_i     (sram_cfg_i),
      .sram_cfg_o     (pointer_cfg),
      .read_i         (word_read_i),
      .read_pixel_i   (word_read_pixel_i),
      .read_done_i    (word_read_done_i),
      .first_slot_t0_i(first_slot_t0_i),
      .visit_t1_i     (visit_t1_i),
      .first_acq_t1_i (first_acq_t1_i),
      .write_i        (word_write_i),
      .write_pixel_i  (word_write_pixel_i),
      .step_t0_i      (step_t0_i),
      .may_hit_t0_i   (detected_t0 && final_pass_i),
      .hit_t1_i       (hit),
      .timestamp_t1_i (timestamp_t1),
      .tag_t1_o       (tag_t1),
      .start_write_i  (word_set_i),
      .start_pixel_i  (word_set_pixel_i),
      .start_pointer_i(POINTER_WIDTH'(centre) << FRACTION_BITS),
      .start_tag_i    (start_tag),
      .pointer_o      (pointer),
      .confidence_o   (confidence)
  );

  logic [RESULT_WIDTH-1:0] result;

  generate
    if (RAW_HISTOGRAM != 0) begin : g_raw_histogram
      logic [KEPT_CONFIDENCE_WIDTH-1:0] kept_confidence;
      assign kept_confidence = (CONFIDENCE_WIDTH != 0) ? KEPT_CONFIDENCE_WIDTH'(confidence) : '0;
      assign result = final_pass_i ? {pointer, kept_confidence}
          : {POINTER_WIDTH'(scan_peak) << (NP - NB + FRACTION_BITS), KEPT_CONFIDENCE_WIDTH'(scan_count)};
    end else begin : g_pointers_alone
      logic unused_count;
      assign unused_count = ^scan_count;
      assign result = RESULT_WIDTH'({pointer, confidence} >> (CONFIDENCE_BITS - CONFIDENCE_WIDTH));
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
