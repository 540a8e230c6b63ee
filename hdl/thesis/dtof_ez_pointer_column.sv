// SPDX-License-Identifier: Apache-2.0
// ezPointer (thesis 3.3.2, 4.3): one pointer a pixel, which every timestamp moves one step towards itself.
//
// 1. RESET sets every pixel's pointer to the middle of the range.
// 2. Each timestamp of the frame, gated at T0, moves its pixel's pointer at T1; dtof_pointer_builder has the SRAM.
// 3. In M4 the pointer is read, and is the result with its confidence at S3. There is no histogram, and no coarse pass.
//
//   clock     what happens
//   T0        timestamp registered, gated
//   T1        pointer moved
//   T2        written, behind a pixel's last slot
//   S3 of M4  result loaded
//
// Cost at the defaults: about 50 flip-flops and PIXELS_PER_SRAM x 14 bits (10 without confidence).

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_ez_pointer_column #(
    `include "dtof_column_parameters.svh"
) (
    `include "dtof_column_ports.svh"
);

  localparam int POINTER_WIDTH = NP + FRACTION_BITS;
  localparam int CONFIDENCE_BITS = dtof_pkg::max_of(CONFIDENCE_WIDTH, 1);
  localparam logic [POINTER_WIDTH-1:0] MIDDLE = POINTER_WIDTH'(1) << (POINTER_WIDTH - 1);

  logic detected_t0, detected_t1;
  logic [NP-1:0] timestamp_t1;
  logic [POINTER_WIDTH-1:0] pointer;
  logic [CONFIDENCE_BITS-1:0] confidence;
  logic unused_tag, unused_next_counter_full;

  // No counters.
  assign unused_next_counter_full = next_counter_full_i;
  assign counter_full_o = 1'b0;

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

  dtof_pointer_builder #(
      .NP              (NP),
      .PIXELS_PER_SRAM (PIXELS_PER_SRAM),
      .SLOTS           (SLOTS),
      .POINTER_STEP    (POINTER_STEP),
      .FRACTION_BITS   (FRACTION_BITS),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .TAG_WIDTH       (0),
      .PORTS           (POINTER_PORTS)
  ) u_pointer_builder (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .sram_cfg_i     (sram_cfg_i),
      .sram_cfg_o     (sram_cfg_o),
      .read_i         (word_read_i),
      .read_pixel_i   (word_read_pixel_i),
      .read_done_i    (word_read_done_i),
      .first_slot_t0_i(first_slot_t0_i),
      .visit_t1_i     (visit_t1_i),
      .first_acq_t1_i (first_acq_t1_i),
      .write_i        (word_write_i),
      .write_pixel_i  (word_write_pixel_i),
      .step_t0_i      (step_t0_i),
      .may_hit_t0_i   (detected_t0),
      .hit_t1_i       (beat_t1_i && detected_t1),
      .timestamp_t1_i (timestamp_t1),
      .tag_t1_o       (unused_tag),
      .start_write_i  (word_set_i),
      .start_pixel_i  (word_set_pixel_i),
      .start_pointer_i(MIDDLE),
      .start_tag_i    (1'b0),
      .pointer_o      (pointer),
      .confidence_o   (confidence)
  );

  dtof_result_register #(
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

`default_nettype wire
