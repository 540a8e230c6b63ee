// SPDX-License-Identifier: Apache-2.0
// A pixel's pointer word after one timestamp: leader's and rival's pointers, advantage. Combinational.
//
// Equation (docs/poolpointer.md, Point): with d = (X - leader's position) >> 9 the pointer moves by
// (2^gear(n) W[d] + a mod 4) >> 2 units towards the timestamp if -8 <= d < 8. -5 <= d < 5 is a hit, otherwise
// a timestamp near the rival is a rival's hit; hits raise n, rival's hits lower it and at n = 0 change roles.
// RIVAL_MOVES = 1: both pointers are absolute and the rival follows its hits in eighths of a coarse bin.
// RIVAL_MOVES = 0: the pointer is relative to candidate a, the rival is candidate b.
// Cost: two subtractors and an adder of the pointer's width, a shifter; about 30 gate delays.
module twin_pointer_update #(
    parameter int LABELS = 8,
    parameter int ADVANTAGE_WIDTH = 8,  // 8, or 4 with the short gears
    parameter int POINTER_SHIFT = 0,
    parameter int RIVAL_MOVES = 1,
    localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES),
    localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES)
) (
    input  logic [             POINT_WIDTH-1:0] word_i,         // {advantage, rival, pointer}
    input  logic                                valid_i,
    input  logic [                        15:0] position_i,     // X
    input  logic [                  LABELS-1:0] hits_i,         // used by RIVAL_MOVES = 0
    input  logic [dtof_pkg::POOL_CELL_WIDTH-1:0] leader_cell_i,  // used by RIVAL_MOVES = 0
    input  logic [                         1:0] dither_i,       // acquisition mod 4
    input  logic                                every_16_i,     // acquisition mod 16 = 0
    input  logic                                late_i,
    output logic [             POINT_WIDTH-1:0] word_o,
    output logic                                swap_o
);

  localparam int UNITS_WIDTH = 16 - POINTER_SHIFT;
  localparam int DISTANCE_WIDTH = UNITS_WIDTH + 2;
  localparam int CELL_SHIFT = 9 - POINTER_SHIFT;
  localparam int CELLS_WIDTH = DISTANCE_WIDTH - CELL_SHIFT;
  localparam int MOVE_WIDTH = (ADVANTAGE_WIDTH == 8) ? 9 : 10 - POINTER_SHIFT;
  localparam int GEAR_WIDTH = 4;
  localparam logic signed [CELLS_WIDTH-1:0] REACH = CELLS_WIDTH'(8);
  localparam logic signed [CELLS_WIDTH-1:0] NEAR = CELLS_WIDTH'(5);
  // 64 units of 2^-11 coarse bin.
  localparam logic [GEAR_WIDTH-1:0] LATE_GEAR = GEAR_WIDTH'(6 - POINTER_SHIFT);

  logic [ADVANTAGE_WIDTH-1:0] advantage, next_advantage;
  logic [POINTER_WIDTH-1:0] pointer, moved, swapped;
  logic signed [DISTANCE_WIDTH-1:0] distance;
  logic signed [CELLS_WIDTH-1:0] cells;
  logic [GEAR_WIDTH-1:0] gear_of_count, gear;
  logic [2:0] weight;
  logic [MOVE_WIDTH-1:0] move;
  logic reach, hit, rival_hit, counted, up;

  assign pointer = word_i[POINTER_WIDTH-1:0];
  assign advantage = word_i[POINT_WIDTH-1-:ADVANTAGE_WIDTH];
  assign cells = distance[DISTANCE_WIDTH-1:CELL_SHIFT];
  assign up = !cells[CELLS_WIDTH-1];
  assign reach = valid_i && (cells >= -REACH) && (cells < REACH);
  assign hit = valid_i && (cells >= -NEAR) && (cells < NEAR);

  logic [2:0] distance_index;
  assign distance_index = cells[2:0] ^ {3{cells[CELLS_WIDTH-1]}};
  always_comb begin
    case (distance_index)
      3'd0, 3'd7: weight = 3'd1;
      3'd1, 3'd6: weight = 3'd2;
      3'd2, 3'd5: weight = 3'd3;
      default: weight = 3'd4;
    endcase
  end

  generate
    if (ADVANTAGE_WIDTH == 8) begin : g_gear
      always_comb begin
        if (advantage >= 8'd216) gear_of_count = 4'd0;
        else if (advantage >= 8'd200) gear_of_count = 4'd1;
        else if (advantage >= 8'd160) gear_of_count = 4'd2;
        else if (advantage >= 8'd128) gear_of_count = 4'd3;
        else if (advantage >= 8'd64) gear_of_count = 4'd4;
        else if (advantage >= 8'd32) gear_of_count = 4'd5;
        else if (advantage >= 8'd16) gear_of_count = 4'd6;
        else if (advantage >= 8'd8) gear_of_count = 4'd7;
        else gear_of_count = 4'd8;
      end
    end else begin : g_short_gear
      always_comb begin
        if (advantage == 4'd15) gear_of_count = 4'(4 - POINTER_SHIFT);
        else if (advantage == 4'd14) gear_of_count = 4'(5 - POINTER_SHIFT);
        else if (advantage >= 4'd12) gear_of_count = 4'(6 - POINTER_SHIFT);
        else if (advantage >= 4'd8) gear_of_count = 4'(7 - POINTER_SHIFT);
        else if (advantage >= 4'd4) gear_of_count = 4'(8 - POINTER_SHIFT);
        else gear_of_count = 4'(9 - POINTER_SHIFT);
      end
    end
  endgenerate

  logic [MOVE_WIDTH+2:0] product;
  assign gear = (late_i && gear_of_count > LATE_GEAR) ? LATE_GEAR : gear_of_count;
  assign product = ((MOVE_WIDTH + 3)'(weight) << gear) + (MOVE_WIDTH + 3)'(dither_i);
  assign move = product[MOVE_WIDTH+1:2];

  logic unused_bits;
  assign unused_bits = ^{distance[CELL_SHIFT-1:0], product, position_i};

  generate
    if (RIVAL_MOVES != 0) begin : g_moving_rival
      logic [dtof_pkg::POOL_RIVAL_WIDTH-1:0] rival, next_rival;
      logic signed [dtof_pkg::POOL_RIVAL_WIDTH:0] rival_distance;
      logic [POINTER_WIDTH:0] sum;
      logic [dtof_pkg::POOL_RIVAL_WIDTH-1:0] coarse_pointer;

      assign coarse_pointer = pointer[POINTER_WIDTH-1-:dtof_pkg::POOL_RIVAL_WIDTH];
      assign rival = word_i[POINTER_WIDTH+:dtof_pkg::POOL_RIVAL_WIDTH];
      assign distance = $signed({2'b00, position_i[15:POINTER_SHIFT]}) - $signed({2'b00, pointer});
      assign rival_distance = $signed({1'b0, position_i[15:8]}) - $signed({1'b0, rival});
      assign rival_hit = valid_i && !hit && (rival_distance >= -9'sd10) && (rival_distance < 9'sd10);

      // Saturates at both ends of the range.
      assign sum = up ? {1'b0, pointer} + (POINTER_WIDTH + 1)'(move) : {1'b0, pointer} - (POINTER_WIDTH + 1)'(move);
      assign moved = sum[POINTER_WIDTH] ? {POINTER_WIDTH{up}} : sum[POINTER_WIDTH-1:0];
      always_comb begin
        next_rival = rival;
        if (swap_o) begin
          next_rival = coarse_pointer;
        end else if (rival_hit && rival_distance > 9'sd0) begin
          next_rival = rival + 1'b1;
        end else if (rival_hit && rival_distance < 9'sd0) begin
          next_rival = rival - 1'b1;
        end
      end
      assign swapped = {rival, 1'b1, {(POINTER_WIDTH - 1 - dtof_pkg::POOL_RIVAL_WIDTH) {1'b0}}};
      assign word_o[POINTER_WIDTH+:dtof_pkg::POOL_RIVAL_WIDTH] = next_rival;

      logic unused;
      assign unused = ^{1'b0, hits_i, leader_cell_i};
    end else begin : g_resting_rival
      localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS);
      localparam int SUM_WIDTH = dtof_pkg::max_of(POINTER_WIDTH, MOVE_WIDTH + 2) + 1;
      logic [LABEL_WIDTH-1:0] leader, rival;
      logic signed [SUM_WIDTH-1:0] start, step, sum, limited;
      localparam logic signed [SUM_WIDTH-1:0] HIGHEST = SUM_WIDTH'((1 << (POINTER_WIDTH - 1)) - 1);

      assign leader = word_i[POINTER_WIDTH+:LABEL_WIDTH];
      assign rival = word_i[POINTER_WIDTH+LABEL_WIDTH+:LABEL_WIDTH];
      assign distance = $signed({2'b00, position_i[15:POINTER_SHIFT]})
          - $signed({2'b00, leader_cell_i, {CELL_SHIFT{1'b0}}})
          - $signed({{(DISTANCE_WIDTH - POINTER_WIDTH) {pointer[POINTER_WIDTH-1]}}, pointer});
      assign rival_hit = valid_i && !hit && hits_i[rival];

      assign start = $signed({{(SUM_WIDTH - POINTER_WIDTH) {pointer[POINTER_WIDTH-1]}}, pointer});
      assign step = $signed({{(SUM_WIDTH - MOVE_WIDTH) {1'b0}}, move});
      assign sum = up ? start + step : start - step;
      assign limited = (sum > HIGHEST) ? HIGHEST : (sum < ~HIGHEST) ? ~HIGHEST : sum;
      assign moved = POINTER_WIDTH'(limited);
      logic unused_limited;
      assign unused_limited = ^limited;
      assign swapped = '0;
      assign word_o[POINTER_WIDTH+:LABEL_WIDTH] = swap_o ? rival : leader;
      assign word_o[POINTER_WIDTH+LABEL_WIDTH+:LABEL_WIDTH] = swap_o ? leader : rival;
    end
  endgenerate

  // Counts beyond half of the range are slowed down.
  assign counted = !advantage[ADVANTAGE_WIDTH-1]
      || ((dither_i == 2'd0) && (!advantage[ADVANTAGE_WIDTH-2] || every_16_i));
  assign swap_o = rival_hit && (advantage == '0);

  always_comb begin
    next_advantage = advantage;
    if (hit && counted && (advantage != '1)) begin
      next_advantage = advantage + 1'b1;
    end else if (swap_o) begin
      next_advantage = ADVANTAGE_WIDTH'(1);
    end else if (rival_hit && counted) begin
      next_advantage = advantage - 1'b1;
    end
  end

  assign word_o[POINTER_WIDTH-1:0] = swap_o ? swapped : (reach ? moved : pointer);
  assign word_o[POINT_WIDTH-1-:ADVANTAGE_WIDTH] = next_advantage;

endmodule
