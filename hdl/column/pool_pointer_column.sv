// SPDX-License-Identifier: Apache-2.0
// poolPointer: one column. A single-port SRAM holds, one after the other in the same words, the coarse histogram
// of each group of pixels, the pixels' track words and their pointer words; behind them the groups' words.
//
// Equations: docs/poolpointer.md, Coarse, Track, Point. What needs several pixels at once (decode, choose,
// decide) is done by an engine that several columns share (pool_engine).
//
// A pixel uses one timestamp an acquisition, chosen while its slots pass. T2 and later count from its last slot:
//   clock   coarse                          track and point (an SRAM word holds two pixels)
//   T2      histogram word read             hits and distances; with the second pixel the next pair is read
//   T3      registered                      word updated, the other pixel's turn; with the second pixel the pair
//   T4      counted                         is written and the next one registered
//   T5      written (T6 for three slots)
// In the coarse phase a pixel that counts in the word of the pixel before it goes on with the register, whose
// write may be still to come. A group's word is read one clock before its first pair.
//
// Engine: while engine_i the register follows selected reads and is 0 otherwise, so that columns can be ORed.
// Cost at the defaults: see reports/area.md.
`include "dtof_macros.svh"

module pool_pointer_column #(
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int COUNT_WIDTH = 8,
    parameter int GROUP_SIZE = 8,
    parameter int DARK_LABELS = 6,
    parameter int DARK_SCORE_BITS = 4,
    parameter int BRIGHT_LABELS = 6,
    parameter int BRIGHT_SCORE_BITS = 4,
    parameter int BRIGHT_FROM = 12,
    parameter int OFFSET_BITS = 5,
    parameter int ADVANTAGE_WIDTH = 8,
    parameter int POINTER_SHIFT = 0,
    parameter int RIVAL_MOVES = 1,
    localparam int LABELS = dtof_pkg::max_of(DARK_LABELS, BRIGHT_LABELS),
    localparam int GROUP_WIDTH = dtof_pkg::pool_group_width(LABELS),
    localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(DARK_LABELS, DARK_SCORE_BITS, BRIGHT_LABELS,
                                                            BRIGHT_SCORE_BITS, OFFSET_BITS),
    localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES),
    localparam int PIXEL_WIDTH = dtof_pkg::max_of(TRACK_WIDTH, POINT_WIDTH),
    localparam int WORD_WIDTH = dtof_pkg::max_of(2 * PIXEL_WIDTH, GROUP_WIDTH),
    localparam int GROUPS = (PIXELS_PER_SRAM + GROUP_SIZE - 1) / GROUP_SIZE,
    localparam int DEPTH = GROUPS * (GROUP_SIZE / 2 + 1),
    localparam int ADDR_WIDTH = dtof_pkg::index_width(DEPTH)
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    input  logic [        NP-1:0] timestamp_i,
    // phase, common to all columns
    input  logic                  coarse_i,
    input  logic                  point_i,
    // timestamps
    input  logic                  beat_t1_i,         // a timestamp, or none detected
    input  logic                  first_slot_t1_i,
    input  logic                  odd_t1_i,          // odd acquisition
    input  logic                  fresh_t2_i,        // first pixel of a group
    input  logic                  late_t2_i,
    input  logic                  update_t3_i,
    input  logic [           1:0] dither_t3_i,       // acquisition mod 4
    input  logic                  every_16_t3_i,     // acquisition mod 16 = 0
    input  logic                  load_t3_i,
    input  logic                  count_t4_i,
    // SRAM
    input  logic                  read_i,
    input  logic                  write_i,
    input  logic [ADDR_WIDTH-1:0] address_i,
    input  logic                  word_load_i,       // the word read last clock
    input  logic                  group_load_i,
    // engine
    input  logic                  engine_i,
    input  logic                  select_i,
    input  logic [WORD_WIDTH-1:0] engine_word_i,
    output logic [WORD_WIDTH-1:0] word_o
);

  localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH;
  localparam int SCORES_WIDTH = TRACK_WIDTH - ((OFFSET_BITS > 0) ? dtof_pkg::index_width(LABELS) + OFFSET_BITS : 0);
  localparam int COARSE_WIDTH = $clog2(dtof_pkg::POOL_COARSE_BINS);
  localparam int BINS_PER_WORD = dtof_pkg::pool_bins_per_word(WORD_WIDTH, COUNT_WIDTH);
  localparam int BIN_WIDTH = $clog2(BINS_PER_WORD);
  localparam int LINE_WIDTH = COARSE_WIDTH - BIN_WIDTH;  // which of a group's histogram words

  logic [WORD_WIDTH-1:0] word_q, word_d, read_data, write_data, updated;
  logic read, write;
  logic [ADDR_WIDTH-1:0] address;

  dtof_sram #(
      .PORTS(1),
      .DEPTH(DEPTH),
      .WIDTH(WORD_WIDTH)
  ) u_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .read_en_i   (read),
      .read_addr_i (address),
      .read_data_o (read_data),
      .write_en_i  (write),
      .write_addr_i(address),
      .write_data_i(write_data)
  );

  // The timestamp that counts: the first, but the second in odd acquisitions if there is one.

  logic [NP-1:0] timestamp_t1_q, timestamp_t2_q;
  logic [15:0] position;
  logic valid_t1, valid_t2_q, only_one_q;

  assign valid_t1 = beat_t1_i && !(&timestamp_t1_q);

  always_ff @(posedge clk_i) begin
    timestamp_t1_q <= timestamp_i;
    valid_t2_q <= valid_t1 || (valid_t2_q && !first_slot_t1_i);
    if (valid_t1 || first_slot_t1_i) begin
      only_one_q <= valid_t1 && (first_slot_t1_i || !valid_t2_q);
    end
    if (valid_t1 && (first_slot_t1_i || !valid_t2_q || (odd_t1_i && only_one_q))) begin
      timestamp_t2_q <= timestamp_t1_q;
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

  // Coarse.

  logic [COARSE_WIDTH-1:0] bin;
  logic same_line, fetch, pending_q, load_q, counted_q, write_q;
  logic [LINE_WIDTH-1:0] line, line_q, write_line_q;
  logic [BIN_WIDTH-1:0] select_q;
  logic [COUNT_WIDTH-1:0] count, next_count;

  assign bin = timestamp_t2_q[NP-1-:COARSE_WIDTH];
  assign same_line = counted_q && !fresh_t2_i && (bin[COARSE_WIDTH-1:BIN_WIDTH] == line_q);
  assign fetch = coarse_i && read_i && valid_t2_q;

  always_ff @(posedge clk_i) begin
    if (read_i || engine_i) begin
      pending_q <= fetch;
      load_q <= fetch && !same_line;
      counted_q <= coarse_i && (fetch || (counted_q && !fresh_t2_i));
    end
    if (fetch) begin
      line_q <= bin[COARSE_WIDTH-1:BIN_WIDTH];
      select_q <= bin[BIN_WIDTH-1:0];
    end
    if (count_t4_i) begin
      write_q <= pending_q;
      write_line_q <= line_q;
    end
  end

  assign count = word_q[select_q*COUNT_WIDTH+:COUNT_WIDTH];
  assign next_count = (&count) ? count : count + 1'b1;

  // Track and point, T2: where the timestamp is. The pixel in work is the word's low half.

  logic [GROUP_WIDTH-1:0] group_q;
  logic [dtof_pkg::POOL_BACKGROUND_WIDTH-1:0] background;
  logic bright;
  logic [LABELS-1:0] hits_t2, hits_t3_q;
  logic bright_t3_q, offset_up_t3_q, offset_down_t3_q, reach_t3_q, up_t3_q, hit_t3_q;
  logic rival_hit_t3_q, rival_up_t3_q, rival_down_t3_q;
  logic [2:0] weight_t3_q, weight_t2;
  logic [3:0] gear_t3_q, gear_t2;
  logic offset_up_t2, offset_down_t2, reach_t2, up_t2, hit_t2, rival_hit_t2, rival_up_t2, rival_down_t2;
  logic [PIXEL_WIDTH-1:0] pixel;

  assign pixel = word_q[PIXEL_WIDTH-1:0];
  assign background = group_q[LABELS*CELL_WIDTH+:dtof_pkg::POOL_BACKGROUND_WIDTH];
  assign bright = (BRIGHT_FROM == 0) || (background >= dtof_pkg::POOL_BACKGROUND_WIDTH'(BRIGHT_FROM));

  label_match #(
      .LABELS       (LABELS),
      .DARK_LABELS  (DARK_LABELS),
      .BRIGHT_LABELS(BRIGHT_LABELS)
  ) u_label_match (
      .valid_i (valid_t2_q),
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
      .valid_i      (valid_t2_q),
      .position_i   (position),
      .point_i      (point_i),
      .late_i       (late_t2_i),
      .word_i       (pixel),
      .cells_i      (group_q[LABELS*CELL_WIDTH-1:0]),
      .hits_i       (hits_t2),
      .offset_up_o  (offset_up_t2),
      .offset_down_o(offset_down_t2),
      .reach_o      (reach_t2),
      .up_o         (up_t2),
      .weight_o     (weight_t2),
      .gear_o       (gear_t2),
      .hit_o        (hit_t2),
      .rival_hit_o  (rival_hit_t2),
      .rival_up_o   (rival_up_t2),
      .rival_down_o (rival_down_t2)
  );

  always_ff @(posedge clk_i) begin
    hits_t3_q <= hits_t2;
    bright_t3_q <= bright;
    offset_up_t3_q <= offset_up_t2;
    offset_down_t3_q <= offset_down_t2;
    reach_t3_q <= reach_t2;
    up_t3_q <= up_t2;
    weight_t3_q <= weight_t2;
    gear_t3_q <= gear_t2;
    hit_t3_q <= hit_t2;
    rival_hit_t3_q <= rival_hit_t2;
    rival_up_t3_q <= rival_up_t2;
    rival_down_t3_q <= rival_down_t2;
    if (group_load_i) begin
      group_q <= read_data[GROUP_WIDTH-1:0];
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
      .word_i       (pixel[TRACK_WIDTH-1:0]),
      .hits_i       (hits_t3_q),
      .bright_i     (bright_t3_q),
      .offset_up_i  (offset_up_t3_q),
      .offset_down_i(offset_down_t3_q),
      .word_o       (tracked)
  );

  twin_pointer_update #(
      .LABELS         (LABELS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES)
  ) u_pointer_update (
      .word_i      (pixel[POINT_WIDTH-1:0]),
      .reach_i     (reach_t3_q),
      .up_i        (up_t3_q),
      .weight_i    (weight_t3_q),
      .gear_i      (gear_t3_q),
      .hit_i       (hit_t3_q),
      .rival_hit_i (rival_hit_t3_q),
      .rival_up_i  (rival_up_t3_q),
      .rival_down_i(rival_down_t3_q),
      .dither_i    (dither_t3_i),
      .every_16_i  (every_16_t3_i),
      .word_o      (pointed)
  );

  assign moved = point_i ? PIXEL_WIDTH'(pointed) : PIXEL_WIDTH'(tracked);

  // The word in work, and the SRAM.

  logic [WORD_WIDTH-1:0] counted_word;
  integer b;
  always_comb begin
    counted_word = word_q;
    for (b = 0; b < BINS_PER_WORD; b = b + 1) begin
      if (select_q == BIN_WIDTH'(b)) begin
        counted_word[b*COUNT_WIDTH+:COUNT_WIDTH] = next_count;
      end
    end
  end

  always_comb begin
    word_d = word_q;
    if (engine_i) begin
      word_d = (select_i && word_load_i) ? read_data : '0;
    end else if (word_load_i || (load_t3_i && load_q)) begin
      word_d = read_data;
    end else if (count_t4_i && pending_q) begin
      word_d = counted_word;
    end else if (update_t3_i) begin
      word_d = updated;
    end
  end

  always_ff @(posedge clk_i) begin
    word_q <= word_d;
  end

  // The halves change places with every pixel.
  generate
    if (WORD_WIDTH > 2 * PIXEL_WIDTH) begin : g_padding
      assign updated = {word_q[WORD_WIDTH-1:2*PIXEL_WIDTH], moved, word_q[2*PIXEL_WIDTH-1:PIXEL_WIDTH]};
    end else begin : g_no_padding
      assign updated = {moved, word_q[2*PIXEL_WIDTH-1:PIXEL_WIDTH]};
    end
  endgenerate

  assign write_data = engine_i ? engine_word_i : (coarse_i ? word_q : updated);

  assign read = read_i && (engine_i ? select_i : (!coarse_i || (valid_t2_q && !same_line)));
  assign write = write_i && (engine_i ? select_i : (!coarse_i || write_q));
  // In the coarse phase the common address is a group's first word.
  assign line = write_i ? write_line_q : bin[COARSE_WIDTH-1:BIN_WIDTH];
  assign address = address_i | (coarse_i ? ADDR_WIDTH'(line) : '0);
  assign word_o = word_q;

endmodule
