// SPDX-License-Identifier: Apache-2.0
// poolPointer: one column. A single-port SRAM holds, one after the other in the same words, the coarse histogram
// of each group of pixels, the pixels' track words and their pointer words; behind them the groups' words.
//
// Equations: docs/poolpointer.md, Coarse, Track, Point. What needs several pixels at once (decode, choose,
// decide) is done by an engine that several columns share (pool_engine).
//
// Coarse: a pixel's timestamp is chosen while its slots pass, its histogram word is read at T2 of the last slot,
//   registered at the end of T3, counted in T4 and written in T5 (T6 for three slots). A pixel that counts in the
//   word of the pixel before it goes on with the register, whose write may be still to come.
// Track and point: an SRAM word holds two pixels. With c = 0 .. 2 SLOTS - 1 the clocks in which the timestamps of
//   the pair are at T2: at c = 2 SLOTS - 2 the next pair is read, at c = 2 SLOTS - 1 this one is written and the
//   next registered. The next group's word is read one clock earlier. A candidate's cell is looked up with a
//   pixel's first slot and kept for the others, so that the group's word may change before the pair is written.
//
//   T0 timestamp registered   T1 candidates hit   T2 word updated
//
// Engine: while engine_i the register follows selected reads and is 0 otherwise, so that columns can be ORed.
// Cost at the defaults: see reports/area.md.
`include "dtof_macros.svh"

module pool_pointer_column #(
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int COUNT_WIDTH = 8,
    parameter int GROUP_SIZE = 8,
    parameter int DARK_LABELS = 8,
    parameter int DARK_SCORE_BITS = 3,
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
    input  logic                  update_t2_i,       // a slot of the pair is at T2
    input  logic                  first_slot_t2_i,
    input  logic                  second_pixel_t2_i,
    input  logic [           1:0] dither_t2_i,       // acquisition mod 4
    input  logic                  every_16_t2_i,     // acquisition mod 16 = 0
    input  logic                  late_t2_i,
    input  logic                  fresh_t2_i,        // first pixel of a group
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
  localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS);
  localparam int SCORES_WIDTH = TRACK_WIDTH - ((OFFSET_BITS > 0) ? LABEL_WIDTH + OFFSET_BITS : 0);
  localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES);
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

  // Timestamp, and the candidates it supports.

  logic [NP-1:0] timestamp_t1_q, timestamp_t2_q;
  logic [15:0] position_t2;
  logic valid_t1, valid_t2_q, bright, bright_t2_q;
  logic [GROUP_WIDTH-1:0] group_q;
  logic [dtof_pkg::POOL_BACKGROUND_WIDTH-1:0] background;
  logic [LABELS-1:0] hits_t1, hits_t2_q;

  generate
    if (NP == 16) begin : g_position
      assign position_t2 = timestamp_t2_q;
    end else begin : g_middle_of_bin
      // The middle of a timestamp's bin; zeros follow.
      assign position_t2 = {timestamp_t2_q, 1'b1, {(15 - NP) {1'b0}}};
    end
  endgenerate

  assign valid_t1 = beat_t1_i && !(&timestamp_t1_q);
  assign background = group_q[LABELS*CELL_WIDTH+:dtof_pkg::POOL_BACKGROUND_WIDTH];
  assign bright = (BRIGHT_FROM == 0) || (background >= dtof_pkg::POOL_BACKGROUND_WIDTH'(BRIGHT_FROM));

  label_match #(
      .LABELS       (LABELS),
      .DARK_LABELS  (DARK_LABELS),
      .BRIGHT_LABELS(BRIGHT_LABELS)
  ) u_label_match (
      .valid_i (valid_t1),
      .cell_i  (timestamp_t1_q[NP-1-:CELL_WIDTH]),
      .bright_i(bright),
      .cells_i (group_q[LABELS*CELL_WIDTH-1:0]),
      .hits_o  (hits_t1)
  );

  always_ff @(posedge clk_i) begin
    timestamp_t1_q <= timestamp_i;
    timestamp_t2_q <= timestamp_t1_q;
    valid_t2_q <= valid_t1;
    bright_t2_q <= bright;
    hits_t2_q <= hits_t1;
    if (group_load_i) begin
      group_q <= read_data[GROUP_WIDTH-1:0];
    end
  end

  // Coarse: one timestamp an acquisition, the first, but the second in odd acquisitions if there is one.

  logic [COARSE_WIDTH-1:0] bin_q;
  logic bin_valid_q, only_one_q, take;
  logic same_line, fetch, pending_q, load_q, counted_q, write_q;
  logic [LINE_WIDTH-1:0] line, line_q, write_line_q;
  logic [BIN_WIDTH-1:0] select_q;
  logic [COUNT_WIDTH-1:0] count, next_count;

  assign take = valid_t1 && (first_slot_t1_i || !bin_valid_q || (odd_t1_i && only_one_q));
  assign same_line = counted_q && !fresh_t2_i && (bin_q[COARSE_WIDTH-1:BIN_WIDTH] == line_q);
  assign fetch = coarse_i && read_i && bin_valid_q;

  always_ff @(posedge clk_i) begin
    if (take) begin
      bin_q <= timestamp_t1_q[NP-1-:COARSE_WIDTH];
    end
    bin_valid_q <= valid_t1 || (bin_valid_q && !first_slot_t1_i);
    if (valid_t1 || first_slot_t1_i) begin
      only_one_q <= valid_t1 && (first_slot_t1_i || !bin_valid_q);
    end
    if (read_i || engine_i) begin
      pending_q <= fetch;
      load_q <= fetch && !same_line;
      counted_q <= coarse_i && (fetch || (counted_q && !fresh_t2_i));
    end
    if (fetch) begin
      line_q <= bin_q[COARSE_WIDTH-1:BIN_WIDTH];
      select_q <= bin_q[BIN_WIDTH-1:0];
    end
    if (count_t4_i) begin
      write_q <= pending_q;
      write_line_q <= line_q;
    end
  end

  assign count = word_q[select_q*COUNT_WIDTH+:COUNT_WIDTH];
  assign next_count = (&count) ? count : count + 1'b1;

  // Track and point: the pixel at T2.

  logic [PIXEL_WIDTH-1:0] pixel, moved;
  logic [TRACK_WIDTH-1:0] tracked;
  logic [POINT_WIDTH-1:0] pointed;
  logic [CELL_WIDTH-1:0] leader_cell, leader_cell_q;
  logic [LABEL_WIDTH-1:0] leader;
  logic leader_is_new_q, leader_is_new, swap;

  assign pixel = second_pixel_t2_i ? word_q[2*PIXEL_WIDTH-1:PIXEL_WIDTH] : word_q[PIXEL_WIDTH-1:0];
  assign leader_cell = first_slot_t2_i ? group_q[leader*CELL_WIDTH+:CELL_WIDTH] : leader_cell_q;

  generate
    if (RIVAL_MOVES != 0 && OFFSET_BITS > 0) begin : g_track_leader
      assign leader = pixel[SCORES_WIDTH+:LABEL_WIDTH];
    end else if (RIVAL_MOVES != 0) begin : g_no_leader
      assign leader = '0;
    end else if (OFFSET_BITS > 0) begin : g_either_leader
      assign leader = point_i ? pixel[POINTER_WIDTH+:LABEL_WIDTH] : pixel[SCORES_WIDTH+:LABEL_WIDTH];
    end else begin : g_point_leader
      assign leader = pixel[POINTER_WIDTH+:LABEL_WIDTH];
    end
    if (RIVAL_MOVES != 0) begin : g_leader_cell
      always_ff @(posedge clk_i) begin
        leader_cell_q <= leader_cell;
      end
      logic unused;
      assign unused = swap;
    end else begin : g_both_cells
      logic [LABEL_WIDTH-1:0] rival;
      logic [CELL_WIDTH-1:0] rival_cell, rival_cell_q;
      assign rival = pixel[POINTER_WIDTH+LABEL_WIDTH+:LABEL_WIDTH];
      assign rival_cell = first_slot_t2_i ? group_q[rival*CELL_WIDTH+:CELL_WIDTH] : rival_cell_q;
      always_ff @(posedge clk_i) begin
        leader_cell_q <= (swap && point_i) ? rival_cell : leader_cell;
        rival_cell_q <= (swap && point_i) ? leader_cell : rival_cell;
      end
    end
  endgenerate

  track_update #(
      .LABELS           (LABELS),
      .DARK_LABELS      (DARK_LABELS),
      .DARK_SCORE_BITS  (DARK_SCORE_BITS),
      .BRIGHT_LABELS    (BRIGHT_LABELS),
      .BRIGHT_SCORE_BITS(BRIGHT_SCORE_BITS),
      .OFFSET_BITS      (OFFSET_BITS)
  ) u_track_update (
      .word_i         (pixel[TRACK_WIDTH-1:0]),
      .hits_i         (hits_t2_q),
      .valid_i        (valid_t2_q),
      .position_i     (position_t2[15:6]),
      .bright_i       (bright_t2_q),
      .leader_cell_i  (leader_cell),
      .leader_is_new_i(leader_is_new_q && !first_slot_t2_i),
      .word_o         (tracked),
      .leader_is_new_o(leader_is_new)
  );

  twin_pointer_update #(
      .LABELS         (LABELS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES)
  ) u_pointer_update (
      .word_i       (pixel[POINT_WIDTH-1:0]),
      .valid_i      (valid_t2_q),
      .position_i   (position_t2),
      .hits_i       (hits_t2_q),
      .leader_cell_i(leader_cell),
      .dither_i     (dither_t2_i),
      .every_16_i   (every_16_t2_i),
      .late_i       (late_t2_i),
      .word_o       (pointed),
      .swap_o       (swap)
  );

  assign moved = point_i ? PIXEL_WIDTH'(pointed) : PIXEL_WIDTH'(tracked);

  always_ff @(posedge clk_i) begin
    leader_is_new_q <= leader_is_new;
  end

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
    end else if (update_t2_i && second_pixel_t2_i) begin
      word_d[2*PIXEL_WIDTH-1:PIXEL_WIDTH] = moved;
    end else if (update_t2_i) begin
      word_d[PIXEL_WIDTH-1:0] = moved;
    end
  end

  always_ff @(posedge clk_i) begin
    word_q <= word_d;
  end

  generate
    if (WORD_WIDTH > 2 * PIXEL_WIDTH) begin : g_padding
      assign updated = {word_q[WORD_WIDTH-1:2*PIXEL_WIDTH], moved, word_q[PIXEL_WIDTH-1:0]};
    end else begin : g_no_padding
      assign updated = {moved, word_q[PIXEL_WIDTH-1:0]};
    end
  endgenerate

  assign write_data = engine_i ? engine_word_i : (coarse_i ? word_q : updated);

  assign read = read_i && (engine_i ? select_i : (!coarse_i || (bin_valid_q && !same_line)));
  assign write = write_i && (engine_i ? select_i : (!coarse_i || write_q));
  // In the coarse phase the common address is a group's first word.
  assign line = write_i ? write_line_q : bin_q[COARSE_WIDTH-1:BIN_WIDTH];
  assign address = address_i | (coarse_i ? ADDR_WIDTH'(line) : '0);
  assign word_o = word_q;

endmodule
