// SPDX-License-Identifier: Apache-2.0
// One step of a pointer towards a timestamp, and of its confidence. Combinational.
//
// Equation (Eq. 3.12, modulo 2^(NP+F), F = FRACTION_BITS): d = (x << F) - p. d = 0: p stays. 1 <= d <= half the
// range: p + step, otherwise p - step, with step = (POINTER_STEP << F) >> gear.
// Confidence (docs/reference/readouts.md): a near timestamp (the top five bits of d are equal) adds 1; a far one with x mod 8 = 0
// subtracts 1; the confidence saturates. The low bits of a background timestamp are uniform, so a far one counts 1/8.
// Latency: none. Cost: a subtractor, two incrementers beside it, equality tests; about 25 gate delays.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pointer_update #(
    parameter int NP = 10,
    parameter int POINTER_STEP = 1,
    parameter int FRACTION_BITS = 0,
    parameter int CONFIDENCE_WIDTH = 4,  // 0: no confidence
    localparam int POINTER_WIDTH = NP + FRACTION_BITS,
    localparam int CONFIDENCE_BITS = dtof_pkg::max_of(CONFIDENCE_WIDTH, 1),
    localparam int STEP_WIDTH = dtof_pkg::step_width(POINTER_STEP, FRACTION_BITS)
) (
    input  logic                       hit_i,         // the timestamp counts
    input  logic [             NP-1:0] timestamp_i,
    input  logic [     STEP_WIDTH-1:0] step_i,        // (POINTER_STEP << F) >> gear; unused for F = 0
    input  logic [  POINTER_WIDTH-1:0] pointer_i,
    input  logic [CONFIDENCE_BITS-1:0] confidence_i,
    output logic [  POINTER_WIDTH-1:0] pointer_o,
    output logic [CONFIDENCE_BITS-1:0] confidence_o
);

  localparam int NEAR_BITS = (POINTER_WIDTH < 5) ? POINTER_WIDTH : 5;

  logic [POINTER_WIDTH-1:0] target, difference, step, up, down;
  logic low_equal, equal, left;

  assign target = POINTER_WIDTH'(timestamp_i) << FRACTION_BITS;
  // A constant for F = 0: synthesis of a column alone cannot see that the port never changes.
  assign step = (FRACTION_BITS == 0) ? POINTER_WIDTH'(POINTER_STEP) : POINTER_WIDTH'(step_i);
  assign difference = target - pointer_i;
  assign up = pointer_i + step;
  assign down = pointer_i - step;

  // d = half the range, the opposite point, has only its top bit set and counts as p + step.
  assign low_equal = (target[POINTER_WIDTH-2:0] == pointer_i[POINTER_WIDTH-2:0]);
  assign equal = low_equal && (target[POINTER_WIDTH-1] == pointer_i[POINTER_WIDTH-1]);
  assign left = difference[POINTER_WIDTH-1] && !low_equal;

  always_comb begin
    pointer_o = pointer_i;
    if (hit_i && !equal) begin
      pointer_o = left ? down : up;
    end
  end

  generate
    if (CONFIDENCE_WIDTH > 0) begin : g_confidence
      logic near, far;
      assign near = (&difference[POINTER_WIDTH-1-:NEAR_BITS]) || !(|difference[POINTER_WIDTH-1-:NEAR_BITS]);
      assign far = !near && (timestamp_i[2:0] == 3'd0);
      always_comb begin
        confidence_o = confidence_i;
        if (hit_i && near && (confidence_i != '1)) begin
          confidence_o = confidence_i + 1'b1;
        end else if (hit_i && far && (confidence_i != '0)) begin
          confidence_o = confidence_i - 1'b1;
        end
      end
    end else begin : g_no_confidence
      assign confidence_o = confidence_i;
    end
  endgenerate

endmodule

`default_nettype wire
