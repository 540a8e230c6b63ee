// SPDX-License-Identifier: Apache-2.0
// poolPointer, decide: confidence of a result, in eighths of a standard deviation.
//
// Equation (docs/reference/poolpointer.md, Confidence): the sum of two parts. The first part is the weight of the winner's
// significance, at most four times the pixel's own margin. The second part takes the sum of the margins of the pixel and of its near
// neighbours above, below and to the left, subtracts the mean of such a sum in a sky with this background, and divides by a quarter of the
// sky's spread. If the background is tilted, the second part is 0. With an own margin of at least 12 the confidence is at least 12.
//
// 1. take_position_i shifts the rows of a column, with dtof_smoothing: the result is that of the row in the middle.
// 2. The clock after take_distances_i adds the near margins and subtracts the sky's mean.
// 3. The next clock has the confidence.
//
// Schedule: that of dtof_smoothing; near_i is valid one clock after take_distances_i. Latency: confidence_o is valid two clocks after
// take_distances_i, until the next row enters.
// Cost: five margins, six adders, about 85 flip-flops, per engine.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_confidence #(
    parameter int CONFIDENCE_WIDTH = 8,
    parameter int KEPT_WIDTH = 3,  // bits of a significance, 2 or 3
    localparam int SKY_WIDTH = dtof_pkg::POOL_SKY_WIDTH
) (
    input  logic                        clk_i,
    input  logic                        take_position_i,
    // row that enters below
    input  logic [CONFIDENCE_WIDTH-1:0] margin_i,
    input  logic [CONFIDENCE_WIDTH-1:0] left_margin_i,    // margin in the column to the left
    input  logic [      KEPT_WIDTH-1:0] significance_i,
    input  logic                        tilted_i,
    input  logic [       SKY_WIDTH-1:0] sky_i,            // background of its group, / 4
    input  logic                        take_distances_i,
    input  logic [                 2:0] near_i,           // {left, below, above}: this neighbour's margin counts
    output logic [CONFIDENCE_WIDTH-1:0] confidence_o
);

  localparam int POOLED_WIDTH = CONFIDENCE_WIDTH + 2;
  localparam int WEIGHT_WIDTH = 7;
  localparam int MOST_ABOVE = 127;
  localparam int CLEAR_MARGIN = 12;  // own margin from which the confidence has a least value: itself

  logic [CONFIDENCE_WIDTH-1:0] above_q, centre_q, below_q, left_q, below_left_q;
  logic [KEPT_WIDTH-1:0] significance_q, below_significance_q;
  logic tilted_q, below_tilted_q;
  logic [SKY_WIDTH-1:0] sky_q, below_sky_q;

  always_ff @(posedge clk_i) begin
    if (take_position_i) begin
      above_q <= centre_q;
      {centre_q, left_q, significance_q, tilted_q, sky_q} <= {below_q, below_left_q, below_significance_q, below_tilted_q,
                                                              below_sky_q};
      {below_q, below_left_q, below_significance_q, below_tilted_q, below_sky_q} <= {margin_i, left_margin_i, significance_i,
                                                                                     tilted_i, sky_i};
    end
  end

  // Sky: the mean of the margins, and the two shifts that divide the excess. The shifts are decoded one clock ahead.

  logic [7:0] mean;
  logic [3:0] first, first_q;    // [n]: the first part is the excess >> n + 2
  logic [3:0] second, second_q;  // [n]: the second part is the excess >> 3, 4, 6 or 9
  logic [POOLED_WIDTH-1:0] pooled, excess_q, first_part, second_part;

  // Tables are expressions, because Yosys makes a memory of a case with constants.
  assign mean = (sky_q == 4'd0) ? 8'd18 : (sky_q == 4'd1) ? 8'd10 : (sky_q == 4'd2) ? 8'd14 : (sky_q == 4'd3) ? 8'd22
      : (sky_q == 4'd4) ? 8'd36 : (sky_q == 4'd5) ? 8'd64 : (sky_q == 4'd6) ? 8'd128 : (sky_q == 4'd7) ? 8'd200 : 8'd255;
  assign first = {sky_q >= 4'd7, sky_q == 4'd5 || sky_q == 4'd6, sky_q == 4'd3 || sky_q == 4'd4, sky_q <= 4'd2};
  assign second = {sky_q == 4'd4 || sky_q == 4'd6, sky_q == 4'd5 || sky_q >= 4'd7, sky_q == 4'd2 || sky_q == 4'd3, sky_q <= 4'd1};

  assign first_part = ((excess_q >> 2) & {POOLED_WIDTH{first_q[0]}}) | ((excess_q >> 3) & {POOLED_WIDTH{first_q[1]}})
      | ((excess_q >> 4) & {POOLED_WIDTH{first_q[2]}}) | ((excess_q >> 5) & {POOLED_WIDTH{first_q[3]}});
  assign second_part = ((excess_q >> 3) & {POOLED_WIDTH{second_q[0]}}) | ((excess_q >> 4) & {POOLED_WIDTH{second_q[1]}})
      | ((excess_q >> 6) & {POOLED_WIDTH{second_q[2]}}) | ((excess_q >> 9) & {POOLED_WIDTH{second_q[3]}});

  // Weight of the significance, limited by the pixel's own margin.

  logic [WEIGHT_WIDTH-1:0] weight, weight_q;

  generate
    if (KEPT_WIDTH == 3) begin : g_three_bits
      assign weight = (significance_q == 3'd0) ? 7'd0 : (significance_q == 3'd1) ? 7'd13 : (significance_q == 3'd2) ? 7'd16
          : (significance_q == 3'd3) ? 7'd20 : (significance_q == 3'd4) ? 7'd24 : (significance_q == 3'd5) ? 7'd29
          : (significance_q == 3'd6) ? 7'd35 : 7'd64;
    end else begin : g_two_bits
      assign weight = (significance_q == 2'd0) ? 7'd0 : (significance_q == 2'd1) ? 7'd22 : (significance_q == 2'd2) ? 7'd32 : 7'd64;
    end
  endgenerate

  logic taken_q;
  logic [CONFIDENCE_WIDTH-1:0] above, below, left;
  logic [POOLED_WIDTH-1:0] sum;
  logic [WEIGHT_WIDTH-1:0] above_sky;
  logic clear_q;  // the own margin is clear, and there is no significance; with one the weight is above the least value
  logic is_less;

  assign above = above_q & {CONFIDENCE_WIDTH{near_i[0]}};
  assign below = below_q & {CONFIDENCE_WIDTH{near_i[1]}};
  assign left = left_q & {CONFIDENCE_WIDTH{near_i[2]}};
  assign pooled = (POOLED_WIDTH'(centre_q) + POOLED_WIDTH'(above)) + (POOLED_WIDTH'(below) + POOLED_WIDTH'(left));

  always_ff @(posedge clk_i) begin
    taken_q <= take_distances_i;
    if (taken_q) begin
      excess_q <= (pooled > POOLED_WIDTH'(mean)) ? pooled - POOLED_WIDTH'(mean) : '0;
      weight_q <= ((CONFIDENCE_WIDTH + 2)'({centre_q, 2'b00}) < (CONFIDENCE_WIDTH + 2)'(weight)) ? {centre_q[WEIGHT_WIDTH-3:0], 2'b00}
          : weight;
      clear_q <= significance_q == '0 && centre_q >= CONFIDENCE_WIDTH'(CLEAR_MARGIN);
      first_q <= first;
      second_q <= second;
    end
  end

  assign sum = first_part + second_part;
  assign above_sky = (sum > POOLED_WIDTH'(MOST_ABOVE)) ? WEIGHT_WIDTH'(MOST_ABOVE) : sum[WEIGHT_WIDTH-1:0];
  // With clear_q the weight is 0. The comparison does not wait for the last adder.
  assign is_less = tilted_q || sum < POOLED_WIDTH'(CLEAR_MARGIN);
  assign confidence_o = (is_less && clear_q) ? CONFIDENCE_WIDTH'(CLEAR_MARGIN)
      : CONFIDENCE_WIDTH'(weight_q) + (CONFIDENCE_WIDTH'(above_sky) & {CONFIDENCE_WIDTH{!tilted_q}});

endmodule

`default_nettype wire
