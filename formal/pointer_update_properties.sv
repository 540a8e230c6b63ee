// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pointer_update: one step of a pointer and of its confidence follows Eq. 3.12 and docs/reference/readouts.md, in 32-bit
// integers.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pointer_update_properties #(
    parameter int NP = 10,
    parameter int POINTER_STEP = 1,
    parameter int FRACTION_BITS = 0,
    parameter int CONFIDENCE_WIDTH = 4,
    localparam int POINTER_WIDTH = NP + FRACTION_BITS,
    localparam int CONFIDENCE_BITS = (CONFIDENCE_WIDTH == 0) ? 1 : CONFIDENCE_WIDTH,
    localparam int STEP_WIDTH = dtof_pkg::step_width(POINTER_STEP, FRACTION_BITS)
) (
    input logic                       clk_i,
    input logic                       hit_i,
    input logic [             NP-1:0] timestamp_i,
    input logic [                3:0] gear_i,
    input logic [  POINTER_WIDTH-1:0] pointer_i,
    input logic [CONFIDENCE_BITS-1:0] confidence_i
);

  logic checking;
  assign checking = 1'b1;

  localparam int RANGE = 1 << POINTER_WIDTH;
  localparam int NEAR_RANGE = (POINTER_WIDTH < 5) ? 1 : RANGE / 32;  // range in which the top bits of d are equal

  logic [POINTER_WIDTH-1:0] pointer;
  logic [CONFIDENCE_BITS-1:0] confidence;
  logic [STEP_WIDTH-1:0] step_in;
  integer step, d, expected_pointer, expected_confidence;
  logic near, far;

  assign step_in = STEP_WIDTH'(step);

  dtof_pointer_update #(
      .NP              (NP),
      .POINTER_STEP    (POINTER_STEP),
      .FRACTION_BITS   (FRACTION_BITS),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH)
  ) u_dut (
      .hit_i       (hit_i),
      .timestamp_i (timestamp_i),
      .step_i      (step_in),
      .pointer_i   (pointer_i),
      .confidence_i(confidence_i),
      .pointer_o   (pointer),
      .confidence_o(confidence)
  );

  always_comb begin
    step = (POINTER_STEP << FRACTION_BITS) >>> gear_i;
    d = ((32'(timestamp_i) << FRACTION_BITS) - 32'(pointer_i)) & (RANGE - 1);
    expected_pointer = 32'(pointer_i);
    if (hit_i && d >= 1 && d <= RANGE / 2) begin
      expected_pointer = (32'(pointer_i) + step) & (RANGE - 1);
    end else if (hit_i && d > RANGE / 2) begin
      expected_pointer = (32'(pointer_i) - step) & (RANGE - 1);
    end
    near = (d < NEAR_RANGE) || (d >= RANGE - NEAR_RANGE);
    far = !near && (timestamp_i[2:0] == 3'd0);
    expected_confidence = 32'(confidence_i);
    if (hit_i && near && expected_confidence < (1 << CONFIDENCE_WIDTH) - 1) begin
      expected_confidence = expected_confidence + 1;
    end else if (hit_i && far && expected_confidence > 0) begin
      expected_confidence = expected_confidence - 1;
    end
  end

  `ASSUME(m_gear, 32'(gear_i) <= FRACTION_BITS)
  `PROVE(a_pointer, 32'(pointer) == expected_pointer)
  `PROVE(a_confidence, (CONFIDENCE_WIDTH == 0) || 32'(confidence) == expected_confidence)

endmodule

`default_nettype wire
