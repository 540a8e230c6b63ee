// SPDX-License-Identifier: Apache-2.0
// poolPointer: what each column has for itself. Its half of the words that pool_pointer_pair keeps in the SRAM
// passes through here: a group's coarse histogram, the pixels' track words, their pointer words.
//
// Equations: docs/reference/poolpointer.md, Timestamps, Coarse, Track, Point. What needs several pixels at once
// (decode, choose, decide) is done by an engine that several columns share (pool_engine).
//
// A pixel uses one timestamp an acquisition, chosen while its slots pass. T2 and later count from its last slot:
//   clock   coarse                          track and point (an SRAM word holds two pixels of each column)
//   T2      of two pixels one is chosen     hits and distances; with the second pixel the next pair is read
//   T3                                      word updated, the other pixel's turn; with the second pixel the pair
//                                           is written and the next one registered
// Cost at the defaults: see reports/area.md.
`include "pixel_distance.svh"

module pool_pointer_column #(
    parameter int NP = 10,
    parameter int COUNT_WIDTH = 7,
    parameter int DARK_LABELS = 5,
    parameter int DARK_SCORE_BITS = 4,
    parameter int BRIGHT_LABELS = 5,
    parameter int BRIGHT_SCORE_BITS = 4,
    parameter int BRIGHT_FROM = 6,
    parameter int OFFSET_BITS = 5,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    parameter int TIME_GATE = 0,
    localparam int LABELS = dtof_pkg::max_of(DARK_LABELS, BRIGHT_LABELS),
    localparam int GROUP_WIDTH = dtof_pkg::pool_group_width(LABELS),
    localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(DARK_LABELS, DARK_SCORE_BITS, BRIGHT_LABELS,
                                                            BRIGHT_SCORE_BITS, OFFSET_BITS),
    localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES),
    localparam int PIXEL_WIDTH = dtof_pkg::max_of(TRACK_WIDTH, POINT_WIDTH),
    localparam int WORD_WIDTH = dtof_pkg::max_of(2 * PIXEL_WIDTH, GROUP_WIDTH),
    localparam int COARSE_WIDTH = $clog2(dtof_pkg::POOL_COARSE_BINS),
    localparam int BINS_PER_WORD = dtof_pkg::pool_bins_per_word(WORD_WIDTH, COUNT_WIDTH),
    localparam int BIN_WIDTH = $clog2(BINS_PER_WORD)
) (
    input  logic                     clk_i,
    input  logic [           NP-1:0] timestamp_i,
    input  logic [           NP-1:0] gate_begin_i,
    input  logic [           NP-1:0] gate_end_i,
    // phase, common to all columns
    input  logic                     point_i,
    // timestamps
    input  logic                     beat_t1_i,         // a timestamp, or none detected
    input  logic                     first_slot_t1_i,
    input  logic                     odd_t1_i,          // odd acquisition
    input  logic                     odd_t2_i,
    input  logic                     first_row_t2_i,    // coarse: the pair's first pixel is complete
    input  logic                     second_row_t2_i,   // coarse: its second one is
    input  logic                     late_t2_i,
    input  logic                     update_t2_i,
    input  logic                     track_t3_i,        // a track word is updated
    input  logic                     point_t3_i,        // a pointer word is
    input  logic [              3:0] acquisition_t3_i,  // mod 16
    // coarse bin of the timestamp that counts: at T2 of the second pixel, and registered
    output logic                     valid_t2_o,
    output logic [ COARSE_WIDTH-1:0] bin_t2_o,
    output logic                     held_valid_o,
    output logic [ COARSE_WIDTH-1:0] held_bin_o,
    // word
    input  logic [   WORD_WIDTH-1:0] read_data_i,
    input  logic                     word_load_i,
    input  logic                     group_load_i,
    input  logic                     counting_i,        // the word's bin_i gets next_count_i
    input  logic [    BIN_WIDTH-1:0] bin_i,
    input  logic [  COUNT_WIDTH-1:0] next_count_i,
    output logic [   WORD_WIDTH-1:0] word_o,
    output logic [   WORD_WIDTH-1:0] updated_o          // after T3
);

  localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH;
  localparam int SCORES_WIDTH = TRACK_WIDTH - ((OFFSET_BITS > 0) ? dtof_pkg::index_width(LABELS) + OFFSET_BITS : 0);

  logic [WORD_WIDTH-1:0] word_q, word_d, counted, updated;

  // The timestamp that counts: the first, but the second in odd acquisitions if there is one.

  logic [NP-1:0] timestamp_t1, timestamp_t2_q;
  logic [15:0] position;
  logic valid_t1, valid_t2_q, only_one_q;

  time_gate #(
      .NP       (NP),
      .TIME_GATE(TIME_GATE)
  ) u_time_gate (
      .clk_i         (clk_i),
      .timestamp_i   (timestamp_i),
      .gate_begin_i  (gate_begin_i),
      .gate_end_i    (gate_end_i),
      .timestamp_t1_o(timestamp_t1)
  );

  assign valid_t1 = beat_t1_i && !(&timestamp_t1);

  always_ff @(posedge clk_i) begin
    valid_t2_q <= valid_t1 || (valid_t2_q && !first_slot_t1_i);
    if (valid_t1 || first_slot_t1_i) begin
      only_one_q <= valid_t1 && (first_slot_t1_i || !valid_t2_q);
    end
    if (valid_t1 && (first_slot_t1_i || !valid_t2_q || (odd_t1_i && only_one_q))) begin
      timestamp_t2_q <= timestamp_t1;
    end
  end

  generate
    if (NP == 16) begin : g_position
      assign position = timestamp_t2_q;
    end else begin : g_middle_of_bin
      // The middle of a timestamp's bin; zeros follow.
      assign position = {timestamp_t2_q, 1'b1, {(15 - NP) {1'b0}}};
    end
  endgenerate

  // Coarse: of a pair of pixels the first counts in even acquisitions, the second in odd ones, and the other if
  // that one has no timestamp.

  logic held_valid_q;
  logic [COARSE_WIDTH-1:0] held_bin_q, bin;

  assign bin = timestamp_t2_q[NP-1-:COARSE_WIDTH];
  assign valid_t2_o = valid_t2_q || held_valid_q;
  assign bin_t2_o = (held_valid_q && !(odd_t2_i && valid_t2_q)) ? held_bin_q : bin;

  always_ff @(posedge clk_i) begin
    if (first_row_t2_i) begin
      held_valid_q <= valid_t2_q;
      held_bin_q <= bin;
    end else if (second_row_t2_i) begin
      held_valid_q <= valid_t2_o;
      held_bin_q <= bin_t2_o;
    end
  end

  assign held_valid_o = held_valid_q;
  assign held_bin_o = held_bin_q;

  // Track and point, T2: where the timestamp is. The pixel in work is the word's low half.

  logic [GROUP_WIDTH-1:0] group_q;
  logic [dtof_pkg::POOL_BACKGROUND_WIDTH-1:0] background;
  logic bright;
  logic [LABELS-1:0] hits_t2, hits_t3_q;
  logic measure_t2, bright_t3_q;
  pixel_distance_t distance_t2, distance_t3_q;
  logic [PIXEL_WIDTH-1:0] pixel, other_pixel;

  assign pixel = word_q[PIXEL_WIDTH-1:0];
  assign other_pixel = word_q[2*PIXEL_WIDTH-1:PIXEL_WIDTH];
  assign background = group_q[LABELS*CELL_WIDTH+:dtof_pkg::POOL_BACKGROUND_WIDTH];
  assign bright = (BRIGHT_FROM == 0) || (background >= dtof_pkg::POOL_BACKGROUND_WIDTH'(BRIGHT_FROM));

  // T3 takes nothing else.
  assign measure_t2 = valid_t2_q && update_t2_i;

  label_match #(
      .LABELS       (LABELS),
      .DARK_LABELS  (DARK_LABELS),
      .BRIGHT_LABELS(BRIGHT_LABELS)
  ) u_label_match (
      .valid_i (measure_t2),
      .cell_i  (timestamp_t2_q[NP-1-:CELL_WIDTH]),
      .bright_i(bright),
      .cells_i (group_q[LABELS*CELL_WIDTH-1:0]),
      .hits_o  (hits_t2)
  );

  pixel_distance #(
      .LABELS         (LABELS),
      .SCORES_WIDTH   (SCORES_WIDTH),
      .OFFSET_BITS    (OFFSET_BITS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES),
      .PIXEL_WIDTH    (PIXEL_WIDTH)
  ) u_pixel_distance (
      .valid_i   (measure_t2),
      .position_i(position),
      .point_i   (point_i),
      .late_i    (late_t2_i),
      .word_i    (pixel),
      .cells_i   (group_q[LABELS*CELL_WIDTH-1:0]),
      .hits_i    (hits_t2),
      .distance_o(distance_t2)
  );

  always_ff @(posedge clk_i) begin
    hits_t3_q <= hits_t2;
    bright_t3_q <= bright;
    distance_t3_q <= distance_t2;
    if (group_load_i) begin
      group_q <= read_data_i[GROUP_WIDTH-1:0];
    end
  end

  // T3: the pixel's next word.

  logic [PIXEL_WIDTH-1:0] moved;
  logic [TRACK_WIDTH-1:0] tracked;
  logic [POINT_WIDTH-1:0] pointed;

  track_update #(
      .LABELS           (LABELS),
      .DARK_LABELS      (DARK_LABELS),
      .DARK_SCORE_BITS  (DARK_SCORE_BITS),
      .BRIGHT_LABELS    (BRIGHT_LABELS),
      .BRIGHT_SCORE_BITS(BRIGHT_SCORE_BITS),
      .OFFSET_BITS      (OFFSET_BITS)
  ) u_track_update (
      .update_i     (track_t3_i),
      .word_i       (pixel[TRACK_WIDTH-1:0]),
      .hits_i       (hits_t3_q),
      .bright_i     (bright_t3_q),
      .offset_up_i  (distance_t3_q.offset_up),
      .offset_down_i(distance_t3_q.offset_down),
      .word_o       (tracked)
  );

  twin_pointer_update #(
      .LABELS         (LABELS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES)
  ) u_pointer_update (
      .update_i     (point_t3_i),
      .word_i       (pixel[POINT_WIDTH-1:0]),
      .reach_i      (distance_t3_q.reach),
      .up_i         (distance_t3_q.up),
      .weight_i     (distance_t3_q.weight),
      .gear_i       (distance_t3_q.gear),
      .hit_i        (distance_t3_q.hit),
      .rival_hit_i  (distance_t3_q.rival_hit),
      .rival_up_i   (distance_t3_q.rival_up),
      .rival_down_i (distance_t3_q.rival_down),
      .acquisition_i(acquisition_t3_i),
      .word_o       (pointed)
  );

  // The other one is 0.
  assign moved = PIXEL_WIDTH'(tracked) | PIXEL_WIDTH'(pointed);

  // The word in work. Its halves change places with every pixel.

  integer b;
  always_comb begin
    counted = word_q;
    b = 0;
    if (counting_i) begin
      for (b = 0; b < BINS_PER_WORD; b = b + 1) begin
        if (bin_i == BIN_WIDTH'(b)) begin
          counted[b*COUNT_WIDTH+:COUNT_WIDTH] = next_count_i;
        end
      end
    end
  end

  generate
    if (WORD_WIDTH > 2 * PIXEL_WIDTH) begin : g_padding
      assign updated = {word_q[WORD_WIDTH-1:2*PIXEL_WIDTH], moved, other_pixel};
    end else begin : g_no_padding
      assign updated = {moved, other_pixel};
    end
  endgenerate

  assign word_d = word_load_i ? read_data_i : ((track_t3_i || point_t3_i) ? updated : counted);

  always_ff @(posedge clk_i) begin
    word_q <= word_d;
  end

  assign word_o = word_q;
  assign updated_o = updated;

endmodule
