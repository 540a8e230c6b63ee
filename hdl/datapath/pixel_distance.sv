// SPDX-License-Identifier: Apache-2.0
// How far a timestamp is from where a pixel's word points: what the word's update needs to know. Combinational.
//
// Equations (docs/reference/poolpointer.md, Track and Point), distances floored to cells of 512 positions:
//   track  d = (X - C[leader] - 64 offset) >> 9: the offset goes up for 1 <= d < 8, down for -8 <= d < -1
//   point  d = (X - leader's position) >> 9: in reach for -8 <= d < 8, a hit for -5 <= d < 5; otherwise the
//          rival's hit if -RIVAL_REACH <= (X >> 9) - rival < RIVAL_REACH (RIVAL_MOVES = 1) or candidate b is hit (0);
//          weight W[d] = W[-1 - d] by WEIGHTS, gear log2 of the step that n allows (less POINTER_SHIFT if n has 4 bits)
// Cost: a subtractor of 11 bits for the track phase, one of 17 and one of 8 bits for the pointer phase.
module pixel_distance #(
    parameter int LABELS = 5,
    parameter int SCORES_WIDTH = 24,
    parameter int OFFSET_BITS = 5,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    parameter int PIXEL_WIDTH = 32,
    parameter int RIVAL_REACH = 5,                      // cells to either side of the rival
    parameter logic [23:0] WEIGHTS = 24'o12344321       // of the distances 0 to 7, one octal digit each, 0 lowest
) (
    input  logic                                        valid_i,         // there is a timestamp
    input  logic [                                15:0] position_i,      // X
    input  logic                                        point_i,         // the word is a pointer word
    input  logic                                        late_i,
    input  logic [                     PIXEL_WIDTH-1:0] word_i,
    input  logic [LABELS*dtof_pkg::POOL_CELL_WIDTH-1:0] cells_i,
    input  logic [                          LABELS-1:0] hits_i,
    output logic                                        offset_up_o,
    output logic                                        offset_down_o,
    output logic                                        reach_o,
    output logic                                        up_o,
    output logic [                                 2:0] weight_o,
    output logic [                                 3:0] gear_o,
    output logic                                        hit_o,
    output logic                                        rival_hit_o,
    output logic                                        rival_up_o,
    output logic                                        rival_down_o
);

  localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH;
  localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS);
  localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES);
  localparam int RIVAL_WIDTH = dtof_pkg::POOL_RIVAL_WIDTH;
  localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES);

  // Which candidate the word leans on.

  logic [LABEL_WIDTH-1:0] leader;
  logic [CELL_WIDTH-1:0] leader_cell;

  generate
    if (RIVAL_MOVES != 0 && OFFSET_BITS > 0) begin : g_track_leader
      assign leader = word_i[SCORES_WIDTH+:LABEL_WIDTH];
    end else if (RIVAL_MOVES != 0) begin : g_no_leader
      assign leader = '0;
    end else if (OFFSET_BITS > 0) begin : g_either_leader
      assign leader = point_i ? word_i[POINTER_WIDTH+:LABEL_WIDTH] : word_i[SCORES_WIDTH+:LABEL_WIDTH];
    end else begin : g_point_leader
      assign leader = word_i[POINTER_WIDTH+:LABEL_WIDTH];
    end
  endgenerate

  assign leader_cell = cells_i[leader*CELL_WIDTH+:CELL_WIDTH];

  // Track: offset.

  generate
    if (OFFSET_BITS > 0) begin : g_offset
      logic [OFFSET_BITS-1:0] offset;
      logic [9:0] position;  // in units of 64; within the range, since the offset follows timestamps
      logic signed [10:0] distance;
      logic signed [7:0] cells;
      assign offset = word_i[SCORES_WIDTH+LABEL_WIDTH+:OFFSET_BITS];
      assign position = {leader_cell, 3'b000} + {{(10 - OFFSET_BITS) {offset[OFFSET_BITS-1]}}, offset};
      assign distance = $signed({1'b0, position_i[15:6]}) - $signed({1'b0, position});
      assign cells = distance[10:3];
      assign offset_up_o = valid_i && (cells > 8'sd0) && (cells < 8'sd8);
      assign offset_down_o = valid_i && (cells < -8'sd1) && (cells >= -8'sd8);
      logic unused_distance;
      assign unused_distance = ^distance[2:0];
    end else begin : g_no_offset
      assign offset_up_o = 1'b0;
      assign offset_down_o = 1'b0;
    end
  endgenerate

  // Point: leader, in the pointer's units.

  localparam int DISTANCE_WIDTH = 16 - POINTER_SHIFT + 2;
  localparam int CELL_SHIFT = 9 - POINTER_SHIFT;
  localparam int CELLS_WIDTH = DISTANCE_WIDTH - CELL_SHIFT;
  localparam logic signed [CELLS_WIDTH-1:0] REACH = CELLS_WIDTH'(8);
  localparam logic signed [CELLS_WIDTH-1:0] NEAR = CELLS_WIDTH'(5);

  logic [POINTER_WIDTH-1:0] pointer;
  logic [2:0] cells_away;
  logic signed [DISTANCE_WIDTH-1:0] distance;
  logic signed [CELLS_WIDTH-1:0] cells;

  assign pointer = word_i[POINTER_WIDTH-1:0];
  assign cells = distance[DISTANCE_WIDTH-1:CELL_SHIFT];
  assign reach_o = valid_i && (cells >= -REACH) && (cells < REACH);
  assign hit_o = valid_i && (cells >= -NEAR) && (cells < NEAR);
  assign up_o = !cells[CELLS_WIDTH-1];
  assign cells_away = cells[2:0] ^ {3{cells[CELLS_WIDTH-1]}};

  assign weight_o = WEIGHTS[3*cells_away+:3];

  // 64 units of 2^-11 coarse bin.
  localparam logic [3:0] LATE_GEAR = 4'(6 - ((ADVANTAGE_WIDTH == 4) ? POINTER_SHIFT : 0));
  logic [ADVANTAGE_WIDTH-1:0] advantage;
  logic [3:0] gear_of_count;
  assign advantage = word_i[POINT_WIDTH-1-:ADVANTAGE_WIDTH];

  generate
    if (ADVANTAGE_WIDTH == 7) begin : g_gear
      always_comb begin
        if (advantage >= 7'd124) gear_of_count = 4'd0;
        else if (advantage >= 7'd116) gear_of_count = 4'd1;
        else if (advantage >= 7'd100) gear_of_count = 4'd2;
        else if (advantage >= 7'd80) gear_of_count = 4'd3;
        else if (advantage >= 7'd64) gear_of_count = 4'd4;
        else if (advantage >= 7'd32) gear_of_count = 4'd5;
        else if (advantage >= 7'd16) gear_of_count = 4'd6;
        else if (advantage >= 7'd8) gear_of_count = 4'd7;
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

  assign gear_o = (late_i && gear_of_count > LATE_GEAR) ? LATE_GEAR : gear_of_count;

  generate
    if (RIVAL_MOVES != 0) begin : g_moving_rival
      logic [RIVAL_WIDTH-1:0] rival;
      localparam logic signed [RIVAL_WIDTH:0] RIVAL_CELLS = (RIVAL_WIDTH + 1)'(RIVAL_REACH);
      logic signed [RIVAL_WIDTH:0] rival_distance;
      assign rival = word_i[POINTER_WIDTH+:RIVAL_WIDTH];
      assign distance = $signed({2'b00, position_i[15:POINTER_SHIFT]}) - $signed({2'b00, pointer});
      assign rival_distance = $signed({1'b0, position_i[15:9]}) - $signed({1'b0, rival});
      assign rival_hit_o = valid_i && !hit_o && (rival_distance >= -RIVAL_CELLS) && (rival_distance < RIVAL_CELLS);
      assign rival_up_o = (rival_distance > 8'sd0);
      assign rival_down_o = (rival_distance < 8'sd0);
    end else begin : g_resting_rival
      logic [LABEL_WIDTH-1:0] rival;
      assign rival = word_i[POINTER_WIDTH+LABEL_WIDTH+:LABEL_WIDTH];
      assign distance = $signed({2'b00, position_i[15:POINTER_SHIFT]})
          - $signed({2'b00, leader_cell, {CELL_SHIFT{1'b0}}})
          - $signed({{(DISTANCE_WIDTH - POINTER_WIDTH) {pointer[POINTER_WIDTH-1]}}, pointer});
      assign rival_hit_o = valid_i && !hit_o && hits_i[rival];
      assign rival_up_o = 1'b0;
      assign rival_down_o = 1'b0;
    end
  endgenerate

  logic unused;
  assign unused = ^{1'b0, point_i, position_i, word_i, cells_i, hits_i, distance[CELL_SHIFT-1:0]};

endmodule
