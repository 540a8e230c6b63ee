// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pool_confidence: the confidence of the middle row of three follows docs/reference/poolpointer.md, Confidence, on integers.
// The values of the rows are constants; the initial registers are free.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_confidence_properties #(
    parameter int KEPT_WIDTH = 3
) (
    input logic clk_i,
    input logic [2:0] other_near_i
);

  localparam int CONFIDENCE_WIDTH = 8;

  (* anyconst *) logic [3*CONFIDENCE_WIDTH-1:0] margins, left_margins;  // of the rows above, in the middle and below
  (* anyconst *) logic [3*KEPT_WIDTH-1:0] significances;
  (* anyconst *) logic [2:0] tilted, near;
  (* anyconst *) logic [11:0] skies;
  logic [CONFIDENCE_WIDTH-1:0] confidence;
  logic [3:0] t_q = 4'd0;
  logic [1:0] row;
  logic checking;

  assign checking = (t_q != 4'd0);
  assign row = 2'(t_q - 4'd1);

  always_ff @(posedge clk_i) begin
    t_q <= (t_q == 4'd8) ? t_q : t_q + 4'd1;
  end

  dtof_pool_confidence #(
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .KEPT_WIDTH      (KEPT_WIDTH)
  ) u_dut (
      .clk_i           (clk_i),
      .take_position_i (t_q >= 4'd1 && t_q <= 4'd3),
      .margin_i        (margins[row*CONFIDENCE_WIDTH+:CONFIDENCE_WIDTH]),
      .left_margin_i   (left_margins[row*CONFIDENCE_WIDTH+:CONFIDENCE_WIDTH]),
      .significance_i  (significances[row*KEPT_WIDTH+:KEPT_WIDTH]),
      .tilted_i        (tilted[row]),
      .sky_i           (skies[row*4+:4]),
      .take_distances_i(t_q == 4'd4),
      .near_i          ((t_q == 4'd5) ? near : other_near_i),
      .confidence_o    (confidence)
  );

  integer own, weight, mean, first, second, excess, part, expected;
  logic [3:0] sky;
  logic [KEPT_WIDTH-1:0] z;

  assign sky = skies[7:4];
  assign z = significances[KEPT_WIDTH+:KEPT_WIDTH];

  always_comb begin
    own = 32'(margins[CONFIDENCE_WIDTH+:CONFIDENCE_WIDTH]);
    weight = 64;
    if (KEPT_WIDTH == 3) begin
      weight = (32'(z) == 0) ? 0 : (32'(z) == 1) ? 13 : (32'(z) == 2) ? 16 : (32'(z) == 3) ? 20 : (32'(z) == 4) ? 24
          : (32'(z) == 5) ? 29 : (32'(z) == 6) ? 35 : 64;
    end else begin
      weight = (32'(z) == 0) ? 0 : (32'(z) == 1) ? 22 : (32'(z) == 2) ? 32 : 64;
    end
    weight = (weight > 4 * own) ? 4 * own : weight;
    mean = (sky == 0) ? 18 : (sky == 1) ? 10 : (sky == 2) ? 14 : (sky == 3) ? 22 : (sky == 4) ? 36 : (sky == 5) ? 64
        : (sky == 6) ? 128 : (sky == 7) ? 200 : 255;
    first = (sky <= 2) ? 4 : (sky <= 4) ? 8 : (sky <= 6) ? 16 : 32;
    second = (sky <= 1) ? 8 : (sky <= 3) ? 16 : (sky == 4 || sky == 6) ? 512 : 64;
    excess = own + (near[0] ? 32'(margins[CONFIDENCE_WIDTH-1:0]) : 0)
        + (near[1] ? 32'(margins[2*CONFIDENCE_WIDTH+:CONFIDENCE_WIDTH]) : 0)
        + (near[2] ? 32'(left_margins[CONFIDENCE_WIDTH+:CONFIDENCE_WIDTH]) : 0) - mean;
    excess = (excess < 0) ? 0 : excess;
    part = excess / first + excess / second;
    expected = weight + (tilted[1] ? 0 : (part > 127) ? 127 : part);
    expected = (own > 11 && expected < 12) ? 12 : expected;
  end

  `PROVE(a_confidence, t_q != 4'd6 || 32'(confidence) == expected)
  `GOAL(t_q == 4'd6 && expected == 137 && sky == 4'd5)

endmodule

`default_nettype wire
