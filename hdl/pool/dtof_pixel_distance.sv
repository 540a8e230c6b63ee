// SPDX-License-Identifier: Apache-2.0
// poolPointer, track and point: distance of a timestamp from the position that a pixel's word stores. Combinational.
//
// Equations (docs/reference/poolpointer.md, Track and Point). X is the timestamp's position. Distances are rounded down to cells of 512
// positions; distances to a settled pointer (n >= 16; with 4 bits of n: n >= 12) are rounded down to cells of 2^CELL_SHIFT positions:
//   track  d = (X - C[leader] - 64 offset) >> 9. The offset goes up for 1 <= d < 8, down for -8 <= d < -1.
//   point  d = (X - pointer) >> 9 (settled: >> CELL_SHIFT). In reach for -8 <= d < 8, a hit for -5 <= d < 5. Without a hit the rival
//          is hit if -RIVAL_REACH <= (X >> 9) - rival < RIVAL_REACH (RIVAL_MOVES = 1), or if its candidate is hit (RIVAL_MOVES = 0).
//          The weight is W[d] = W[-1 - d] (WEIGHTS). The gear is log2 of the step for n, minus POINTER_SHIFT if n has 4 bits.
// Latency: none. Cost: a row of carries and an adder of 11 bits for track, an adder of 17 and an adder of 8 bits for point.

