// SPDX-License-Identifier: Apache-2.0
// poolPointer: one or two columns and their single-port SRAM. A word holds the words of both columns, side by side.
//
// All accesses are common to both columns but those of the coarse phase, where each column counts in a word of its
// own choice. So each counts one timestamp of two pixels, the second column two clocks behind the first:
//   clock (T0: last slot of the pair of pixels)   T2     T3          T4            T5            T6       T7
//   first column                                  read   registered  counted       written
//   second column                                                    read          registered    counted  written
// A count in the word of the count before goes on with the register, whose write may be still to come.
//
// Engine: word_o is the selected column's word and 0 if none is. What the engine writes is one column's; the other's
// is written with it, so that the word must have been read before.
// Cost at the defaults: see reports/area.md.
`include "dtof_macros.svh"

module pool_pointer_pair #(
    parameter int COLUMNS = 2,  // 1 for the last one of an odd number
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int COUNT_WIDTH = 7,
    parameter int GROUP_SIZE = 8,
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
    localparam int PIXEL_WIDTH = dtof_pkg::max_of(
        dtof_pkg::pool_track_width(DARK_LABELS, DARK_SCORE_BITS, BRIGHT_LABELS, BRIGHT_SCORE_BITS, OFFSET_BITS),
        dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES)),
    localparam int WORD_WIDTH = dtof_pkg::max_of(2 * PIXEL_WIDTH, GROUP_WIDTH),
    localparam int GROUPS = (PIXELS_PER_SRAM + GROUP_SIZE - 1) / GROUP_SIZE,
    localparam int DEPTH = GROUPS * (GROUP_SIZE / 2 + 1),
    localparam int ADDR_WIDTH = dtof_pkg::index_width(DEPTH)
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    // side band of the SRAM macros, which the technology folder gives a meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    input  logic [COLUMNS*NP-1:0] timestamp_i,
    input  logic [        NP-1:0] gate_begin_i,     // time gate, the same for a whole frame
    input  logic [        NP-1:0] gate_end_i,
    // phase, common to all columns
    input  logic                  coarse_i,
    input  logic                  point_i,
    // timestamps
    input  logic                  beat_t1_i,
    input  logic                  first_slot_t1_i,
    input  logic                  odd_t1_i,
    input  logic                  first_row_t2_i,
    input  logic                  second_row_t2_i,
    input  logic                  late_t2_i,
    input  logic                  update_t2_i,
    input  logic [           3:0] acquisition_t2_i,  // registered here: it reaches all columns
    // coarse
    input  logic                  second_column_i,  // with read_i: it is the second column's turn
    input  logic                  fresh_i,          // with read_i: the first count of a group
    input  logic                  load_i,           // a clock after read_i
    input  logic                  count_i,          // two clocks after read_i
    // SRAM
    input  logic                  read_i,
    input  logic                  write_i,
    input  logic [ADDR_WIDTH-1:0] address_i,
    input  logic                  word_load_i,      // the word read last clock
    input  logic                  group_load_i,
    // engine
    input  logic                  engine_i,         // no timestamps: engine, or clear
    input  logic                  clear_i,          // all columns' words are cleared
    input  logic [   COLUMNS-1:0] select_i,
    input  logic [WORD_WIDTH-1:0] engine_word_i,
    output logic [WORD_WIDTH-1:0] word_o
);

  localparam int COARSE_WIDTH = $clog2(dtof_pkg::POOL_COARSE_BINS);
  localparam int BINS_PER_WORD = dtof_pkg::pool_bins_per_word(WORD_WIDTH, COUNT_WIDTH);
  localparam int BIN_WIDTH = $clog2(BINS_PER_WORD);
  localparam int LINE_WIDTH = COARSE_WIDTH - BIN_WIDTH;  // which of a group's histogram words
  localparam int LAST = COLUMNS - 1;

  logic [COLUMNS*WORD_WIDTH-1:0] read_data, write_data, words, updated;
  logic [COLUMNS-1:0] valid_t2, held_valid;
  logic [COLUMNS*COARSE_WIDTH-1:0] bin_t2, held_bin;
  logic read, write, word_load;
  logic [ADDR_WIDTH-1:0] address;

  dtof_sram #(
      .PORTS(1),
      .DEPTH(DEPTH),
      .WIDTH(COLUMNS * WORD_WIDTH)
  ) u_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (sram_cfg_o),
      .read_en_i   (read),
      .read_addr_i (address),
      .read_data_o (read_data),
      .write_en_i  (write),
      .write_addr_i(address),
      .write_data_i(write_data)
  );

  // Coarse: the count under way.

  logic [COARSE_WIDTH-1:0] bin;
  logic bin_valid, same_line, fetch, second_column_q, pending_q, load_q, counted_q, write_q;
  logic [LINE_WIDTH-1:0] line, line_q, write_line_q;
  logic [BIN_WIDTH-1:0] select_q;
  logic [COUNT_WIDTH-1:0] count, next_count;
  logic counting;

  assign bin = second_column_i ? held_bin[LAST*COARSE_WIDTH+:COARSE_WIDTH] : bin_t2[COARSE_WIDTH-1:0];
  assign bin_valid = second_column_i ? (COLUMNS > 1) && held_valid[LAST] : valid_t2[0];
  assign same_line = counted_q && !fresh_i && (bin[COARSE_WIDTH-1:BIN_WIDTH] == line_q);
  assign fetch = coarse_i && read_i && bin_valid;

  always_ff @(posedge clk_i) begin
    if (read_i || engine_i) begin
      pending_q <= fetch;
      load_q <= fetch && !same_line;
      counted_q <= coarse_i && (fetch || (counted_q && !fresh_i));
      second_column_q <= second_column_i;
    end
    if (fetch) begin
      line_q <= bin[COARSE_WIDTH-1:BIN_WIDTH];
      select_q <= bin[BIN_WIDTH-1:0];
    end
    if (count_i) begin
      write_q <= pending_q;
      write_line_q <= line_q;
    end
  end

  assign next_count = (&count) ? count : count + 1'b1;

  assign counting = count_i && pending_q;

  integer k;
  always_comb begin
    count = '0;
    for (k = 0; k < COLUMNS * BINS_PER_WORD; k = k + 1) begin
      if ((second_column_q == (k >= BINS_PER_WORD)) && (select_q == BIN_WIDTH'(k % BINS_PER_WORD))) begin
        count = words[(k/BINS_PER_WORD)*WORD_WIDTH+(k%BINS_PER_WORD)*COUNT_WIDTH+:COUNT_WIDTH];
      end
    end
  end

  // Columns.

  // Registered here, since all of a word waits for them and what reaches all columns comes late.
  logic [3:0] acquisition_t3_q;
  logic track_t3_q, point_t3_q;

  always_ff @(posedge clk_i) begin
    acquisition_t3_q <= acquisition_t2_i;
    track_t3_q <= update_t2_i && !point_i;
    point_t3_q <= update_t2_i && point_i;
  end

  assign word_load = word_load_i || (load_i && load_q);

  genvar c;
  generate
    for (c = 0; c < COLUMNS; c = c + 1) begin : g_column
      logic [WORD_WIDTH-1:0] word;
      assign word = words[c*WORD_WIDTH+:WORD_WIDTH];

      pool_pointer_column #(
          .NP               (NP),
          .COUNT_WIDTH      (COUNT_WIDTH),
          .DARK_LABELS      (DARK_LABELS),
          .DARK_SCORE_BITS  (DARK_SCORE_BITS),
          .BRIGHT_LABELS    (BRIGHT_LABELS),
          .BRIGHT_SCORE_BITS(BRIGHT_SCORE_BITS),
          .BRIGHT_FROM      (BRIGHT_FROM),
          .OFFSET_BITS      (OFFSET_BITS),
          .ADVANTAGE_WIDTH  (ADVANTAGE_WIDTH),
          .POINTER_SHIFT    (POINTER_SHIFT),
          .RIVAL_MOVES      (RIVAL_MOVES),
          .TIME_GATE        (TIME_GATE)
      ) u_column (
          .clk_i           (clk_i),
          .timestamp_i     (timestamp_i[c*NP+:NP]),
          .gate_begin_i    (gate_begin_i),
          .gate_end_i      (gate_end_i),
          .point_i         (point_i),
          .beat_t1_i       (beat_t1_i),
          .first_slot_t1_i (first_slot_t1_i),
          .odd_t1_i        (odd_t1_i),
          .odd_t2_i        (acquisition_t2_i[0]),
          .first_row_t2_i  (first_row_t2_i),
          .second_row_t2_i (second_row_t2_i),
          .late_t2_i       (late_t2_i),
          .update_t2_i     (update_t2_i),
          .track_t3_i      (track_t3_q),
          .point_t3_i      (point_t3_q),
          .acquisition_t3_i(acquisition_t3_q),
          .valid_t2_o      (valid_t2[c]),
          .bin_t2_o        (bin_t2[c*COARSE_WIDTH+:COARSE_WIDTH]),
          .held_valid_o    (held_valid[c]),
          .held_bin_o      (held_bin[c*COARSE_WIDTH+:COARSE_WIDTH]),
          .read_data_i     (read_data[c*WORD_WIDTH+:WORD_WIDTH]),
          .word_load_i     (word_load),
          .group_load_i    (group_load_i),
          .counting_i      (counting && (second_column_q == (c == 1))),
          .bin_i           (select_q),
          .next_count_i    (next_count),
          .word_o          (words[c*WORD_WIDTH+:WORD_WIDTH]),
          .updated_o       (updated[c*WORD_WIDTH+:WORD_WIDTH])
      );

      assign write_data[c*WORD_WIDTH+:WORD_WIDTH] =
          engine_i ? ((select_i[c] ? engine_word_i : word) & {WORD_WIDTH{!clear_i}})
          : (coarse_i ? word : updated[c*WORD_WIDTH+:WORD_WIDTH]);
    end
  endgenerate

  integer s;
  always_comb begin
    word_o = '0;
    for (s = 0; s < COLUMNS; s = s + 1) begin
      word_o = word_o | (words[s*WORD_WIDTH+:WORD_WIDTH] & {WORD_WIDTH{select_i[s]}});
    end
  end

  // SRAM. In the coarse phase the common address is a group's first word.

  assign read = read_i && (engine_i ? |select_i : (!coarse_i || (bin_valid && !same_line)));
  assign write = write_i && (engine_i ? clear_i || |select_i : (!coarse_i || write_q));
  assign line = write_i ? write_line_q : bin[COARSE_WIDTH-1:BIN_WIDTH];
  assign address = address_i | (coarse_i ? ADDR_WIDTH'(line) : '0);

  logic unused;
  assign unused = ^{1'b0, valid_t2, held_valid, bin_t2, held_bin};

endmodule
