// SPDX-License-Identifier: Apache-2.0
// poolPointer, coarse phase: adds the choices of a pair's columns to the coarse bins in the pair's word, and checks them in a sweep.
//
// Equations (docs/reference/poolpointer.md, Coarse): a bin into which n choices fall becomes min(bin + n, 2^COUNT_WIDTH - 1). If a bin of
// the group is full in a sweep, the sweep subtracts 2^(COUNT_WIDTH - 2), a quarter of the range, from every bin. If a bin is below that
// quarter, the sweep instead freezes the group, which then counts nothing until the next clear.
//
// A group's bins are two parts, and each part is a word. A part adds the choices of both columns that fall into it, up to two bins in a
// clock:
//   clock (T0: last slot of the two rows)   T1            T2          T3                    T4
//   first part                              read          registered  counted and written
//   second part                                           read        registered            counted and written
// The choice is available at T2, so the second part is read only if a choice falls into it, and in a sweep (dtof_pool_quad).
// With LINE_HALVES = 2 there are four parts, for which the clocks of two rows do not suffice. Four rows count together:
//   clock (T0: last slot of the four rows)  T2            T3          T4                    T5
//   first part                              read          registered  first two rows count  last two rows count, written
//   next part                                                         read                  registered
// In a sweep nothing counts. In the group's first visit the module checks each part in the clock in which it would count. In the second
// visit, if a bin was full, it subtracts a quarter of the range from every bin. If a bin was below that quarter, it instead sets the
// frozen bit of every part.
//
// Latency: none from word_i to word_o; 1 clock from load_i to the first two rows' counts (with two parts: the counts).
// Cost: for each bin of a word an incrementer by one or two and two comparators; four flip-flops. With four parts also registers for six
// choices, four comparators of a part, and three flip-flops.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_bins #(
    parameter int COLUMNS = 2,  // 1 or 2
    parameter int COUNT_WIDTH = 7,
    parameter int HALF_WIDTH = 58,
    localparam int LINE_HALVES = dtof_pkg::pool_line_halves(HALF_WIDTH, COUNT_WIDTH),
    localparam int WORD_WIDTH = 2 * HALF_WIDTH,
    localparam int PART_WIDTH = dtof_pkg::pool_part_width(LINE_HALVES),
    localparam int COARSE_WIDTH = $clog2(dtof_pkg::POOL_COARSE_BINS)
) (
    input  logic                            clk_i,
    // the columns' choices
    input  logic [             COLUMNS-1:0] valid_i,
    input  logic [COLUMNS*COARSE_WIDTH-1:0] bin_i,
    input  logic                            keep_first_i,  // four parts: register the choices of the first two of four rows
    input  logic                            keep_last_i,   // four parts: register the choices of the last two rows
    // the part
    input  logic                            load_i,        // word_i has the part in the next clock; with four parts for two clocks
    input  logic                            needed_i,      // with load_i: the part was read, because a choice of one of the two pairs may fall into it
    input  logic                            may_count_i,   // four parts, one clock after load_i: a choice of this pair may fall into the part, or it is a sweep
    output logic                            waiting_o,     // four parts: the choices of the first two of four rows have a detection
    output logic                            needs_o,       // four parts: a choice falls into the part after the one that was loaded last
    input  logic [          PART_WIDTH-1:0] part_i,        // with load_i: number of the part
    input  logic                            sweep_i,       // while parts would count: nothing counts, and the bins are checked
    input  logic                            make_room_i,   // with sweep_i: the group's second visit; low in the other phases
    input  logic [          WORD_WIDTH-1:0] word_i,
    output logic                            first_o,       // four parts: the first two rows may count
    output logic                            counts_o,      // a choice counts
    output logic [                     1:0] write_o,       // in the clock in which the part is written: its half may differ from what was read
    output logic [          WORD_WIDTH-1:0] word_o         // word_i with the counts; word_i where nothing counts and no room is made
);

  localparam int HALF_BINS = dtof_pkg::POOL_BINS_PER_LINE / LINE_HALVES;
  localparam int PLACE_WIDTH = COARSE_WIDTH - PART_WIDTH;  // place of a bin in a word

  // Choices, each {bin, valid}. Two choices count at a time, possibly in the same bin.

  localparam int CHOICE_WIDTH = COARSE_WIDTH + 1;
  logic [2*CHOICE_WIDTH-1:0] chosen;
  logic count_q;
  logic [1:0] counts_here, counts_in_half, counted_before;
  logic [2*PLACE_WIDTH-1:0] places;
  logic [PART_WIDTH-1:0] part_q;

  assign counts_o = (counts_here != '0);

  // The highest bit of a bin's place selects the half.
  logic [1:0] upper;
  assign upper = {places[2*PLACE_WIDTH-1], places[PLACE_WIDTH-1]};
  assign counts_in_half = {(counts_here & upper) != '0, (counts_here & ~upper) != '0};

  always_ff @(posedge clk_i) begin
    count_q <= load_i && needed_i;
    if (load_i) begin
      part_q <= part_i;
    end
  end

  // Sweep. In every part, the frozen bit is the first bit above the lower half's bins.

  localparam int FROZEN_BIT = HALF_BINS * COUNT_WIDTH;
  logic full_q, low_q;  // some bin of the group is full, or below a quarter of its range
  logic first_part, rests, full_here, low_here, takes_quarter, freezes;

  assign first_part = (part_q == '0);
  assign rests = sweep_i || word_i[FROZEN_BIT];
  assign takes_quarter = make_room_i && full_q && !low_q;
  assign freezes = make_room_i && full_q && low_q;
  assign write_o = counted_before | counts_in_half | {2{make_room_i && full_q}};

  always_ff @(posedge clk_i) begin
    if (count_q && sweep_i && !make_room_i) begin
      full_q <= (full_here && !word_i[FROZEN_BIT]) || (full_q && !first_part);
      low_q <= low_here || (low_q && !first_part);
    end
  end

  generate
    if (COLUMNS == 2) begin : g_both_choose
      assign chosen = {bin_i[COARSE_WIDTH+:COARSE_WIDTH], valid_i[1], bin_i[COARSE_WIDTH-1:0], valid_i[0]};
    end else begin : g_one_chooses
      assign chosen = {{CHOICE_WIDTH{1'b0}}, bin_i, valid_i};
    end
  endgenerate

  genvar d;
  generate
    if (PART_WIDTH == 1) begin : g_two_parts
      // The choices hold until both parts have counted.
      for (d = 0; d < 2; d = d + 1) begin : g_choice
        logic valid, part;
        assign {part, places[d*PLACE_WIDTH+:PLACE_WIDTH], valid} = chosen[d*CHOICE_WIDTH+:CHOICE_WIDTH];
        assign counts_here[d] = count_q && valid && (part == part_q) && !rests;
      end
      assign first_o = 1'b0;
      assign counted_before = '0;
      assign waiting_o = 1'b0;
      assign needs_o = 1'b0;
      logic unused_keep;
      assign unused_keep = ^{keep_first_i, keep_last_i, may_count_i};
    end else begin : g_four_parts
      // The next four rows' first choices arrive before these choices have counted in all parts.
      logic [2*CHOICE_WIDTH-1:0] waiting_q, first_q, last_q, counted;
      logic count_last_q;
      logic [1:0] counted_q;
      logic [PART_WIDTH-1:0] next_part;
      logic [3:0] needed;
      assign counted = count_last_q ? last_q : first_q;
      assign first_o = count_q && may_count_i;
      assign counted_before = counted_q & {2{count_last_q}};
      always_ff @(posedge clk_i) begin
        count_last_q <= count_q;
        if (keep_first_i) begin
          waiting_q <= chosen;
        end
        if (keep_last_i) begin
          first_q <= waiting_q;
          last_q <= chosen;
        end
        if (count_q) begin
          counted_q <= counts_in_half;
        end
      end
      assign next_part = part_q + 1'b1;
      assign waiting_o = waiting_q[0] || waiting_q[CHOICE_WIDTH];
      assign needs_o = needed != '0;
      for (d = 0; d < 4; d = d + 1) begin : g_needed
        localparam int FIRST = (d % 2) * CHOICE_WIDTH;
        logic valid;
        logic [PART_WIDTH-1:0] part;
        assign valid = (d < 2) ? first_q[FIRST] : last_q[FIRST];
        assign part = (d < 2) ? first_q[FIRST+CHOICE_WIDTH-1-:PART_WIDTH] : last_q[FIRST+CHOICE_WIDTH-1-:PART_WIDTH];
        assign needed[d] = valid && part == next_part;
      end
      for (d = 0; d < 2; d = d + 1) begin : g_choice
        logic valid;
        logic [PART_WIDTH-1:0] part;
        assign {part, places[d*PLACE_WIDTH+:PLACE_WIDTH], valid} = counted[d*CHOICE_WIDTH+:CHOICE_WIDTH];
        assign counts_here[d] = (count_q || count_last_q) && valid && (part == part_q) && !rests;
      end
    end
  endgenerate

  logic [2*HALF_BINS-1:0] full_bins, low_bins;
  assign full_here = (full_bins != '0);
  assign low_here = (low_bins != '0);

  genvar b, n;
  generate
    for (b = 0; b < 2 * HALF_BINS; b = b + 1) begin : g_bin
      localparam int FIRST = (b / HALF_BINS) * HALF_WIDTH + (b % HALF_BINS) * COUNT_WIDTH;
      logic first_counts, second_counts, one, two, full_above, first_carry, carry;
      logic [COUNT_WIDTH-1:0] bin, count;
      assign bin = word_i[FIRST+:COUNT_WIDTH];
      assign full_bins[b] = &bin;
      assign low_bins[b] = (bin[COUNT_WIDTH-1-:2] == 2'd0);
      assign first_counts = counts_here[0] && (places[PLACE_WIDTH-1:0] == PLACE_WIDTH'(b));
      assign second_counts = counts_here[1] && (places[PLACE_WIDTH+:PLACE_WIDTH] == PLACE_WIDTH'(b));
      assign one = first_counts ^ second_counts;
      assign two = first_counts && second_counts;
      // Adds one or two and saturates: the increment is suppressed where the bin has no room for it.
      assign full_above = &bin[COUNT_WIDTH-1:1];
      assign count = {bin[COUNT_WIDTH-1] && (bin[COUNT_WIDTH-2] || !takes_quarter), bin[COUNT_WIDTH-2] ^ takes_quarter,
                      bin[COUNT_WIDTH-3:0]};
      assign first_carry = one && !full_bins[b];
      assign carry = (count[0] && first_carry) || (two && !full_above);
      assign word_o[FIRST+:2] = {count[1] ^ carry, (count[0] ^ first_carry) || (two && full_above)};
      for (n = 2; n < COUNT_WIDTH; n = n + 1) begin : g_high
        assign word_o[FIRST+n] = count[n] ^ (carry && (&count[n-1:1]));
      end
    end
    // Bits of a half above its bins.
    for (b = 0; b < 2; b = b + 1) begin : g_rest
      localparam int FIRST = b * HALF_WIDTH + HALF_BINS * COUNT_WIDTH;
      localparam int WIDTH = HALF_WIDTH - HALF_BINS * COUNT_WIDTH;
      assign word_o[FIRST+:WIDTH] = word_i[FIRST+:WIDTH] | WIDTH'(freezes && b == 0);
    end
  endgenerate

endmodule

`default_nettype wire
