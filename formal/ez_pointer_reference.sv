// SPDX-License-Identifier: Apache-2.0
// Reference of ezPointer for a pixel and a frame (docs/reference/readouts.md, Eq. 3.12), in 32-bit integers.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module ez_pointer_reference #(
    parameter int NP = 3,
    parameter int FRACTION_BITS = 0,
    parameter int CONFIDENCE_WIDTH = 2,
    parameter int ACQUISITIONS = 2
) (
    input  logic        clk_i,
    input  logic        rst_ni,
    input  logic        take_i,         // the source delivers a timestamp of this pixel for this frame
    input  logic [31:0] acquisition_i,
    input  logic [31:0] timestamp_i,
    output logic [31:0] position_o,
    output logic [31:0] confidence_o
);

  localparam int RANGE = 1 << (NP + FRACTION_BITS);
  localparam int NEAR_RANGE = (NP + FRACTION_BITS < 5) ? 1 : RANGE / 32;  // range in which the top bits of d are equal

  logic [31:0] pointer_q, confidence_q;
  logic [31:0] pointer, confidence, d, step;
  logic near;

  integer g;
  always_comb begin
    step = 32'd1 << FRACTION_BITS;
    for (g = 1; g <= FRACTION_BITS; g = g + 1) begin
      if (acquisition_i >= 32'(ACQUISITIONS - (ACQUISITIONS >> g))) begin
        step = (32'd1 << FRACTION_BITS) >> g;
      end
    end
    d = ((timestamp_i << FRACTION_BITS) - pointer_q) & 32'(RANGE - 1);
    near = (d < 32'(NEAR_RANGE)) || (d >= 32'(RANGE - NEAR_RANGE));
    pointer = pointer_q;
    if (d >= 32'd1 && d <= 32'(RANGE / 2)) begin
      pointer = (pointer_q + step) & 32'(RANGE - 1);
    end else if (d > 32'(RANGE / 2)) begin
      pointer = (pointer_q - step) & 32'(RANGE - 1);
    end
    confidence = confidence_q;
    if (near && confidence_q < 32'((1 << CONFIDENCE_WIDTH) - 1)) begin
      confidence = confidence_q + 32'd1;
    end else if (!near && timestamp_i[2:0] == 3'd0 && confidence_q > 32'd0) begin
      confidence = confidence_q - 32'd1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      pointer_q <= 32'(RANGE / 2);
      confidence_q <= 32'd0;
    end else if (take_i && timestamp_i != 32'((1 << NP) - 1)) begin
      pointer_q <= pointer;
      confidence_q <= confidence;
    end
  end

  assign position_o = pointer_q;
  assign confidence_o = confidence_q;

endmodule

`default_nettype wire
