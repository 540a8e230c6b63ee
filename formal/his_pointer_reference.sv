// SPDX-License-Identifier: Apache-2.0
// Reference of hisPointer for a pixel and a frame (docs/reference/readouts.md, Eq. 3.13), in 32-bit integers.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module his_pointer_reference #(
    parameter int NP = 3,
    parameter int NB = 1,
    parameter int SIDE_BAND = 2,
    parameter int COUNT_WIDTH = 2,
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
  localparam int BINS = 1 << NB;
  localparam int FULL = (1 << COUNT_WIDTH) - 1;
  localparam int FIRST_LENGTH = ACQUISITIONS / 2;
  localparam int LENGTH = ACQUISITIONS - FIRST_LENGTH;  // of measurement 2

  logic [BINS*COUNT_WIDTH-1:0] counts_q;
  logic frozen;
  logic signed [31:0] centre, from_centre;
  logic [31:0] peak, highest, bin;

  integer b;
  always_comb begin
    peak = 32'd0;
    highest = 32'd0;
    frozen = 1'b0;
    for (b = 0; b < BINS; b = b + 1) begin
      if (32'(counts_q[b*COUNT_WIDTH+:COUNT_WIDTH]) > highest) begin
        peak = 32'(b);
        highest = 32'(counts_q[b*COUNT_WIDTH+:COUNT_WIDTH]);
      end
      if (32'(counts_q[b*COUNT_WIDTH+:COUNT_WIDTH]) == 32'(FULL)) begin
        frozen = 1'b1;
      end
    end
    bin = timestamp_i >> (NP - NB);
    centre = (peak << (NP - NB)) + ((1 << (NP - NB)) >> 1);
    from_centre = timestamp_i - centre;
  end

  // The pointer is relative to its start until the frame's end.
  logic [31:0] moved_q, confidence_q;
  logic [31:0] pointer, moved, confidence, d, step, acquisition;
  logic near, first, kept;

  integer g;
  always_comb begin
    acquisition = acquisition_i - 32'(FIRST_LENGTH);
    step = 32'd1 << FRACTION_BITS;
    for (g = 1; g <= FRACTION_BITS; g = g + 1) begin
      if (acquisition >= 32'(LENGTH - (LENGTH >> g))) begin
        step = (32'd1 << FRACTION_BITS) >> g;
      end
    end
    first = acquisition_i < 32'(FIRST_LENGTH);
    kept = from_centre > -SIDE_BAND && from_centre <= SIDE_BAND;
    pointer = ((centre << FRACTION_BITS) + moved_q) & 32'(RANGE - 1);
    d = ((timestamp_i << FRACTION_BITS) - pointer) & 32'(RANGE - 1);
    near = (d < 32'(NEAR_RANGE)) || (d >= 32'(RANGE - NEAR_RANGE));
    moved = moved_q;
    if (d >= 32'd1 && d <= 32'(RANGE / 2)) begin
      moved = (moved_q + step) & 32'(RANGE - 1);
    end else if (d > 32'(RANGE / 2)) begin
      moved = (moved_q - step) & 32'(RANGE - 1);
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
      counts_q <= '0;
      moved_q <= 32'd0;
      confidence_q <= 32'd0;
    end else if (take_i && timestamp_i != 32'((1 << NP) - 1)) begin
      if (first) begin
        for (b = 0; b < BINS; b = b + 1) begin
          if (bin == 32'(b) && !frozen) begin
            counts_q[b*COUNT_WIDTH+:COUNT_WIDTH] <= counts_q[b*COUNT_WIDTH+:COUNT_WIDTH] + 1'b1;
          end
        end
      end else if (kept) begin
        moved_q <= moved;
        confidence_q <= confidence;
      end
    end
  end

  assign position_o = pointer;
  assign confidence_o = confidence_q;

endmodule

`default_nettype wire
