// SPDX-License-Identifier: Apache-2.0
// poolPointer: one or two columns with their part of a word of the SRAM that they share with another pair (dtof_pool_quad). The
// part has two halves. They hold two pixels of each of the two columns; or two groups; or, in the coarse phase, bins of a
// group, because both columns count in one histogram.
//
// All pairs access the same address in a clock. In the coarse phase a column chooses one timestamp of every two rows, and dtof_pool_bins,
// which has the schedule, adds the choices of both columns to the parts of the group's bins.
//
// A read may be optional: needs_o is high if a column of this pair has a detection that needs the word. A part of a group's bins is
// needed if a choice falls into it; the first part is read before the choices are known, so any detection needs it. A word of pixels is
// needed for its first row, or one clock later for its second row.
//
// In the other phases one dtof_pool_pixel_update computes the new words of a row's two pixels, one after the other:
//   clock (T0: last slot of a row)   T2               T3                  T4
//   first column                     distance         next word
//   second column                                     distance            next word
//   second row of the word           read the next    first pixel ahead   written; the next is registered
// The next word's first pixel has a separate register, because it may be updated while this word is written.
//
// Engine: two clocks after read_i, word_o has the word; in all other clocks this pair's contribution to word_o is 0. The words of
// neighbouring pairs are ORed from pair to pair (beside_word_i, dtof_pool_line). The low half of word_o is the half that the engine
// has selected. If eight bins need both halves, the high half of word_o is the word's high half. The engine writes one half; the
// other half, and the part of the other pair, stay as they are:
//   clock after read_i   1                                               2
//                        registered, the engine's word replaces the      written
//                        selected half (replace_i)
//
// Write data come from the word register, except a row's last pixel and the counts of the last rows, which bypass the register.
// A bit of the word register takes the SRAM's bit or one of three other values: a count, a pixel's next word, the engine's word. These
// three come in different clocks and are 0 in all others, so an OR combines them.
// Latency: POOL_PAIR_READ_CLOCKS from read_i to word_o, and to the write of an engine's word. Cost at the defaults: see reports/area.md.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_pair #(
    parameter int COLUMNS = 2,  // 1 for the last pair of an odd number of columns
    parameter int NP = 10,
    parameter int SLOTS = 2,
    parameter int COUNT_WIDTH = 7,
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    parameter int CELL_SHIFT = 9,
    parameter int TIME_GATE = 0,
    parameter int PRIOR = 0,
    parameter int BROADCAST_STAGES = 2,  // clocks from the array's control to the pair; timestamps are delayed as much
    localparam int HALF_WIDTH = dtof_pkg::pool_half_width(LABELS, SCORE_BITS, OFFSET_BITS, ADVANTAGE_WIDTH,
                                                           POINTER_SHIFT, RIVAL_MOVES),
    localparam int LINE_HALVES = dtof_pkg::pool_line_halves(HALF_WIDTH, COUNT_WIDTH),
    localparam int LINE_WIDTH = LINE_HALVES * HALF_WIDTH,
    localparam int WORD_WIDTH = 2 * HALF_WIDTH,
    localparam int PART_WIDTH = dtof_pkg::pool_part_width(LINE_HALVES)
) (
    input  logic                  clk_i,
    input  logic [COLUMNS*NP-1:0] timestamp_i,
    input  logic [        NP-1:0] gate_begin_i,     // time gate, the same for a whole frame
    input  logic [        NP-1:0] gate_end_i,
    // phase, the same for all pairs
    input  logic                  coarse_i,
    input  logic                  point_i,
    // timestamps
    input  logic                  beat_t1_i,
    input  logic                  first_slot_t1_i,
    input  logic                  last_slot_t1_i,
    input  logic                  odd_t1_i,
    input  logic                  second_row_t0_i,   // the row is a word's second row; registered here
    input  logic                  first_row_t2_i,    // coarse
    input  logic                  second_row_t2_i,
    input  logic [           3:0] acquisition_t2_i,
    input  logic [dtof_pkg::POOL_THINNING_WIDTH-1:0] thinning_t2_i,  // level, as in dtof_pair_sequencer
    // coarse
    input  logic                  keep_first_i,      // four parts: register the choices of the first two of four rows
    input  logic                  keep_last_i,       // four parts: register the choices of the last two rows
    input  logic                  optional_i,        // with read_i: columns without detections do not need the word
    input  logic                  late_i,            // with optional_i: coarse, the part is not the first; otherwise, the read is for the second row
    output logic                  needs_o,           // with optional_i: this pair needs the word
    input  logic                  load_i,            // one clock after read_i. One clock after load_i the last two rows count; with four parts first the
                                                     // first two rows, and then the last two
    input  logic                  needed_i,          // with load_i: the part was read
    input  logic [PART_WIDTH-1:0] part_i,            // with load_i: number of the part
    input  logic                  sweep_i,           // while parts would count: nothing counts, and the pair checks the bins
    input  logic                  make_room_i,       // with sweep_i: the group's second visit; low in the other phases
    // SRAM
    input  logic                  read_i,
    input  logic                  engine_load_i,     // one clock after an engine's read of this SRAM, for this pair or the other
    input  logic [WORD_WIDTH-1:0] read_data_i,       // one clock after read_i
    output logic [           3:0] write_o,           // with write_i: pixels of the word that may differ from what is stored
    output logic [WORD_WIDTH-1:0] write_data_o,
    input  logic                  first_load_i,      // one clock after the read of a word of pixels whose first row has a detection
    input  logic                  word_load_i,       // two clocks after the read, or one clock after a late read: load the word
    input  logic                  due_i,             // as word_load_i, also if no pixel has a detection and the word was not read
    input  logic                  group_load_i,      // load the group that was read in the last clock
    input  logic                  group_upper_i,     // with group_load_i: the group is in the word's upper half
    // engine
    input  logic                  engine_i,          // no timestamps: an engine's operation, or a clear
    input  logic                  replace_i,         // one clock after read_i, before write_i: the engine's word replaces the selected half
    input  logic                  clear_i,           // one clock before write_i: both halves become 0; engine_word_i is 0, too
    input  logic                  select_i,          // with read_i: this pair is selected
    input  logic                  upper_i,           // with read_i: the word's upper half is selected
    input  logic                  used_i,            // with replace_i: only the bits of used candidates are replaced
    input  logic [HALF_WIDTH-1:0] engine_word_i,     // 0 during stream phases
    input  logic [LINE_WIDTH-1:0] beside_word_i,     // OR of the pairs to the right in this segment
    output logic [LINE_WIDTH-1:0] word_o
);

  localparam int COARSE_WIDTH = $clog2(dtof_pkg::POOL_COARSE_BINS);
  localparam int LAST = COLUMNS - 1;
  localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH;
  localparam int CELLS_WIDTH = LABELS * CELL_WIDTH;
  localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS);
  localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(LABELS, SCORE_BITS, OFFSET_BITS);
  localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES);
  localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES);
  localparam int PIXEL_WIDTH = dtof_pkg::max_of(TRACK_WIDTH, POINT_WIDTH);
  // First of the highest bits of a group's background, in the group's word.
  localparam int BRIGHT_FIRST = dtof_pkg::pool_group_width(LABELS, PIXEL_WIDTH) - dtof_pkg::POOL_THINNED_BITS;

  logic [WORD_WIDTH-1:0] word_q;
  logic [COLUMNS-1:0] detected_t1, may_have_t1, detected_t2, held_valid, upper_t2;
  logic [COLUMNS-1:0] first_row_comes, second_row_comes;
  logic [COLUMNS*COARSE_WIDTH-1:0] held_bin;

  // Coarse.

  logic counts_first, counts, bins_waiting, bins_need, may_count_q;
  logic [1:0] bins_write;
  logic [WORD_WIDTH-1:0] counted_word;

  dtof_pool_bins #(
      .COLUMNS    (COLUMNS),
      .COUNT_WIDTH(COUNT_WIDTH),
      .HALF_WIDTH (HALF_WIDTH)
  ) u_bins (
      .clk_i       (clk_i),
      .valid_i     (held_valid),
      .bin_i       (held_bin),
      .keep_first_i(keep_first_i),
      .keep_last_i (keep_last_i),
      .load_i      (load_i),
      .needed_i    (needed_i),
      .may_count_i (may_count_q),
      .waiting_o   (bins_waiting),
      .needs_o     (bins_need),
      .part_i      (part_i),
      .sweep_i     (sweep_i),
      .make_room_i (make_room_i),
      .word_i      (word_q),
      .first_o     (counts_first),
      .counts_o    (counts),
      .write_o     (bins_write),
      .word_o      (counted_word)
  );

  // The word register and the candidates of its group. A word has four pixels: column c of row r is pixel 2 c + r.

  logic read_selected_q, upper_q, drives_lower_q, drives_upper_q, word_load;
  logic [1:0] replaces, replaced_q;  // halves that the engine replaces or clears
  logic [2:0] changed_q;  // pixels of the word register that have changed
  logic [CELLS_WIDTH-1:0] cells_q;
  logic bright_q;  // the group's background is so strong that its scores are thinned
  logic [PIXEL_WIDTH-1:0] moved;
  logic changes;  // `moved` differs from the pixel's word
  // [i] of turn_q: pixel i is in clock 0 of dtof_pool_pixel_update; of move_q: pixel i is in clock 1, and `moved` is its next word. A
  // pixel without a timestamp has no turn, so that the logic does not switch.
  logic [3:0] turn_q, move_q, gets_pixel, takes_pixel;
  logic [1:0] visit_t1, visit_q;  // [r]: row r of a word is complete
  logic second_row_t1_q, visit_t2;

  assign word_load = engine_load_i || word_load_i || (load_i && needed_i);

  always_ff @(posedge clk_i) begin
    if (read_i) begin
      may_count_q <= !optional_i || needs_o;
    end
    changed_q <= takes_pixel[2:0] | (changed_q & {3{!due_i}});
    if (group_load_i) begin
      cells_q <= group_upper_i ? read_data_i[HALF_WIDTH+:CELLS_WIDTH] : read_data_i[CELLS_WIDTH-1:0];
      bright_q <= (group_upper_i ? read_data_i[HALF_WIDTH+BRIGHT_FIRST+:dtof_pkg::POOL_THINNED_BITS]
                   : read_data_i[BRIGHT_FIRST+:dtof_pkg::POOL_THINNED_BITS]) != '0;
    end
    // Held in stream phases, which begin long after the engine's last read.
    if (engine_i) begin
      read_selected_q <= read_i && select_i;
      upper_q <= upper_i;
      replaced_q <= replaces | {2{clear_i}};
      drives_lower_q <= read_selected_q && !upper_q;
      drives_upper_q <= read_selected_q && upper_q;
    end
  end

  // The multiplexer in front of the register selects the SRAM's bits unless another source is due; so its selects change rarely, since
  // each change switches all bits. The last pixel of a word bypasses the register.
  logic [WORD_WIDTH-1:0] fresh, from_sram, next_word;
  logic whole_word;
  integer f;

  assign whole_word = word_load || clear_i || (counts_first && counts);
  assign gets_pixel = {1'b0, move_q[2:0]};
  assign takes_pixel = gets_pixel & {4{changes}};

  always_comb begin
    fresh = {2{engine_word_i}} | (counted_word & {WORD_WIDTH{counts_first}});
    for (f = 0; f < 3; f = f + 1) begin
      fresh[(f/2)*HALF_WIDTH+(f%2)*PIXEL_WIDTH+:PIXEL_WIDTH] = fresh[(f/2)*HALF_WIDTH+(f%2)*PIXEL_WIDTH+:PIXEL_WIDTH] | moved;
    end
  end

  assign next_word = (read_data_i & from_sram) | (fresh & ~from_sram);

  // Each pixel has a separate enable.
  genvar h;
  generate
    for (h = 0; h < 4; h = h + 1) begin : g_pixel
      localparam int FIRST = (h / 2) * HALF_WIDTH + (h % 2) * PIXEL_WIDTH;
      localparam int WIDTH = (h % 2 == 0) ? PIXEL_WIDTH : HALF_WIDTH - PIXEL_WIDTH;
      always_ff @(posedge clk_i) begin
        if (whole_word || takes_pixel[h]) begin
          word_q[FIRST+:WIDTH] <= next_word[FIRST+:WIDTH];
        end
      end
    end
  endgenerate

  // Track and point: the pixel whose turn it is.

  logic turn_valid, first_column_turn, second_column_turn, turn_thinned, thinned_t3_q;
  logic [COLUMNS-1:0] thinned_t2;
  logic [3:0] acquisition_q;
  logic [COLUMNS*NP-1:0] used_t2;
  logic [COLUMNS*LABELS-1:0] hits_t2;
  logic [NP-1:0] used_t3_q, turn_timestamp;
  logic [LABELS-1:0] hits_t3_q, turn_hits;
  logic [PIXEL_WIDTH-1:0] first_pixel_q, turn_pixel;

  assign visit_t1 = {2{last_slot_t1_i && !coarse_i}} & {second_row_t1_q, !second_row_t1_q};
  assign visit_t2 = visit_q[0] || visit_q[1];
  assign turn_valid = (turn_q != '0);
  assign second_column_turn = turn_q[2] || turn_q[3];
  assign first_column_turn = turn_q[0] || turn_q[1];
  // 0 without a turn, so that the logic behind does not switch in the coarse phase.
  assign turn_timestamp = (used_t3_q & {NP{second_column_turn}}) | (used_t2[NP-1:0] & {NP{first_column_turn}});
  assign turn_thinned = second_column_turn ? thinned_t3_q : thinned_t2[0];
  assign turn_hits = (hits_t3_q & {LABELS{second_column_turn}}) | (hits_t2[LABELS-1:0] & {LABELS{first_column_turn}});

  always_ff @(posedge clk_i) begin
    if (first_load_i) begin
      first_pixel_q <= read_data_i[PIXEL_WIDTH-1:0];
    end
  end

  assign turn_pixel = (first_pixel_q & {PIXEL_WIDTH{turn_q[0]}}) | (word_q[PIXEL_WIDTH+:PIXEL_WIDTH] & {PIXEL_WIDTH{turn_q[1]}})
      | (word_q[HALF_WIDTH+:PIXEL_WIDTH] & {PIXEL_WIDTH{turn_q[2]}})
      | (word_q[HALF_WIDTH+PIXEL_WIDTH+:PIXEL_WIDTH] & {PIXEL_WIDTH{turn_q[3]}});

  // Cell of the candidate that a word refers to as leader. It is looked up one clock before the pixel's turn, because the register of
  // the candidates may hold the next word's group afterwards. At that time the pixel's word may still be on the SRAM's output.

  localparam int LEADER_FIRST = (RIVAL_MOVES == 0) ? POINTER_WIDTH : LABELS * SCORE_BITS;
  localparam bit HAS_LEADER = (RIVAL_MOVES == 0) || (OFFSET_BITS > 0);
  logic [3:0] turn_d;
  logic leans;  // the phase uses candidates; with RIVAL_MOVES = 1 the pointer phase does not
  logic [CELL_WIDTH-1:0] leader_cell_q;

  assign leans = !coarse_i && !(RIVAL_MOVES != 0 && point_i);

  assign turn_d = {visit_q & {2{(COLUMNS > 1) && detected_t2[LAST]}}, visit_t1 & {2{detected_t1[0]}}};

  generate
    if (HAS_LEADER) begin : g_leader
      logic [LABEL_WIDTH-1:0] leader;
      // As turn_d, but early: T1 of a first column is never T2 of a second column. In clocks without a turn the result is not used.
      logic [3:0] asks;
      logic first_asks, second_asks;
      assign first_asks = leans && !visit_t2 && may_have_t1[0];
      assign second_asks = leans && COLUMNS > 1 && detected_t2[LAST];
      assign asks = {visit_q & {2{second_asks}}, {second_row_t1_q, !second_row_t1_q} & {2{first_asks}}};
      assign leader = (read_data_i[LEADER_FIRST+:LABEL_WIDTH] & {LABEL_WIDTH{asks[0] && first_load_i}})
          | (first_pixel_q[LEADER_FIRST+:LABEL_WIDTH] & {LABEL_WIDTH{asks[0] && !first_load_i}})
          | (word_q[PIXEL_WIDTH+LEADER_FIRST+:LABEL_WIDTH] & {LABEL_WIDTH{asks[1]}})
          | (read_data_i[HALF_WIDTH+LEADER_FIRST+:LABEL_WIDTH] & {LABEL_WIDTH{asks[2] && word_load_i}})
          | (word_q[HALF_WIDTH+LEADER_FIRST+:LABEL_WIDTH] & {LABEL_WIDTH{asks[2] && !word_load_i}})
          | (word_q[HALF_WIDTH+PIXEL_WIDTH+LEADER_FIRST+:LABEL_WIDTH] & {LABEL_WIDTH{asks[3]}});
      always_ff @(posedge clk_i) begin
        if (leans && turn_d != '0) begin
          leader_cell_q <= cells_q[leader*CELL_WIDTH+:CELL_WIDTH];
        end
      end
    end else begin : g_no_leader
      assign leader_cell_q = '0;
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    second_row_t1_q <= second_row_t0_i;
    visit_q <= visit_t1;
    turn_q <= turn_d;
    move_q <= turn_q;
    if (visit_t2) begin
      acquisition_q <= acquisition_t2_i;
      if (detected_t2[LAST]) begin
        used_t3_q <= used_t2[LAST*NP+:NP];
        hits_t3_q <= hits_t2[LAST*LABELS+:LABELS];
        thinned_t3_q <= thinned_t2[LAST];
      end
    end
  end

  dtof_pool_pixel_update #(
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
      .thinned_i    (turn_thinned),
      .leader_cell_i(leader_cell_q),
      .word_i       (turn_pixel),
      .acquisition_i(acquisition_q),
      .changed_o    (changes),
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
      if (c < COLUMNS) begin : g_column
        // Pointer's cell of the pixel at T1, whose word may still be on the SRAM's output. 0 unless the column compares.
        localparam int CELL_FIRST = POINTER_WIDTH - CELL_WIDTH;
        logic [CELL_WIDTH-1:0] pointer_cell, first_row_cell;
        logic compares, is_read;
        assign is_read = first_load_i || (c == 1 && word_load_i);
        // Thinned: in an early eighth of the range, for the level of this acquisition. In the track phase only in bright groups.
        assign thinned_t2[c] = (point_i || bright_q) && thinning_t2_i < ~used_t2[c*NP+NP-1-:dtof_pkg::POOL_THINNING_WIDTH];
        assign first_row_cell = (c == 0) ? first_pixel_q[CELL_FIRST+:CELL_WIDTH] : word_q[HALF_WIDTH+CELL_FIRST+:CELL_WIDTH];
        assign pointer_cell = (read_data_i[c*HALF_WIDTH+CELL_FIRST+:CELL_WIDTH] & {CELL_WIDTH{compares && is_read}})
            | (word_q[c*HALF_WIDTH+PIXEL_WIDTH+CELL_FIRST+:CELL_WIDTH] & {CELL_WIDTH{compares && !is_read && second_row_t1_q}})
            | (first_row_cell & {CELL_WIDTH{compares && !is_read && !second_row_t1_q}});

        dtof_pool_column #(
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
            .leans_i          (leans),
            .beat_t1_i        (beat_t1_i),
            .first_slot_t1_i  (first_slot_t1_i),
            .last_slot_t1_i   (last_slot_t1_i),
            .odd_t1_i         (odd_t1_i),
            .first_row_t2_i   (first_row_t2_i),
            .second_row_t2_i  (second_row_t2_i),
            .cells_i          (cells_q),
            .pointer_cell_t1_i(pointer_cell),
            .compares_t1_o    (compares),
            .detected_t1_o    (detected_t1[c]),
            .may_have_t1_o    (may_have_t1[c]),
            .comes_o          ({second_row_comes[c], first_row_comes[c]}),
            .detected_t2_o    (detected_t2[c]),
            .used_t2_o        (used_t2[c*NP+:NP]),
            .hits_t2_o        (hits_t2[c*LABELS+:LABELS]),
            .held_valid_o     (held_valid[c]),
            .held_bin_o       (held_bin[c*COARSE_WIDTH+:COARSE_WIDTH]),
            .upper_t2_o       (upper_t2[c])
        );
      end

      // Bits that do not come from the SRAM: the engine's word, 0 to clear, counts, a pixel's next word.
      logic given;
      assign replaces[c] = given;
      logic [HALF_WIDTH-1:0] given_bits, pixel_bits;
      assign given = replace_i && read_selected_q && upper_q == (c == 1);
      assign pixel_bits = {{(HALF_WIDTH - PIXEL_WIDTH) {gets_pixel[2*c+1]}}, {PIXEL_WIDTH{gets_pixel[2*c]}}};
      if (PRIOR != 0) begin : g_prior
        localparam logic [HALF_WIDTH-1:0] USED_BITS = HALF_WIDTH'((1 << LABELS) - 1) << dtof_pkg::pool_group_width(LABELS, PIXEL_WIDTH);
        assign given_bits = {HALF_WIDTH{given}} & ({HALF_WIDTH{!used_i}} | USED_BITS);
      end else begin : g_no_prior
        assign given_bits = {HALF_WIDTH{given}};
      end
      assign from_sram[c*HALF_WIDTH+:HALF_WIDTH] = ~(given_bits | pixel_bits | {HALF_WIDTH{clear_i || counts_first}});

      // Write data: the word with the counts, and the last pixel's next word, which is not in the register yet.
      assign write_data_o[c*HALF_WIDTH+:HALF_WIDTH] = {
          (c == 1 && move_q[3]) ? (HALF_WIDTH - PIXEL_WIDTH)'(moved) : counted_word[(c+1)*HALF_WIDTH-1:c*HALF_WIDTH+PIXEL_WIDTH],
          counted_word[c*HALF_WIDTH+:PIXEL_WIDTH]};
    end
  endgenerate

  // Which words this pair needs.

  logic first_part_needed, next_part_needed;
  // The first of two parts is read at T1 of the second row, the first of four at T2.
  assign first_part_needed = held_valid != '0 || ((PART_WIDTH == 1) ? may_have_t1 != '0 : bins_waiting || detected_t2 != '0);
  assign next_part_needed = (PART_WIDTH == 1) ? upper_t2 != '0 : bins_need;
  assign needs_o = coarse_i ? (late_i ? next_part_needed : first_part_needed)
      : (late_i ? second_row_comes != '0 : first_row_comes != '0);

  // Only pixels are written that have changed. In the coarse phase, and for the engine, both pixels of a half are written.
  assign write_o = engine_i ? {{2{replaced_q[1]}}, {2{replaced_q[0]}}} : coarse_i ? {{2{bins_write[1]}}, {2{bins_write[0]}}}
      : {move_q[3] && changes, changed_q};

  logic unused;
  assign unused = ^{1'b0, used_i, move_q[3], detected_t1, may_have_t1};

endmodule

`default_nettype wire
