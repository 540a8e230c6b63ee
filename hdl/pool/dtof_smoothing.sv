// SPDX-License-Identifier: Apache-2.0
// poolPointer: moves a column's positions closer together: in choose where the leaders' pointers start, in decide the
// winners (S1), of which it also makes the result word, with a confidence
// from outside (dtof_pool_confidence, or start_margin_o).
//
// Equations (docs/reference/poolpointer.md, Choose and Decide): with c the position in a row and x, y, z those in the rows
// above and below and in the column to the left, c + ((|x - c| <= T ? x - c : 0) + (|y - c| <= T ? y - c : 0)
// + (|z - c| <= T ? z - c : 0)) / 4, rounded towards zero. T is 1024 in dark groups, 1536 in bright ones, 2048 for long
// pulses. A winner's result is that less half a bin, limited to what a code and a fraction can say.
//
// 1. Positions of a column enter from its first row on, after the last one an entry that is none: the row in the middle is
//    the one that moves.
// 2. The distances to its neighbours are found, then a quarter of their sum, then the start or the result.
// 3. With SECOND_TARGET = 1 the positions that lost come along, and leave as they are, but limited in the same way.
//
// Schedule: take_distances_i a clock after take_position_i or later; two clocks after that start_o is there, until the next
//   take_position_i, and take_result_i may be given; result_o from a clock after take_result_i until the next one.
// Cost: five positions, two with margins, six adders, per engine; with SECOND_TARGET = 1 two more positions, an adder.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_smoothing #(
    parameter int NP = 10,
    parameter int CONFIDENCE_WIDTH = 8,
    parameter int CELL_SHIFT = 9,
    parameter int SECOND_TARGET = 0,
    localparam int RESULT_WIDTH = ((SECOND_TARGET != 0) ? 32 : 16) + CONFIDENCE_WIDTH
) (
    input  logic                        clk_i,
    input  logic                        rst_ni,
    input  logic                        starts_i,          // positions are starts, otherwise winners
    input  logic                        smooth_i,          // 0: winners stay where they are
    input  logic                        has_left_i,        // there is a column to the left
    input  logic                        take_position_i,
    input  logic                        has_position_i,    // with take_position_i; 0 ends the column
    input  logic [                15:0] position_i,
    input  logic [                15:0] left_i,            // what the scratch memory has of the column to the left in that row
    input  logic [                15:0] left_position_i,   // what left_o says: the position there, before it moved
    output logic [                15:0] left_o,            // left_i, registered with take_position_i
    input  logic [                15:0] lost_position_i,   // with SECOND_TARGET = 1: of the label that lost
    input  logic [CONFIDENCE_WIDTH-1:0] margin_i,
    input  logic [CONFIDENCE_WIDTH-1:0] confidence_i,      // of the row in the middle, with take_result_i
    output logic [                 2:0] near_o,            // {left, below, above}: within T of the row in the middle
    input  logic                        bright_i,          // its group is bright
    input  logic                        take_distances_i,
    output logic [                15:0] start_o,
    output logic [CONFIDENCE_WIDTH-1:0] start_margin_o,
    input  logic                        take_result_i,
    output logic [    RESULT_WIDTH-1:0] result_o           // {code, fraction, confidence}, SECOND_TARGET = 1:
                                                           // {second code, second fraction, code, ...}
);

  localparam int F = 16 - NP;
  localparam logic signed [16:0] DARK_REACH = (CELL_SHIFT > 9) ? 17'd2048 : 17'd1024;
  localparam logic signed [16:0] BRIGHT_REACH = (CELL_SHIFT > 9) ? 17'd2048 : 17'd1536;
  localparam int DISTANCE_WIDTH = (CELL_SHIFT > 9) ? 13 : 12;  // within T
  localparam int SUM_WIDTH = DISTANCE_WIDTH + 2;
  localparam logic signed [17:0] HALF_BIN = 18'((1 << F) / 2);
  localparam logic signed [17:0] LAST_POSITION = 18'(65536 - (1 << F) - 1);

  logic above_valid_q, centre_valid_q, below_valid_q, centre_bright_q, below_bright_q;
  logic [15:0] above_q, centre_q, below_q, centre_left_q, below_left_q;
  logic [CONFIDENCE_WIDTH-1:0] centre_margin_q, below_margin_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      above_valid_q <= 1'b0;
      centre_valid_q <= 1'b0;
      below_valid_q <= 1'b0;
    end else if (take_position_i) begin
      above_valid_q <= centre_valid_q;
      centre_valid_q <= below_valid_q;
      below_valid_q <= has_position_i;
    end
  end

  always_ff @(posedge clk_i) begin
    if (take_position_i) begin
      above_q <= centre_q;
      centre_q <= below_q;
      below_q <= position_i;
      centre_left_q <= left_position_i;
      below_left_q <= left_i;
      {centre_margin_q, centre_bright_q} <= {below_margin_q, below_bright_q};
      {below_margin_q, below_bright_q} <= {margin_i, bright_i};
    end
  end

  assign left_o = below_left_q;

  // What a neighbour contributes.

  logic signed [16:0] reach;
  logic moves;
  logic [DISTANCE_WIDTH-1:0] from_above, from_below, from_left;

  assign reach = centre_bright_q ? BRIGHT_REACH : DARK_REACH;
  assign moves = starts_i || smooth_i;

  logic signed [16:0] above_distance, below_distance, left_distance;
  logic [2:0] near;

  function automatic logic is_near(input logic signed [16:0] distance, input logic signed [16:0] most);
    is_near = (distance <= most) && (distance >= -most);
  endfunction

  assign above_distance = $signed({1'b0, above_q}) - $signed({1'b0, centre_q});
  assign below_distance = $signed({1'b0, below_q}) - $signed({1'b0, centre_q});
  assign left_distance = $signed({1'b0, centre_left_q}) - $signed({1'b0, centre_q});
  assign near = {has_left_i && is_near(left_distance, reach), below_valid_q && is_near(below_distance, reach),
                 above_valid_q && is_near(above_distance, reach)};
  assign from_above = above_distance[DISTANCE_WIDTH-1:0] & {DISTANCE_WIDTH{moves && near[0]}};
  assign from_below = below_distance[DISTANCE_WIDTH-1:0] & {DISTANCE_WIDTH{moves && near[1]}};
  assign from_left = left_distance[DISTANCE_WIDTH-1:0] & {DISTANCE_WIDTH{moves && near[2]}};

  // A quarter of the sum, rounded towards zero.

  logic signed [DISTANCE_WIDTH-1:0] from_above_q, from_below_q, from_left_q;
  logic signed [SUM_WIDTH-1:0] sum, rounded;
  logic signed [SUM_WIDTH-3:0] quarter_q;
  logic taken_q;
  logic signed [17:0] position_q, smoothed;
  logic [15:0] limited;

  assign sum = $signed({{2{from_above_q[DISTANCE_WIDTH-1]}}, from_above_q})
      + $signed({{2{from_below_q[DISTANCE_WIDTH-1]}}, from_below_q})
      + $signed({{2{from_left_q[DISTANCE_WIDTH-1]}}, from_left_q});
  assign rounded = sum + $signed({{(SUM_WIDTH - 2) {1'b0}}, {2{sum[SUM_WIDTH-1]}}});
  assign smoothed = position_q + $signed({{(20 - SUM_WIDTH) {quarter_q[SUM_WIDTH-3]}}, quarter_q});
  assign limited = (smoothed < 0) ? '0 : (smoothed > LAST_POSITION) ? 16'(LAST_POSITION) : smoothed[15:0];

  always_ff @(posedge clk_i) begin
    if (take_distances_i) begin
      near_o <= near;
      from_above_q <= $signed(from_above);
      from_below_q <= $signed(from_below);
      from_left_q <= $signed(from_left);
      position_q <= $signed({2'b00, centre_q}) - (starts_i ? 18'sd0 : HALF_BIN);
    end
    taken_q <= take_distances_i;
    if (taken_q) begin
      quarter_q <= rounded[SUM_WIDTH-1:2];
    end
  end

  // A start is between its neighbours, so that it needs no limits.
  assign start_o = smoothed[15:0];
  assign start_margin_o = centre_margin_q;

  // The result, and with it the position that lost, which is as many rows behind as the winner.

  generate
    if (SECOND_TARGET != 0) begin : g_second_target
      logic [15:0] centre_lost_q, below_lost_q, lost_limited;
      logic signed [17:0] lost_shifted;
      assign lost_shifted = $signed({2'b00, centre_lost_q}) - HALF_BIN;
      assign lost_limited = (lost_shifted < 0) ? '0
          : (lost_shifted > LAST_POSITION) ? 16'(LAST_POSITION) : lost_shifted[15:0];
      always_ff @(posedge clk_i) begin
        if (take_position_i) begin
          centre_lost_q <= below_lost_q;
          below_lost_q <= lost_position_i;
        end
        if (take_result_i) begin
          result_o <= {lost_limited, limited, confidence_i};
        end
      end
    end else begin : g_one_target
      logic unused_position;
      assign unused_position = ^lost_position_i;
      always_ff @(posedge clk_i) begin
        if (take_result_i) begin
          result_o <= {limited, confidence_i};
        end
      end
    end
  endgenerate

  logic unused;
  assign unused = ^{1'b0, centre_valid_q, rounded[1:0], above_distance, below_distance, left_distance};

endmodule

`default_nettype wire
