// SPDX-License-Identifier: Apache-2.0
// poolPointer 2: what each column has for itself: its timestamps, and the next words of its pixels. The words themselves
// are in the register of the pair (pool2_pair).
//
// Equations: docs/reference/poolpointer2.md, Timestamps, Coarse, Track, Point. What needs several pixels at once (decode,
// choose, decide) is done by an engine that several columns share (pool2_engine).
//
// The first two timestamps of a pixel's slots count; the preferred one is the first in even acquisitions, the second in
// odd ones if there is one. T2 and later count from the pixel's last slot:
//   clock   coarse                          track and point (a half of an SRAM word holds two pixels of a column)
//   T2      of two pixels one is chosen     hits and distances of both timestamps, and which of them counts
//   T3                                      the pixel's next word; the pixels of the half change places
// Cost at the defaults: see reports/area.md.
module pool2_column #(
    parameter int NP = 10,
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,
    parameter int POINTER_SHIFT = 1,
    localparam int ADVANTAGE_WIDTH = 7,
    localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(LABELS, SCORE_BITS, LABELS, SCORE_BITS, OFFSET_BITS),
    localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, 1),
    localparam int PIXEL_WIDTH = dtof_pkg::max_of(TRACK_WIDTH, POINT_WIDTH),
    localparam int HALF_WIDTH = 2 * PIXEL_WIDTH,
    localparam int CELLS_WIDTH = LABELS * dtof_pkg::POOL_CELL_WIDTH,
    localparam int COARSE_WIDTH = $clog2(dtof_pkg::POOL_COARSE_BINS)
) (
    input  logic                    clk_i,
    input  logic [          NP-1:0] timestamp_i,
    input  logic                    point_i,           // the pointer phase
    // timestamps
    input  logic                    beat_t1_i,         // a timestamp, or none detected
    input  logic                    first_slot_t1_i,
    input  logic                    odd_t2_i,          // odd acquisition
    input  logic                    first_row_t2_i,    // coarse: the pair's first pixel is complete
    input  logic                    second_row_t2_i,   // coarse: its second one is
    input  logic [             3:0] acquisition_t3_i,  // mod 16
    // coarse bin of the timestamp that counts: at T2 of the second pixel, and registered
    output logic                    valid_t2_o,
    output logic [COARSE_WIDTH-1:0] bin_t2_o,
    output logic                    held_valid_o,
    output logic [COARSE_WIDTH-1:0] held_bin_o,
    // the column's half of the word, the pixel in work lowest
    input  logic [ CELLS_WIDTH-1:0] cells_i,           // of the pixel's group
    input  logic [  HALF_WIDTH-1:0] half_i,
    output logic [  HALF_WIDTH-1:0] updated_o          // after T3
);

  localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH;
  localparam int TRACK_REACH = 4;
  localparam int RIVAL_REACH = 6;
  localparam logic [23:0] WEIGHTS = 24'o12344431;

  // The first two timestamps.

  logic [NP-1:0] timestamp_t1_q, first_q, second_q;
  logic valid_t1, has_first_q, has_second_q;

  assign valid_t1 = beat_t1_i && !(&timestamp_t1_q);

  always_ff @(posedge clk_i) begin
    timestamp_t1_q <= timestamp_i;
    if (first_slot_t1_i) begin
      has_first_q <= valid_t1;
      has_second_q <= 1'b0;
    end else if (valid_t1) begin
      has_first_q <= 1'b1;
      has_second_q <= has_first_q;
    end
    if (first_slot_t1_i || !has_first_q) begin
      first_q <= timestamp_t1_q;
    end
    if (!has_second_q) begin
      second_q <= timestamp_t1_q;
    end
  end

  // Coarse: of a pair of pixels the first counts in even acquisitions, the second in odd ones, and the other if that one
  // has no timestamp.

  logic held_valid_q;
  logic [COARSE_WIDTH-1:0] held_bin_q, bin;

  assign bin = (odd_t2_i && has_second_q) ? second_q[NP-1-:COARSE_WIDTH] : first_q[NP-1-:COARSE_WIDTH];
  assign valid_t2_o = has_first_q || held_valid_q;
  assign bin_t2_o = (held_valid_q && !(odd_t2_i && has_first_q)) ? held_bin_q : bin;

  always_ff @(posedge clk_i) begin
    if (first_row_t2_i) begin
      held_valid_q <= has_first_q;
      held_bin_q <= bin;
    end else if (second_row_t2_i) begin
      held_valid_q <= valid_t2_o;
      held_bin_q <= bin_t2_o;
    end
  end

  assign held_valid_o = held_valid_q;
  assign held_bin_o = held_bin_q;

  // Track and point, T2: where both timestamps are.

  localparam int MOVE_WIDTH = LABELS + 11;  // what T3 needs to know of a timestamp

  logic [PIXEL_WIDTH-1:0] pixel;
  logic [2*NP-1:0] timestamps;
  logic [1:0] has, is_inside;
  logic [2*MOVE_WIDTH-1:0] moves;
  logic [MOVE_WIDTH-1:0] move_q;
  logic [3:0] gear_q, gear;
  logic take_second;

  assign pixel = half_i[PIXEL_WIDTH-1:0];
  assign timestamps = {second_q, first_q};
  assign has = {has_second_q, has_first_q};

  genvar i;
  generate
    for (i = 0; i < 2; i = i + 1) begin : g_timestamp
      logic [NP-1:0] timestamp;
      logic [15:0] position;
      logic [LABELS-1:0] hits;
      logic offset_up, offset_down, reach, up, hit, rival_hit, rival_up, rival_down;
      logic [2:0] weight;
      logic [3:0] own_gear;

      assign timestamp = timestamps[i*NP+:NP];
      if (NP == 16) begin : g_position
        assign position = timestamp;
      end else begin : g_middle_of_bin
        // The middle of a timestamp's bin; zeros follow.
        assign position = {timestamp, 1'b1, {(15 - NP) {1'b0}}};
      end

      label_match #(
          .LABELS       (LABELS),
          .DARK_LABELS  (LABELS),
          .BRIGHT_LABELS(LABELS),
          .WINDOW       (TRACK_REACH)
      ) u_label_match (
          .valid_i (has[i]),
          .cell_i  (timestamp[NP-1-:CELL_WIDTH]),
          .bright_i(1'b0),
          .cells_i (cells_i),
          .hits_o  (hits)
      );

      pixel_distance #(
          .LABELS         (LABELS),
          .SCORES_WIDTH   (LABELS * SCORE_BITS),
          .OFFSET_BITS    (OFFSET_BITS),
          .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
          .POINTER_SHIFT  (POINTER_SHIFT),
          .RIVAL_MOVES    (1),
          .PIXEL_WIDTH    (PIXEL_WIDTH),
          .RIVAL_REACH    (RIVAL_REACH),
          .WEIGHTS        (WEIGHTS)
      ) u_pixel_distance (
          .valid_i      (has[i]),
          .position_i   (position),
          .point_i      (point_i),
          .late_i       (1'b0),
          .word_i       (pixel),
          .cells_i      (cells_i),
          .hits_i       (hits),
          .offset_up_o  (offset_up),
          .offset_down_o(offset_down),
          .reach_o      (reach),
          .up_o         (up),
          .weight_o     (weight),
          .gear_o       (own_gear),
          .hit_o        (hit),
          .rival_hit_o  (rival_hit),
          .rival_up_o   (rival_up),
          .rival_down_o (rival_down)
      );

      assign is_inside[i] = point_i ? reach : (hits != '0);
      assign moves[i*MOVE_WIDTH+:MOVE_WIDTH] =
          {hits, offset_up, offset_down, reach, up, weight, hit, rival_hit, rival_up, rival_down};
      if (i == 0) begin : g_gear
        assign gear = own_gear;  // the word's
      end else begin : g_same_gear
        logic unused_gear;
        assign unused_gear = ^own_gear;
      end
    end
  endgenerate

  // The preferred one, unless it is outside and the other one is inside.
  assign take_second = has_second_q && (odd_t2_i ? is_inside[1] || !is_inside[0] : is_inside[1] && !is_inside[0]);

  always_ff @(posedge clk_i) begin
    move_q <= take_second ? moves[2*MOVE_WIDTH-1:MOVE_WIDTH] : moves[MOVE_WIDTH-1:0];
    gear_q <= gear;
  end

  // T3: the pixel's next word.

  logic [LABELS-1:0] hits_t3;
  logic offset_up_t3, offset_down_t3, reach_t3, up_t3, hit_t3, rival_hit_t3, rival_up_t3, rival_down_t3;
  logic [2:0] weight_t3;
  logic [TRACK_WIDTH-1:0] tracked;
  logic [POINT_WIDTH-1:0] pointed;
  logic [PIXEL_WIDTH-1:0] moved;

  assign {hits_t3, offset_up_t3, offset_down_t3, reach_t3, up_t3, weight_t3, hit_t3, rival_hit_t3, rival_up_t3,
          rival_down_t3} = move_q;

  pool2_track_update #(
      .LABELS     (LABELS),
      .SCORE_BITS (SCORE_BITS),
      .OFFSET_BITS(OFFSET_BITS)
  ) u_track_update (
      .word_i       (pixel[TRACK_WIDTH-1:0]),
      .hits_i       (hits_t3),
      .offset_up_i  (offset_up_t3),
      .offset_down_i(offset_down_t3),
      .word_o       (tracked)
  );

  twin_pointer_update #(
      .LABELS         (LABELS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (1)
  ) u_pointer_update (
      .word_i       (pixel[POINT_WIDTH-1:0]),
      .reach_i      (reach_t3),
      .up_i         (up_t3),
      .weight_i     (weight_t3),
      .gear_i       (gear_q),
      .hit_i        (hit_t3),
      .rival_hit_i  (rival_hit_t3),
      .rival_up_i   (rival_up_t3),
      .rival_down_i (rival_down_t3),
      .acquisition_i(acquisition_t3_i),
      .word_o       (pointed)
  );

  assign moved = point_i ? PIXEL_WIDTH'(pointed) : PIXEL_WIDTH'(tracked);
  assign updated_o = {moved, half_i[HALF_WIDTH-1:PIXEL_WIDTH]};

endmodule
