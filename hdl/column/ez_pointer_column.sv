// SPDX-License-Identifier: Apache-2.0
// ezPointer (thesis 3.3.2, 4.3): every timestamp moves its pixel's pointer one step; no histogram.
//
// Schedule: T0 timestamp register, T1 move; pointer_builder has the SRAM's schedule. The result is loaded at
// S3 of M4. Cost at the defaults: about 50 flip-flops and PIXELS_PER_SRAM x 14 bits (10 without confidence).
module ez_pointer_column #(
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SLOTS = 2,
    parameter int POINTER_STEP = 1,
    parameter int FRACTION_BITS = 0,
    parameter int CONFIDENCE_WIDTH = 4,
    parameter int POINTER_PORTS = 2,
    parameter int TIME_GATE = 0,
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int STEP_WIDTH = dtof_pkg::step_width(POINTER_STEP, FRACTION_BITS),
    localparam int RESULT_WIDTH = NP + FRACTION_BITS + CONFIDENCE_WIDTH
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    input  logic [          NP-1:0] timestamp_i,
    input  logic [          NP-1:0] gate_begin_i,
    input  logic [          NP-1:0] gate_end_i,
    // pointer schedule
    input  logic                    beat_t1_i,
    input  logic                    pointer_read_i,
    input  logic [   ROW_WIDTH-1:0] pointer_read_pixel_i,
    input  logic                    pointer_read_done_i,
    input  logic                    first_slot_t0_i,
    input  logic                    visit_t1_i,
    input  logic                    first_acq_t1_i,
    input  logic                    pointer_write_i,
    input  logic [   ROW_WIDTH-1:0] pointer_write_pixel_i,
    input  logic [  STEP_WIDTH-1:0] step_t0_i,
    // clear schedule: the start value is written in RESET
    input  logic                    clear_s1_i,
    input  logic [   ROW_WIDTH-1:0] clear_pixel_s1_i,
    // result chain
    input  logic                    result_load_i,
    input  logic                    result_shift_i,
    input  logic [RESULT_WIDTH-1:0] next_column_i,
    output logic [RESULT_WIDTH-1:0] result_o
);

  localparam int POINTER_WIDTH = NP + FRACTION_BITS;
  localparam int CONFIDENCE_BITS = dtof_pkg::max_of(CONFIDENCE_WIDTH, 1);
  localparam logic [POINTER_WIDTH-1:0] MIDDLE = POINTER_WIDTH'(1) << (POINTER_WIDTH - 1);

  logic [NP-1:0] timestamp_t1;
  logic [POINTER_WIDTH-1:0] pointer;
  logic [CONFIDENCE_BITS-1:0] confidence;
  logic unused_tag;

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

  pointer_builder #(
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
      .read_i         (pointer_read_i),
      .read_pixel_i   (pointer_read_pixel_i),
      .read_done_i    (pointer_read_done_i),
      .first_slot_t0_i(first_slot_t0_i),
      .visit_t1_i     (visit_t1_i),
      .first_acq_t1_i (first_acq_t1_i),
      .write_i        (pointer_write_i),
      .write_pixel_i  (pointer_write_pixel_i),
      .step_t0_i      (step_t0_i),
      .hit_t1_i       (beat_t1_i && timestamp_t1 != '1),
      .timestamp_t1_i (timestamp_t1),
      .tag_t1_o       (unused_tag),
      .start_write_i  (clear_s1_i),
      .start_pixel_i  (clear_pixel_s1_i),
      .start_pointer_i(MIDDLE),
      .start_tag_i    (1'b0),
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
