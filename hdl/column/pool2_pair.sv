// SPDX-License-Identifier: Apache-2.0
// poolPointer 2: one or two columns and their single-port SRAM. A word has two halves: those of the two columns, each with
// two pixels; or two groups; or, in the coarse phase, a part of a group's bins, for both columns count in one histogram.
//
// All accesses are common to all pairs but those of the coarse phase, where each pair counts in a word of its own
// choice. Each column counts one timestamp of two pixels, the second column two clocks behind the first:
//   clock (T0: last slot of the pair of pixels)   T2     T3          T4            T5            T6       T7
//   first column                                  read   registered  counted       written
//   second column                                                    read          registered    counted  written
// A count in the word of the count before goes on with the register, whose write may be still to come.
//
// In the other phases the columns' pixels of a row are worked on one after the other by one pool2_pixel_update:
//   clock (T0: last slot of a row)   T2               T3                  T4
//   first column                     distance         next word
//   second column                                     distance            next word
//   second row of the word           read the next    first pixel ahead   written; the next is registered
// The next word's first pixel has a register of its own, for its turn may come while this word is written.
//
// Engine: what was read is on word_o two clocks after read_i; at all other times what word_o has from here is 0. The words
// of an engine's pairs are combined by OR from pair to pair (beside_word_i), so that no wire is longer than a pair. The low half
// is the half that was asked for. Where eight bins need both halves, its high half is the word's. The engine writes one half;
// the other half is written with it:
//   clock after read_i   1                                               2
//                        registered, the engine's word for the half      written
//                        that was asked for (replace_i)
//
// Everything that is written stands in the word's register before, but for a row's last pixel. What comes into a bit from
// elsewhere than the SRAM (a count, a pixel, the engine's word) comes at different times, and is 0 at all others, so that an
// OR will do.
// Cost at the defaults: see reports/area.md.
`include "dtof_macros.svh"

module pool2_pair #(
    parameter int COLUMNS = 2,  // 1 for the last one of an odd number
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SLOTS = 2,
    parameter int COUNT_WIDTH = 7,
    parameter int GROUP_SIZE = 4,
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    parameter int CELL_SHIFT = 9,
    parameter int TIME_GATE = 0,
    parameter int PRIOR = 0,
    parameter int BROADCAST_STAGES = 2,  // clocks that a command is on its way, for which timestamps wait
    localparam int HALF_WIDTH = dtof_pkg::pool2_half_width(LABELS, SCORE_BITS, OFFSET_BITS, ADVANTAGE_WIDTH,
                                                           POINTER_SHIFT, RIVAL_MOVES),
    localparam int LINE_HALVES = dtof_pkg::pool2_line_halves(HALF_WIDTH, COUNT_WIDTH),
    localparam int LINE_WIDTH = LINE_HALVES * HALF_WIDTH,
    localparam int WORD_WIDTH = 2 * HALF_WIDTH,
    localparam int GROUPS = (PIXELS_PER_SRAM + GROUP_SIZE - 1) / GROUP_SIZE,
    localparam int DEPTH = GROUPS * (GROUP_SIZE / 2) + (GROUPS + 1) / 2,
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
    // phase, common to all pairs
    input  logic                  coarse_i,
    input  logic                  point_i,
    // timestamps
    input  logic                  beat_t1_i,
    input  logic                  first_slot_t1_i,
    input  logic                  last_slot_t1_i,
    input  logic                  odd_t1_i,
    input  logic                  second_row_t0_i,   // it is a word's second row; registered here
    input  logic                  first_row_t2_i,    // coarse
    input  logic                  second_row_t2_i,
    input  logic [           3:0] acquisition_t2_i,
    // coarse
    input  logic                  second_column_i,   // with read_i: it is the second column's turn
    input  logic                  fresh_i,           // with read_i: the first count of a group
    input  logic                  load_i,            // a clock after read_i
    input  logic                  count_i,           // two clocks after read_i
    // SRAM
    input  logic                  read_i,
    input  logic                  write_i,
    input  logic [ADDR_WIDTH-1:0] address_i,
    input  logic                  word_load_d_i,     // the word read in this clock is to be loaded; registered here
    input  logic                  group_load_i,      // the group read last clock
    input  logic                  group_upper_i,     // with group_load_i: it is the word's upper half
    // engine
    input  logic                  engine_i,          // no timestamps: engine, or clear
    input  logic                  replace_i,         // a clock after read_i and before write_i: the half is the engine's
    input  logic                  clear_i,           // a clock before write_i: both halves are 0, as is engine_word_i
    input  logic                  select_i,          // with read_i: this pair
    input  logic                  upper_i,           // with read_i: the word's upper half
    input  logic                  used_i,            // with replace_i: of that half only which candidates are used
    input  logic [HALF_WIDTH-1:0] engine_word_i,     // 0 while timestamps come
    input  logic [LINE_WIDTH-1:0] beside_word_i,     // of the pairs beyond this one, seen from the engine
    output logic [LINE_WIDTH-1:0] word_o
);

  localparam int COARSE_WIDTH = $clog2(dtof_pkg::POOL_COARSE_BINS);
  localparam int HALF_BINS = dtof_pkg::POOL2_BINS_PER_LINE / LINE_HALVES;
  localparam int PLACE_WIDTH = $clog2(2 * HALF_BINS);  // of a bin in a word
  localparam int GROUP_WORD_WIDTH = COARSE_WIDTH - PLACE_WIDTH;  // of a word in a group
  localparam int LAST = COLUMNS - 1;
  localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH;
  localparam int CELLS_WIDTH = LABELS * CELL_WIDTH;
  localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS);
  localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(LABELS, SCORE_BITS, OFFSET_BITS);
  localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES);
  localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES);
  localparam int PIXEL_WIDTH = dtof_pkg::max_of(TRACK_WIDTH, POINT_WIDTH);
  localparam bit ONE_WORD = PIXELS_PER_SRAM <= 2;  // it stays in the register for a whole phase

  logic [WORD_WIDTH-1:0] read_data, write_data, word_q;
  logic [COLUMNS-1:0] detected_t1, detected_t2, valid_t2, held_valid;
  logic [COLUMNS*COARSE_WIDTH-1:0] bin_t2, held_bin;
  logic read, write;
  logic [ADDR_WIDTH-1:0] address;

  dtof_sram #(
      .PORTS(1),
      .DEPTH(DEPTH),
      .WIDTH(WORD_WIDTH)
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
  logic bin_valid, same_word, fetch, pending_q, load_q, counted_q, write_q;
  logic [GROUP_WORD_WIDTH-1:0] group_word, group_word_q, write_group_word_q;
  logic [PLACE_WIDTH-1:0] place_q;
  logic [COUNT_WIDTH-1:0] count, next_count;

  assign bin = second_column_i ? held_bin[LAST*COARSE_WIDTH+:COARSE_WIDTH] : bin_t2[COARSE_WIDTH-1:0];
  assign bin_valid = second_column_i ? (COLUMNS > 1) && held_valid[LAST] : valid_t2[0];
  assign same_word = counted_q && !fresh_i && (bin[COARSE_WIDTH-1:PLACE_WIDTH] == group_word_q);
  assign fetch = coarse_i && read_i && bin_valid;

  always_ff @(posedge clk_i) begin
    if (read_i || engine_i) begin
      pending_q <= fetch;
      load_q <= fetch && !same_word;
      counted_q <= coarse_i && (fetch || (counted_q && !fresh_i));
    end
    if (fetch) begin
      {group_word_q, place_q} <= bin;
    end
    if (count_i) begin
      write_q <= pending_q;
      write_group_word_q <= group_word_q;
    end
  end

  assign next_count = (&count) ? count : count + COUNT_WIDTH'(pending_q);

  // One place at most, and none while nothing is counted, so that the count rests then.
  logic [2*HALF_BINS-1:0] counts_here;
  integer b;
  always_comb begin
    count = '0;
    for (b = 0; b < 2 * HALF_BINS; b = b + 1) begin
      counts_here[b] = pending_q && (place_q == PLACE_WIDTH'(b));
      count = count | (word_q[(b/HALF_BINS)*HALF_WIDTH+(b%HALF_BINS)*COUNT_WIDTH+:COUNT_WIDTH] & {COUNT_WIDTH{counts_here[b]}});
    end
  end

  // The word in work, and the group of its pixels. A word has four pixels: column c of row r is pixel 2 c + r.

  logic read_selected_q, upper_q, replaced_q, drives_lower_q, drives_upper_q, ahead_q, word_load_q, word_load, changed_q;
  logic [CELLS_WIDTH-1:0] cells_q;
  logic [PIXEL_WIDTH-1:0] moved;
  // Which pixel's distance is found, and which one moved is for. A pixel without a timestamp has no turn, so that nothing
  // moves for it.
  logic [3:0] turn_q, move_q;
  logic [1:0] visit_t1, visit_q;  // whose row is complete
  logic second_row_t1_q, visit_t2;

  assign word_load = read_selected_q || word_load_q || (load_i && load_q);

  always_ff @(posedge clk_i) begin
    ahead_q <= word_load_d_i;
    word_load_q <= ahead_q;
    changed_q <= (visit_t2 && (detected_t2 != '0)) || (changed_q && !word_load_q);
    if (group_load_i) begin
      cells_q <= group_upper_i ? read_data[HALF_WIDTH+:CELLS_WIDTH] : read_data[CELLS_WIDTH-1:0];
    end
    // Timestamps begin when the engine's last read is long done.
    if (engine_i) begin
      read_selected_q <= read_i && select_i;
      upper_q <= upper_i;
      replaced_q <= clear_i || (replace_i && read_selected_q);
      drives_lower_q <= read_selected_q && !upper_q;
      drives_upper_q <= read_selected_q && upper_q;
    end
  end

  // What is not from the SRAM.
  logic [WORD_WIDTH-1:0] fresh, from_sram, next_word;
  integer f;
  always_comb begin
    fresh = {2{engine_word_i}};
    for (f = 0; f < 2 * HALF_BINS; f = f + 1) begin
      fresh[(f/HALF_BINS)*HALF_WIDTH+(f%HALF_BINS)*COUNT_WIDTH+:COUNT_WIDTH] =
          fresh[(f/HALF_BINS)*HALF_WIDTH+(f%HALF_BINS)*COUNT_WIDTH+:COUNT_WIDTH] | next_count;
    end
    for (f = 0; f < 4; f = f + 1) begin
      fresh[(f/2)*HALF_WIDTH+(f%2)*PIXEL_WIDTH+:PIXEL_WIDTH] = fresh[(f/2)*HALF_WIDTH+(f%2)*PIXEL_WIDTH+:PIXEL_WIDTH] | moved;
    end
  end

  assign next_word = (read_data & from_sram) | (fresh & ~from_sram);

  // Each bin and each pixel has an enable of its own. The last pixel of a word goes straight to the SRAM.
  integer i;
  always_ff @(posedge clk_i) begin
    for (i = 0; i < 2 * HALF_BINS; i = i + 1) begin
      if (count_i && counts_here[i]) begin
        word_q[(i/HALF_BINS)*HALF_WIDTH+(i%HALF_BINS)*COUNT_WIDTH+:COUNT_WIDTH] <=
            next_word[(i/HALF_BINS)*HALF_WIDTH+(i%HALF_BINS)*COUNT_WIDTH+:COUNT_WIDTH];
      end
    end
    for (i = 0; i < 4; i = i + 1) begin
      if (move_q[i] && (i < 3 || ONE_WORD)) begin
        word_q[(i/2)*HALF_WIDTH+(i%2)*PIXEL_WIDTH+:PIXEL_WIDTH] <= next_word[(i/2)*HALF_WIDTH+(i%2)*PIXEL_WIDTH+:PIXEL_WIDTH];
      end
    end
    if (word_load || clear_i) begin
      word_q <= next_word;
    end
  end

  // Track and point: whose turn it is.

  logic turn_valid, second_column_turn;
  logic [3:0] acquisition_q;
  logic [COLUMNS*NP-1:0] used_t2;
  logic [COLUMNS*LABELS-1:0] hits_t2;
  logic [NP-1:0] used_t3_q, turn_timestamp;
  logic [LABELS-1:0] hits_t3_q, turn_hits;
  logic [PIXEL_WIDTH-1:0] first_pixel, turn_pixel;
  logic [CELL_WIDTH-1:0] last_leader_cell_q, leader_cell;

  assign visit_t1 = {2{last_slot_t1_i && !coarse_i}} & {second_row_t1_q, !second_row_t1_q};
  assign visit_t2 = visit_q[0] || visit_q[1];
  assign turn_valid = (turn_q != '0);
  assign second_column_turn = turn_q[2] || turn_q[3];
  assign turn_timestamp = second_column_turn ? used_t3_q : used_t2[NP-1:0];
  assign turn_hits = second_column_turn ? hits_t3_q : hits_t2[LABELS-1:0];

  generate
    if (ONE_WORD) begin : g_one_word
      assign first_pixel = word_q[PIXEL_WIDTH-1:0];
    end else begin : g_words
      logic [PIXEL_WIDTH-1:0] first_pixel_q;
      always_ff @(posedge clk_i) begin
        if (ahead_q) begin
          first_pixel_q <= read_data[PIXEL_WIDTH-1:0];
        end
      end
      assign first_pixel = first_pixel_q;
    end
  endgenerate

  assign turn_pixel = (first_pixel & {PIXEL_WIDTH{turn_q[0]}}) | (word_q[PIXEL_WIDTH+:PIXEL_WIDTH] & {PIXEL_WIDTH{turn_q[1]}})
      | (word_q[HALF_WIDTH+:PIXEL_WIDTH] & {PIXEL_WIDTH{turn_q[2]}})
      | (word_q[HALF_WIDTH+PIXEL_WIDTH+:PIXEL_WIDTH] & {PIXEL_WIDTH{turn_q[3]}});

  // The candidate that a word leans on. That of a word's last pixel is taken a clock before its turn, in which the next word's
  // group may be there.

  function automatic logic [CELL_WIDTH-1:0] cell_of_leader(input logic [PIXEL_WIDTH-1:0] word, input logic point,
                                                          input logic [CELLS_WIDTH-1:0] cells);
    logic [LABEL_WIDTH-1:0] leader;
    leader = (RIVAL_MOVES == 0 && (point || OFFSET_BITS == 0)) ? LABEL_WIDTH'(word >> POINTER_WIDTH)
        : (OFFSET_BITS > 0) ? LABEL_WIDTH'(word >> (LABELS * SCORE_BITS)) : '0;
    cell_of_leader = cells[leader*CELL_WIDTH+:CELL_WIDTH];
  endfunction

  assign leader_cell = turn_q[3] ? last_leader_cell_q : cell_of_leader(turn_pixel, point_i, cells_q);

  always_ff @(posedge clk_i) begin
    second_row_t1_q <= second_row_t0_i;
    visit_q <= visit_t1;
    turn_q <= {visit_q & {2{(COLUMNS > 1) && detected_t2[LAST]}}, visit_t1 & {2{detected_t1[0]}}};
    move_q <= turn_q;
    if (visit_q[1]) begin
      last_leader_cell_q <= cell_of_leader(word_q[HALF_WIDTH+PIXEL_WIDTH+:PIXEL_WIDTH], point_i, cells_q);
    end
    if (visit_t2) begin
      acquisition_q <= acquisition_t2_i;
      if (detected_t2[LAST]) begin
        used_t3_q <= used_t2[LAST*NP+:NP];
        hits_t3_q <= hits_t2[LAST*LABELS+:LABELS];
      end
    end
  end

  pool2_pixel_update #(
      .NP             (NP),
      .LABELS         (LABELS),
      .SCORE_BITS     (SCORE_BITS),
      .OFFSET_BITS    (OFFSET_BITS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES),
      .CELL_SHIFT     (CELL_SHIFT)
  ) u_pixel_update (
      .clk_i        (clk_i),
      .track_i      (!engine_i && !coarse_i && !point_i),
      .point_i      (!engine_i && point_i),
      .valid_i      (turn_valid),
      .timestamp_i  (turn_timestamp),
      .hits_i       (turn_hits),
      .leader_cell_i(leader_cell),
      .word_i       (turn_pixel),
      .acquisition_i(acquisition_q),
      .word_o       (moved)
  );

  assign word_o[HALF_WIDTH-1:0] = beside_word_i[HALF_WIDTH-1:0] | (word_q[HALF_WIDTH-1:0] & {HALF_WIDTH{drives_lower_q}})
      | (word_q[WORD_WIDTH-1:HALF_WIDTH] & {HALF_WIDTH{drives_upper_q}});

  generate
    if (LINE_HALVES == 2) begin : g_whole_word
      assign word_o[WORD_WIDTH-1:HALF_WIDTH] = beside_word_i[WORD_WIDTH-1:HALF_WIDTH]
          | (word_q[WORD_WIDTH-1:HALF_WIDTH] & {HALF_WIDTH{drives_lower_q}});
    end
  endgenerate

  // Columns.

  genvar c;
  generate
    for (c = 0; c < 2; c = c + 1) begin : g_half
      logic [HALF_WIDTH-1:0] half;
      assign half = word_q[c*HALF_WIDTH+:HALF_WIDTH];

      if (c < COLUMNS) begin : g_column
        // The pointer's cell of the pixel at T1, which may be still to be registered.
        localparam int CELL_FIRST = POINTER_WIDTH - CELL_WIDTH;
        logic [CELL_WIDTH-1:0] pointer_cell;
        assign pointer_cell = (ahead_q || (c == 1 && word_load_q)) ? read_data[c*HALF_WIDTH+CELL_FIRST+:CELL_WIDTH]
            : second_row_t1_q ? half[PIXEL_WIDTH+CELL_FIRST+:CELL_WIDTH]
            : (c == 0) ? first_pixel[CELL_FIRST+:CELL_WIDTH] : half[CELL_FIRST+:CELL_WIDTH];

        pool2_column #(
            .NP              (NP),
            .SLOTS           (SLOTS),
            .LABELS          (LABELS),
            .RIVAL_MOVES     (RIVAL_MOVES),
            .TIME_GATE       (TIME_GATE),
            .BROADCAST_STAGES(BROADCAST_STAGES)
        ) u_column (
            .clk_i            (clk_i),
            .timestamp_i      (timestamp_i[c*NP+:NP]),
            .gate_begin_i     (gate_begin_i),
            .gate_end_i       (gate_end_i),
            .point_i          (point_i),
            .beat_t1_i        (beat_t1_i),
            .first_slot_t1_i  (first_slot_t1_i),
            .last_slot_t1_i   (last_slot_t1_i),
            .odd_t1_i         (odd_t1_i),
            .first_row_t2_i   (first_row_t2_i),
            .second_row_t2_i  (second_row_t2_i),
            .cells_i          (cells_q),
            .pointer_cell_t1_i(pointer_cell),
            .detected_t1_o    (detected_t1[c]),
            .detected_t2_o    (detected_t2[c]),
            .used_t2_o        (used_t2[c*NP+:NP]),
            .hits_t2_o        (hits_t2[c*LABELS+:LABELS]),
            .valid_t2_o       (valid_t2[c]),
            .bin_t2_o         (bin_t2[c*COARSE_WIDTH+:COARSE_WIDTH]),
            .held_valid_o     (held_valid[c]),
            .held_bin_o       (held_bin[c*COARSE_WIDTH+:COARSE_WIDTH])
        );
      end

      // Which bits come from the SRAM when a word is loaded. The rest is the engine's, or 0 to clear.
      logic given;
      assign given = replace_i && read_selected_q && upper_q == (c == 1);
      if (PRIOR != 0) begin : g_prior
        localparam logic [HALF_WIDTH-1:0] USED_BITS = HALF_WIDTH'((1 << LABELS) - 1) << dtof_pkg::pool_group_width(LABELS, PIXEL_WIDTH);
        assign from_sram[c*HALF_WIDTH+:HALF_WIDTH] = {HALF_WIDTH{word_load}}
            & ~({HALF_WIDTH{given}} & ({HALF_WIDTH{!used_i}} | USED_BITS));
      end else begin : g_no_prior
        assign from_sram[c*HALF_WIDTH+:HALF_WIDTH] = {HALF_WIDTH{word_load && !given}};
      end

      // What is written: the word as it is. The last pixel is on its way.
      assign write_data[c*HALF_WIDTH+:HALF_WIDTH] = {
          (c == 1 && move_q[3]) ? (HALF_WIDTH - PIXEL_WIDTH)'(moved) : half[HALF_WIDTH-1:PIXEL_WIDTH], half[PIXEL_WIDTH-1:0]};
    end
  endgenerate

  // SRAM. In the coarse phase the common address is a group's first word. Pixels without a timestamp stay what they are, and
  // a word of them alone is not written.

  assign read = read_i && (engine_i ? select_i : (!coarse_i || (bin_valid && !same_word)));
  assign write = write_i && (engine_i ? replaced_q : (coarse_i ? write_q : changed_q));
  assign group_word = write_i ? write_group_word_q : bin[COARSE_WIDTH-1:PLACE_WIDTH];
  assign address = address_i | (coarse_i ? ADDR_WIDTH'(group_word) : '0);

  logic unused;
  assign unused = ^{1'b0, valid_t2, held_valid, bin_t2, held_bin, used_i, move_q[3], detected_t1};

endmodule
