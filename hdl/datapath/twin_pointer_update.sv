// SPDX-License-Identifier: Apache-2.0
// A pixel's pointer word after one timestamp: leader's and rival's pointers, advantage. Combinational.
//
// Equation (docs/reference/poolpointer.md, Point): in reach the pointer moves by (2^gear weight + dither) >> 2 units
// of 2^-11 coarse bin towards the timestamp, rounded down to the pointer's unit u; dither = (a mod 4) u +
// (a >> 2) mod u. Hits raise the advantage n, the rival's hits lower it and at n = 0 change roles.
// RIVAL_MOVES = 1: both pointers are absolute and the rival follows its hits in cells, quarters of a coarse bin.
// RIVAL_MOVES = 0: the pointer is relative to candidate a, the rival is candidate b.
// Cost: an adder of the pointer's width, a shifter; about 25 gate delays.
module twin_pointer_update #(
    parameter int LABELS = 5,
    parameter int ADVANTAGE_WIDTH = 7,  // 7, or 4 with the short gears, multiples of u
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES),
    localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES)
) (
    input  logic [POINT_WIDTH-1:0] word_i,        // {advantage, rival, pointer}
    input  logic                   reach_i,
    input  logic                   up_i,
    input  logic [            2:0] weight_i,
    input  logic [            3:0] gear_i,
    input  logic                   hit_i,
    input  logic                   rival_hit_i,
    input  logic                   rival_up_i,
    input  logic                   rival_down_i,
    input  logic [            3:0] acquisition_i,  // mod 16
    output logic [POINT_WIDTH-1:0] word_o
);

  // Bits of a move below the pointer's unit, which decide with the dither whether it goes one farther.
  localparam int BELOW_UNIT = (ADVANTAGE_WIDTH == 4) ? 0 : POINTER_SHIFT;
  localparam int MOVE_WIDTH = ((ADVANTAGE_WIDTH == 4) ? 10 : 9) - POINTER_SHIFT;
  localparam int PRODUCT_WIDTH = MOVE_WIDTH + BELOW_UNIT + 2;

  logic [ADVANTAGE_WIDTH-1:0] advantage, next_advantage;
  logic [POINTER_WIDTH-1:0] pointer, moved, swapped;
  logic [MOVE_WIDTH-1:0] move;
  logic carry, counted, swap;

  assign pointer = word_i[POINTER_WIDTH-1:0];
  assign advantage = word_i[POINT_WIDTH-1-:ADVANTAGE_WIDTH];

  logic [PRODUCT_WIDTH-1:0] product;
  logic [BELOW_UNIT+1:0] dither;
  generate
    if (BELOW_UNIT == 0) begin : g_dither
      assign dither = acquisition_i[1:0];
    end else begin : g_long_dither
      assign dither = {acquisition_i[1:0], acquisition_i[2+:BELOW_UNIT]};
    end
  endgenerate
  // The dither only matters by its carry, which the pointer's adder takes along.
  logic [BELOW_UNIT+2:0] below;
  assign product = PRODUCT_WIDTH'(weight_i) << gear_i;
  assign below = {1'b0, product[BELOW_UNIT+1:0]} + {1'b0, dither};
  assign carry = below[BELOW_UNIT+2];
  assign move = product[BELOW_UNIT+2+:MOVE_WIDTH];

  logic unused_bits;
  assign unused_bits = ^{product, below};

  generate
    if (RIVAL_MOVES != 0) begin : g_moving_rival
      logic [dtof_pkg::POOL_RIVAL_WIDTH-1:0] rival, next_rival;
      logic [POINTER_WIDTH:0] sum, step;
      logic [dtof_pkg::POOL_RIVAL_WIDTH-1:0] coarse_pointer;

      assign coarse_pointer = pointer[POINTER_WIDTH-1-:dtof_pkg::POOL_RIVAL_WIDTH];
      assign rival = word_i[POINTER_WIDTH+:dtof_pkg::POOL_RIVAL_WIDTH];
      // One adder: down by move + carry is up by its complement. Saturates at both ends of the range.
      assign step = (POINTER_WIDTH + 1)'(move) ^ {(POINTER_WIDTH + 1) {!up_i}};
      assign sum = {1'b0, pointer} + step + (POINTER_WIDTH + 1)'(carry == up_i);
      assign moved = sum[POINTER_WIDTH] ? {POINTER_WIDTH{up_i}} : sum[POINTER_WIDTH-1:0];
      logic [dtof_pkg::POOL_RIVAL_WIDTH-1:0] rival_step;  // 1, 0, -1
      assign rival_step = {{(dtof_pkg::POOL_RIVAL_WIDTH - 1) {rival_hit_i && rival_down_i}},
                           rival_hit_i && (rival_up_i || rival_down_i)};
      assign next_rival = swap ? coarse_pointer : rival + rival_step;
      assign swapped = {rival, 1'b1, {(POINTER_WIDTH - 1 - dtof_pkg::POOL_RIVAL_WIDTH) {1'b0}}};
      assign word_o[POINTER_WIDTH+:dtof_pkg::POOL_RIVAL_WIDTH] = next_rival;
    end else begin : g_resting_rival
      localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS);
      localparam int SUM_WIDTH = dtof_pkg::max_of(POINTER_WIDTH, MOVE_WIDTH + 2) + 1;
      logic [LABEL_WIDTH-1:0] leader, rival;
      logic signed [SUM_WIDTH-1:0] start, step, sum, limited;
      localparam logic signed [SUM_WIDTH-1:0] HIGHEST = SUM_WIDTH'((1 << (POINTER_WIDTH - 1)) - 1);

      assign leader = word_i[POINTER_WIDTH+:LABEL_WIDTH];
      assign rival = word_i[POINTER_WIDTH+LABEL_WIDTH+:LABEL_WIDTH];
      assign start = $signed({{(SUM_WIDTH - POINTER_WIDTH) {pointer[POINTER_WIDTH-1]}}, pointer});
      assign step = $signed({{(SUM_WIDTH - MOVE_WIDTH) {1'b0}}, move} ^ {SUM_WIDTH{!up_i}});
      assign sum = start + step + $signed(SUM_WIDTH'(carry == up_i));
      assign limited = (sum > HIGHEST) ? HIGHEST : (sum < ~HIGHEST) ? ~HIGHEST : sum;
      assign moved = POINTER_WIDTH'(limited);
      logic unused_limited;
      assign unused_limited = ^limited;
      assign swapped = '0;
      assign word_o[POINTER_WIDTH+:LABEL_WIDTH] = swap ? rival : leader;
      assign word_o[POINTER_WIDTH+LABEL_WIDTH+:LABEL_WIDTH] = swap ? leader : rival;
      logic unused_rival;
      assign unused_rival = ^{rival_up_i, rival_down_i};
    end
  endgenerate

  // Counts beyond half of the range are slowed down.
  assign counted = !advantage[ADVANTAGE_WIDTH-1]
      || ((acquisition_i[1:0] == 2'd0) && (!advantage[ADVANTAGE_WIDTH-2] || acquisition_i[3:2] == 2'd0));
  assign swap = rival_hit_i && (advantage == '0);

  // 1, 0, -1: a swap comes with n = 0, after which it is 1. There is no hit of both.
  logic gain, loss;
  assign gain = (hit_i && counted && (advantage != '1)) || swap;
  assign loss = rival_hit_i && counted && !swap;
  assign next_advantage = advantage + {{(ADVANTAGE_WIDTH - 1) {loss}}, gain || loss};

  assign word_o[POINTER_WIDTH-1:0] = swap ? swapped : (reach_i ? moved : pointer);
  assign word_o[POINT_WIDTH-1-:ADVANTAGE_WIDTH] = next_advantage;

endmodule