`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pixel_distance `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int LABELS = 5,
    parameter int SCORES_WIDTH = 24,
    parameter int OFFSET_BITS = 5,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    parameter int CELL_SHIFT = 9,
    parameter int PIXEL_WIDTH = 32,
    parameter int RIVAL_REACH = 6,                      // cells on each side of the rival
    parameter logic [23:0] WEIGHTS = 24'o12344431       // for distances 0 to 7, one octal digit each, distance 0 lowest
) (
    input  logic                                        valid_i,         // the pixel has a timestamp
    input  logic [                                15:0] position_i,      // X
    input  logic [                     PIXEL_WIDTH-1:0] word_i,
    input  logic [       dtof_pkg::POOL_CELL_WIDTH-1:0] leader_cell_i,   // cell of the candidate that the word refers to as leader
    input  logic [                          LABELS-1:0] hits_i,
    output `DTOF_TYPE(dtof_pool_pkg, pixel_distance_t)              distance_o       // all 0 without a timestamp
);

  `DTOF_TYPE(dtof_pool_pkg, pixel_distance_t) found;
  assign distance_o = found;

  localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS);
  localparam int OFFSET_WIDTH = dtof_pkg::max_of(OFFSET_BITS, 1);
  localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES);
  localparam int RIVAL_WIDTH = dtof_pkg::POOL_RIVAL_WIDTH;
  localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES);
  localparam int DISTANCE_WIDTH = 16 - POINTER_SHIFT + 2;
  // Shifts from the pointer's unit to cells: before and after the pointer has settled; CELLS_WIDTH fits the finer cells.
  localparam int START_SHIFT = 9 - POINTER_SHIFT;
  localparam int SETTLED_SHIFT = CELL_SHIFT - POINTER_SHIFT;
  localparam int CELLS_WIDTH = DISTANCE_WIDTH - ((CELL_SHIFT < 9) ? SETTLED_SHIFT : START_SHIFT);
  localparam logic [CELLS_WIDTH-1:0] REACH = CELLS_WIDTH'(8);
  localparam logic [ADVANTAGE_WIDTH-1:0] SETTLED_FROM = ADVANTAGE_WIDTH'((ADVANTAGE_WIDTH == 7) ? 16 : 12);
  localparam logic [2:0] NEAR = 3'd4;  // cells from the pointer, whose own cell is 0
  localparam logic [2:0] RIVAL_NEAR = 3'(RIVAL_REACH - 1);

  logic [LABEL_WIDTH-1:0] resting_rival;
  logic [OFFSET_WIDTH-1:0] offset;
  // In units of 64. The leader's position is within the range, because the offset follows timestamps.
  logic [10:0] track_position, minus_leader, minus_offset, track_sum, track_carry, track_distance;
  logic [7:0] track_cells, rival_cells;
  logic [POINTER_WIDTH-1:0] pointer;
  logic [DISTANCE_WIDTH-1:0] position, minus_cell, minus_pointer, point_sum, point_carry, distance;
  logic settled, below, reach, hit, rival_below;
  logic [CELLS_WIDTH-1:0] point_cells;
  logic [2:0] cells_away, rival_away;
  logic [6:0] advantage;

  assign position = {2'b00, position_i[15:POINTER_SHIFT]};

  // Inside if (valid_i), so that a simulator evaluates it for timestamps only; the defaults avoid latches.
  always_comb begin
    found = '0;
    resting_rival = '0;
    offset = '0;
    track_position = '0;
    minus_leader = '0;
    minus_offset = '0;
    track_sum = '0;
    track_carry = '0;
    track_distance = '0;
    track_cells = '0;
    rival_cells = '0;
    pointer = '0;
    minus_cell = '0;
    minus_pointer = '0;
    point_sum = '0;
    point_carry = '0;
    distance = '0;
    point_cells = '0;
    cells_away = '0;
    settled = 1'b0;
    below = 1'b0;
    reach = 1'b0;
    hit = 1'b0;
    rival_below = 1'b0;
    rival_away = '0;
    advantage = '0;
    if (valid_i) begin
      // Track: offset.
      offset = OFFSET_WIDTH'(word_i >> (SCORES_WIDTH + LABEL_WIDTH));
      // One addition subtracts both leader and offset: sums and carries of the three terms, and 1 for each complement.
      track_position = 11'(position_i >> 6);
      minus_leader = ~{1'b0, leader_cell_i, 3'b000};
      minus_offset = ~{{(11 - OFFSET_WIDTH) {1'(offset >> (OFFSET_WIDTH - 1))}}, offset};
      track_sum = track_position ^ minus_leader ^ minus_offset;
      track_carry = (track_position & minus_leader) | (track_position & minus_offset) | (minus_leader & minus_offset);
      track_distance = track_sum + ((track_carry << 1) | 11'd1) + 11'd1;
      track_cells = 8'(track_distance >> 3);
      found.offset_up = (OFFSET_BITS > 0) && (track_cells != 8'd0) && (track_cells < 8'd8);
      found.offset_down = (OFFSET_BITS > 0) && (track_cells >= -8'd8) && (track_cells != -8'd1);

      // Point: distance to the leader, in the pointer's unit. For a pointer relative to a candidate, one addition subtracts both.
      pointer = POINTER_WIDTH'(word_i);
      if (RIVAL_MOVES != 0) begin
        distance = position - DISTANCE_WIDTH'(pointer);
      end else begin
        minus_cell = ~(DISTANCE_WIDTH'({leader_cell_i, {START_SHIFT{1'b0}}}));
        minus_pointer = ~{{(DISTANCE_WIDTH - POINTER_WIDTH) {1'(pointer >> (POINTER_WIDTH - 1))}}, pointer};
        point_sum = position ^ minus_cell ^ minus_pointer;
        point_carry = (position & minus_cell) | (position & minus_pointer) | (minus_cell & minus_pointer);
        distance = point_sum + ((point_carry << 1) | DISTANCE_WIDTH'(1)) + DISTANCE_WIDTH'(1);
      end
      if (CELL_SHIFT == 9) begin
        point_cells = CELLS_WIDTH'(distance >> START_SHIFT);
      end else begin
        settled = ADVANTAGE_WIDTH'(word_i >> (POINT_WIDTH - ADVANTAGE_WIDTH)) >= SETTLED_FROM;
        point_cells = settled ? CELLS_WIDTH'($signed(distance) >>> SETTLED_SHIFT)
            : CELLS_WIDTH'($signed(distance) >>> START_SHIFT);
      end
      below = 1'(point_cells >> (CELLS_WIDTH - 1));
      cells_away = 3'(point_cells) ^ {3{below}};
      reach = (point_cells < REACH) || (point_cells >= -REACH);
      hit = reach && (cells_away <= NEAR);
      found.reach = reach;
      found.hit = hit;
      found.up = !below;
      found.weight = WEIGHTS[3*cells_away+:3];

      advantage = 7'(ADVANTAGE_WIDTH'(word_i >> (POINT_WIDTH - ADVANTAGE_WIDTH)));
      if (ADVANTAGE_WIDTH == 7) begin
        if (advantage >= 7'd124) found.gear = 4'd0;
        else if (advantage >= 7'd116) found.gear = 4'd1;
        else if (advantage >= 7'd100) found.gear = 4'd2;
        else if (advantage >= 7'd80) found.gear = 4'd3;
        else if (advantage >= 7'd64) found.gear = 4'd4;
        else if (advantage >= 7'd32) found.gear = 4'd5;
        else if (advantage >= 7'd16) found.gear = 4'd6;
        else if (advantage >= 7'd8) found.gear = 4'd7;
        else found.gear = 4'd8;
      end else begin
        if (advantage == 7'd15) found.gear = 4'(4 - POINTER_SHIFT);
        else if (advantage == 7'd14) found.gear = 4'(5 - POINTER_SHIFT);
        else if (advantage >= 7'd12) found.gear = 4'(6 - POINTER_SHIFT);
        else if (advantage >= 7'd8) found.gear = 4'(7 - POINTER_SHIFT);
        else if (advantage >= 7'd4) found.gear = 4'(8 - POINTER_SHIFT);
        else found.gear = 4'(9 - POINTER_SHIFT);
      end

      // Point: distance to the rival.
      rival_cells = 8'(position_i >> 9) - 8'(RIVAL_WIDTH'(word_i >> POINTER_WIDTH));
      rival_below = 1'(rival_cells >> 7);
      rival_away = 3'(rival_cells) ^ {3{rival_below}};
      resting_rival = LABEL_WIDTH'(word_i >> (POINTER_WIDTH + LABEL_WIDTH));
      if (RIVAL_MOVES != 0) begin
        found.rival_hit = !hit && (rival_cells < 8'd8 || rival_cells >= -8'd8) && (rival_away <= RIVAL_NEAR);
        found.rival_up = !rival_below && (rival_cells != 8'd0);
        found.rival_down = rival_below;
      end else begin
        found.rival_hit = !hit && hits_i[resting_rival];
      end
    end
  end

  logic unused;
  assign unused = ^{1'b0, settled, position_i, word_i, leader_cell_i, hits_i};

endmodule

`default_nettype wire
