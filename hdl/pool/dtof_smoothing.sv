// SPDX-License-Identifier: Apache-2.0
// poolPointer: moves the positions of a column closer to those of their neighbours: in choose the starts of the leaders' pointers, in
// decide the winners (S1). In decide the module also makes the result word, with the confidence of dtof_pool_confidence
// or, without significances, start_margin_o.
//
// Equations (docs/reference/poolpointer.md, Choose and Decide): c is the position in a row; x, y and z are the positions in the rows
// above and below and in the column to the left. The new position is c + ((|x - c| <= T ? x - c : 0) + (|y - c| <= T ? y - c : 0)
// + (|z - c| <= T ? z - c : 0)) / 4, rounded towards zero. T is 1536 in bright groups if the margin is below 64, otherwise 1024; with
// CELL_SHIFT = 10 T is always 2048. The result is the new position minus half a bin, limited to the range of code and fraction.
//
// 1. take_position_i shifts a column's positions through three registers (above, centre, below), from the first row to the last;
//    after the last row one shift without a position follows. The row in the centre is the one that moves.
// 2. take_distances_i registers the distances to the three neighbours; the next clock registers a quarter of their sum.
// 3. With SECOND_TARGET = 1 the positions that lost the decision move along; they are limited in the same way, but not smoothed.
//
// Schedule: take_distances_i one clock after take_position_i or later. start_o is valid from two clocks after take_distances_i until
//   the next take_position_i; take_result_i may be given in the same time.
// Latency: 2 clocks from take_distances_i to start_o; 1 clock from take_result_i to result_o, which holds until the next take_result_i.
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
    input  logic                        starts_i,          // 1: positions are starts (choose); 0: winners (decide)
    input  logic                        smooth_i,          // 0: winners are not smoothed
    input  logic                        has_left_i,        // a column to the left exists
    input  logic                        take_position_i,
    input  logic                        has_position_i,    // with take_position_i; 0 in the shift after the last row
    input  logic [                15:0] position_i,
    input  logic [                15:0] left_i,            // word of the scratch memory for this row of the column to the left
    input  logic [                15:0] left_position_i,   // position that left_o stands for: of the column to the left, not smoothed
    output logic [                15:0] left_o,            // left_i, registered with take_position_i
    input  logic [                15:0] lost_position_i,   // with SECOND_TARGET = 1: position of the label that lost
    input  logic [CONFIDENCE_WIDTH-1:0] margin_i,
    input  logic [CONFIDENCE_WIDTH-1:0] confidence_i,      // with take_result_i: confidence of the row in the centre
    output logic [                 2:0] near_o,            // {left, below, above}: within T of the position in the centre
    input  logic                        bright_i,          // the group of position_i is bright
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
  localparam int DISTANCE_WIDTH = (CELL_SHIFT > 9) ? 13 : 12;  // bits of a distance within T
  localparam int SUM_WIDTH = DISTANCE_WIDTH + 2;
  localparam logic signed [17:0] HALF_BIN = 18'((1 << F) / 2);
  localparam logic signed [17:0] LAST_POSITION = 18'(65536 - (1 << F) - 1);

  // A winner with such a margin lies on its pulse, so a small T suffices. A start's margin is below 64.
  localparam int SETTLED_BIT = 6;
  logic settled;
  assign settled = (margin_i >> SETTLED_BIT) != '0;

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
      {below_margin_q, below_bright_q} <= {margin_i, bright_i && !settled};
    end
  end

  assign left_o = below_left_q;

  // Distances to the neighbours; those that are too far, or to be ignored, become 0.

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

  // A quarter of the sum of distances, rounded towards zero.

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

  // A start moves towards its neighbours, so it stays within the range and needs no limit.
  assign start_o = smoothed[15:0];
  assign start_margin_o = centre_margin_q;

  // Result, and the position that lost, delayed by as many rows as the winner.

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
