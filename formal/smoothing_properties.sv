// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_smoothing: starts, S1 and the result word, for positions in three rows and one position to the left, each of which may
// be missing except the middle row, follow docs/reference/poolpointer.md, Choose and Decide, step by step on integers. The positions are
// constants; the initial registers are free.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module smoothing_properties #(
    parameter int NP = 10,
    parameter int CELL_SHIFT = 9,
    parameter int SECOND_TARGET = 0,
    localparam int F = 16 - NP
) (
    input logic clk_i,
    input logic smooth_i
);

  localparam int CONFIDENCE_WIDTH = 8;

  (* anyconst *) logic [47:0] positions;  // of the rows above, in the middle and below
  (* anyconst *) logic [47:0] left;  // in the column to the left, for each row
  (* anyconst *) logic [47:0] lost;
  (* anyconst *) logic [2:0] has;
  (* anyconst *) logic [3*CONFIDENCE_WIDTH-1:0] margins;
  (* anyconst *) logic [2:0] bright;
  (* anyconst *) logic smooth, starts, has_left;
  (* anyconst *) logic [CONFIDENCE_WIDTH-1:0] confidence;
  logic [15:0] start, left_registered;
  logic [2:0] near, expected_near;
  logic [CONFIDENCE_WIDTH-1:0] start_margin;
  logic [3:0] t_q = 4'd0;
  logic checking;
  logic [1:0] row;
  logic [((SECOND_TARGET != 0) ? 32 : 16)+CONFIDENCE_WIDTH-1:0] result;

  assign checking = (t_q != 4'd0);
  assign row = 2'(t_q - 4'd1);

  always_ff @(posedge clk_i) begin
    t_q <= (t_q == 4'd8) ? t_q : t_q + 4'd1;
  end

  dtof_smoothing #(
      .NP              (NP),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .CELL_SHIFT      (CELL_SHIFT),
      .SECOND_TARGET   (SECOND_TARGET)
  ) u_dut (
      .clk_i           (clk_i),
      .rst_ni          (checking),
      .starts_i        (starts),
      .smooth_i        (smooth_i),
      .has_left_i      (has_left),
      .take_position_i (t_q >= 4'd1 && t_q <= 4'd3),
      .has_position_i  (has[row]),
      .position_i      (positions[row*16+:16]),
      .left_i          (left[row*16+:16]),
      .left_position_i (left_registered),
      .left_o          (left_registered),
      .lost_position_i (lost[row*16+:16]),
      .confidence_i    (confidence),
      .near_o          (near),
      .margin_i        (margins[row*CONFIDENCE_WIDTH+:CONFIDENCE_WIDTH]),
      .bright_i        (bright[row]),
      .take_distances_i(t_q == 4'd4),
      .start_o         (start),
      .start_margin_o  (start_margin),
      .take_result_i   (t_q == 4'd6),
      .result_o        (result)
  );

  integer centre, neighbour, reach, sum, moved, word, lost_word;
  integer i;

  always_comb begin
    centre = 32'(positions[31:16]);
    reach = (CELL_SHIFT == 10) ? 2048 : (bright[1] && 32'(margins[CONFIDENCE_WIDTH+:CONFIDENCE_WIDTH]) < 64) ? 1536 : 1024;
    sum = 0;
    expected_near = 3'b000;
    for (i = 0; i <= 2; i = i + 1) begin  // above, below, to the left
      neighbour = (i == 2) ? 32'(left[31:16]) : 32'(positions[i*32+:16]);
      if (((i == 2) ? has_left : has[i*2]) && neighbour - centre <= reach && centre - neighbour <= reach) begin
        expected_near[i] = 1'b1;
        sum = (smooth || starts) ? sum + neighbour - centre : 0;
      end
    end
    // Rounded towards zero.
    moved = centre + ((sum >= 0) ? sum / 4 : -((-sum) / 4));
    word = moved - (1 << F) / 2;
    if (word < 0) word = 0;
    if (word > 65536 - (1 << F) - 1) word = 65536 - (1 << F) - 1;
    // The position that lost is not smoothed.
    lost_word = 32'(lost[31:16]) - (1 << F) / 2;
    if (lost_word < 0) lost_word = 0;
    if (lost_word > 65536 - (1 << F) - 1) lost_word = 65536 - (1 << F) - 1;
  end

  `ASSUME(m_the_middle_one, has[1])
  `ASSUME(m_one_mode, smooth_i == smooth)
  `PROVE(a_start, t_q != 4'd6 || !starts || (start == moved[15:0] && start_margin == margins[CONFIDENCE_WIDTH+:CONFIDENCE_WIDTH]))
  `PROVE(a_result, t_q != 4'd7 || starts
         || result[16+CONFIDENCE_WIDTH-1:0] == {word[15:0], confidence})
  `PROVE(a_near, t_q != 4'd5 || near == expected_near)
  `PROVE(a_second, t_q != 4'd7 || starts || SECOND_TARGET == 0 || 16'(result >> (16 + CONFIDENCE_WIDTH)) == lost_word[15:0])
  `GOAL(t_q == 4'd7 && !starts && smooth && has == 3'b111 && has_left && sum < -2600)

endmodule

`default_nettype wire
