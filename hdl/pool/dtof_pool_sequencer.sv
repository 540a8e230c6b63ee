// SPDX-License-Identifier: Apache-2.0
// poolPointer: gives all engines and their columns their commands, in lockstep, once per array.
//
// 1. The controller starts one of three operations. The engines work on their pairs (decode) or on their columns (choose, decide)
//    one after the other. An operation consists of steps; all steps of an operation have the same number of clocks.
// 2. Decode: a step is a group. The bins of the group and of its four neighbours are read, eight at a time, and enter the
//    decoder's ring, one bin per clock. Then the ring turns once per candidate, and the group's word is written.
// 3. Choose and decide: a step is a pixel of a chain (docs/reference/poolpointer.md, Chain). The first pass runs from a column's last
//    pixel to its first and stores the messages; the second pass runs back. A pixel is fetched three steps before it is this pixel: it is
//    prepared in the first step, gets the evidence of the neighbouring columns in the second, and is the next pixel in the third, in
//    which its labels pass. The best two labels of this pixel are known early in the following step. One step later those of the pixel
//    below are known, too, and this pixel's position moves towards its neighbours' positions. Choose then makes the first pointer
//    word (without SMOOTH_STARTS one step earlier) and writes two words together. Decide then makes its result, and stalls in the first
//    clock of a step while the output has no room.
// 4. The scratch memory has two fields per row: the message of the first pass, and the best label of the column to the left, not yet
//    moved. The second field is read for choose's evidence; it is read again with each write of a message, because both fields are
//    written together; and it is read in the second pass, before the column's own best label replaces it.
// 5. With PRIOR = 1 decode also reads a group's word of the last frame before it writes the new word. Choose also writes which
//    candidates of a group are used, one step after the group's last pair of pixels.
//
// Schedule: the table below. Each line gives the clocks t of a step in which a command is given. Columns and engines receive it one
//   clock later; their own latencies are in dtof_pkg.
// Latency with K labels: decode (32 K + 48) clocks per group of a pair, without significances (32 K + 45). Choose max(K + 5, 9) clocks
//   per step, with (pixels + 4) and (pixels + 5) steps in a column's two passes, without SMOOTH_STARTS twice (pixels + 4). Decide 6 clocks per
//   step, with (pixels + 4) and (pixels + 5) steps. With PRIOR = 1 choose has one more step per column, two if the number of pixels is odd.
// Cost: counters and a register of the commands, per array.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_sequencer `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int PIXELS_PER_SRAM = 160,  // rows of a column
    parameter int GROUP_SIZE = 4,         // rows of a group
    parameter int LABELS = 5,             // candidates of a group, 2 to 8
    parameter int LINE_HALVES = 1,        // halves of a word that eight bins occupy, 1 or 2
    parameter int ENGINE_COLUMNS = 34,    // columns of an engine
    parameter int SMOOTH_STARTS = 1,      // 1: the start of a pixel's pointer moves closer to its neighbours' starts
    parameter int PRIOR = 0,              // 1: candidates used in the last frame raise their pair sums
    parameter int SIGNIFICANCE_WIDTH = 3,  // bits of a candidate's significance that a group's word keeps; 0: none
    localparam int GROUPS = (PIXELS_PER_SRAM + GROUP_SIZE - 1) / GROUP_SIZE,
    localparam int PIXEL_WORDS = GROUPS * (GROUP_SIZE / 2),
    localparam int GROUP_WORDS = (GROUPS + 1) / 2,
    localparam int ADDR_WIDTH = dtof_pkg::index_width(PIXEL_WORDS + GROUP_WORDS),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(ENGINE_COLUMNS),
    localparam int PAIRS = (ENGINE_COLUMNS + 1) / 2
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    // high for one clock to start an operation: one at a time, and not before done_o of the operation before
    input  logic                    decode_i,
    input  logic                    choose_i,
    input  logic                    decide_i,
    input  logic                    prior_i,          // decode with PRIOR = 1: read the last frame's words
    output logic                    done_o,           // last clock of an operation; all results are sent
    // commands to the pairs, one clock early (_d): the array registers and distributes them; at most one access per clock
    output logic                    read_d_o,
    output logic                    write_d_o,
    output logic [  ADDR_WIDTH-1:0] address_d_o,
    // for the access that _d commanded one clock before
    output logic [       PAIRS-1:0] select_o,         // selected pair, one-hot
    output logic                    upper_o,          // the upper half of the word is selected
    output logic                    neighbour_o,      // select_o is the pair to the right of the pair in work
    // commands to the engines, aligned with those of the columns
    output `DTOF_TYPE(dtof_pool_pkg, pool_engine_command_t) command_o,
    // one clock before command_o: the bin whose sum the engines begin
    output logic [$clog2(dtof_pkg::POOL_COARSE_BINS)-1:0] template_bin_o,
    output logic [   ROW_WIDTH-1:0] scratch_row_o,    // row of write_scratch and read_scratch
    output logic [COLUMN_WIDTH-1:0] column_o,         // column in work
    // results of all engines: column e ENGINE_COLUMNS + send_column_o of engine e; all rows of a column, then the next column
    output logic                    send_o,           // only in a step that began while send_waits_i was low
    output logic [COLUMN_WIDTH-1:0] send_column_o,    // holds until the next send_o
    output logic [   ROW_WIDTH-1:0] send_row_o,
    output logic                    send_last_o,      // last pixel of the frame
    input  logic                    send_waits_i,     // no room for another pixel's results
    input  logic                    send_busy_i       // results are being sent
);

  localparam int DECIDE_LABELS = 2;
  localparam int LEAD = 3;  // steps from the fetch of a pixel until it is this pixel
  localparam int BINS = dtof_pkg::POOL_COARSE_BINS;
  localparam int OCTET = dtof_pkg::POOL_BINS_PER_LINE;
  localparam int OCTETS = BINS / OCTET;
  localparam int OCTETS_WIDTH = $clog2(OCTETS);
  localparam int GROUP_PAIRS = GROUP_SIZE / 2;
  localparam int FIRST_LATE_LABEL = 2;

  // Clocks of a step, derived from the modules' latencies.

  localparam int READ_CLOCKS = dtof_pkg::POOL_PAIR_READ_CLOCKS;
  // From a read to a command that uses the word: in decode, and in a chain.
  localparam int DECODE_LINE_CLOCKS = READ_CLOCKS + dtof_pkg::POOL_LINE_CLOCKS;
  localparam int LINE_CLOCKS = DECODE_LINE_CLOCKS + dtof_pkg::POOL_ENGINE_LINE_CLOCKS;

  localparam int COUNT_OWN = DECODE_LINE_CLOCKS + dtof_pkg::POOL_DECODER_OWN_CLOCKS;
  localparam int FILL = DECODE_LINE_CLOCKS + dtof_pkg::POOL_DECODER_FILL_CLOCKS;
  localparam int TAKE_TEMPLATE = DECODE_LINE_CLOCKS + dtof_pkg::POOL_DECODER_TEMPLATE_CLOCKS;
  localparam int SEARCH = FILL + BINS;  // the ring is full; a turn takes BINS clocks
  localparam int FIRST_CANDIDATE = SEARCH + BINS - 1 + dtof_pkg::POOL_DECODER_CANDIDATE_CLOCKS;
  localparam int LAST_CANDIDATE = FIRST_CANDIDATE + BINS * (LABELS - 1);
  localparam int LAST_SIGNIFICANCE = LAST_CANDIDATE + ((SIGNIFICANCE_WIDTH != 0) ? dtof_pkg::POOL_DECODER_SIGNIFICANCE_CLOCKS : 0);
  localparam int LAST_OF_DECODE = LAST_SIGNIFICANCE + READ_CLOCKS;
  localparam int TAKE_PRIOR = FILL - 1;  // in time for the first pair sum; the read falls between those of the bins

  localparam int SPREAD = dtof_pkg::POOL_CHAIN_SPREAD_CLOCKS;
  localparam int PASS = SPREAD + 1;  // label 0
  localparam int TARGET = PASS - dtof_pkg::POOL_CHAIN_TARGET_CLOCKS;
  localparam int BELIEF = dtof_pkg::POOL_CHAIN_BELIEF_CLOCKS - 1;  // in the next step
  localparam int DISTANCES = BELIEF + dtof_pkg::POOL_ENGINE_DISTANCE_CLOCKS;
  localparam int RESULT = DISTANCES + dtof_pkg::POOL_ENGINE_SMOOTH_CLOCKS;
  localparam int SEND = RESULT + dtof_pkg::POOL_ENGINE_RESULT_CLOCKS;
  localparam int READ_CELL = BELIEF + 1;           // after the choice of the pixel before is written
  localparam int COMPARE = READ_CELL + dtof_pkg::POOL_ENGINE_MESSAGE_CLOCKS;
  localparam int TAKE_RIGHT = LINE_CLOCKS;         // the word read in the step's first clock
  localparam int RANK = TAKE_RIGHT + 1;
  localparam int LAST_OF_DECIDE = dtof_pkg::max_of(PASS + DECIDE_LABELS - 1, SEND);
  // All labels have passed and are ranked, and each of six SRAM accesses has a clock.
  localparam int LAST_OF_CHOOSE = dtof_pkg::max_of(PASS + LABELS - 1, LINE_CLOCKS + dtof_pkg::max_of(LABELS, 4));

  localparam int T_WIDTH = $clog2(LAST_OF_DECODE + 1);
  // With SMOOTH_STARTS the start depends on the pixel below, so the first pointer word is known one step after the best labels.
  localparam int WORD_LEAD = LEAD + 1 + SMOOTH_STARTS;
  // With PRIOR = 1 a group's used candidates are written in a step that writes no pair of pixels. For the last group this step comes
  // after the column's last pair, whose second pixel may be missing. A group has more than LEAD rows: when its first pixel has
  // chosen, the group that was fetched last is still the same group.
  localparam int EVEN_PIXELS = PIXELS_PER_SRAM + PIXELS_PER_SRAM % 2;
  localparam int LAST_STEP = PIXELS_PER_SRAM + LEAD;
  localparam int LAST_STEP_OF_CHOOSE = (PRIOR != 0) ? EVEN_PIXELS + WORD_LEAD : LAST_STEP + SMOOTH_STARTS;
  localparam int STEP_WIDTH = $clog2(dtof_pkg::max_of(LAST_STEP + 1, LAST_STEP_OF_CHOOSE) + 1);
  localparam int PAIR_WIDTH = dtof_pkg::index_width(PAIRS);
  localparam logic LAST_COLUMN_ODD = (ENGINE_COLUMNS % 2) == 0;

  // State of the operation: pair, column of the pair, pass, step, clock of the step.

  typedef enum logic [2:0] {
    IDLE   = 3'd0,
    DECODE = 3'd1,
    CHOOSE = 3'd2,
    DECIDE = 3'd3,
    FINISH = 3'd4
  } operation_t;

  operation_t state_q;
  logic [PAIR_WIDTH-1:0] pair_q;
  logic [PAIRS-1:0] select_q, select_d;
  logic odd_q;                      // chain: the pair's second column
  logic back_q;                     // chain: the second pass
  logic [STEP_WIDTH-1:0] step_q;    // decode: group; chain: LEAD + number of this pixel, counted in the direction of the pass
  logic [T_WIDTH-1:0] t_q, last_t;
  logic [STEP_WIDTH-1:0] last_step_number;
  logic decoding, choosing, deciding, chaining, first_pair, last_pair, last_column, last_step, step_end, pass_end, stall;

  assign decoding = (state_q == DECODE);
  assign choosing = (state_q == CHOOSE);
  assign deciding = (state_q == DECIDE);
  assign chaining = choosing || deciding;
  assign last_t = decoding ? T_WIDTH'(LAST_OF_DECODE) : choosing ? T_WIDTH'(LAST_OF_CHOOSE) : T_WIDTH'(LAST_OF_DECIDE);
  assign last_step_number = decoding ? STEP_WIDTH'(GROUPS - 1)
      : (deciding && back_q) ? STEP_WIDTH'(LAST_STEP + 1)
      : back_q ? STEP_WIDTH'(LAST_STEP_OF_CHOOSE) : STEP_WIDTH'(LAST_STEP);
  assign last_step = (step_q == last_step_number);
  assign first_pair = (pair_q == '0);
  assign last_pair = (pair_q == PAIR_WIDTH'(PAIRS - 1));
  assign last_column = last_pair && (decoding || odd_q == LAST_COLUMN_ODD);
  assign step_end = (decoding || chaining) && !stall && (t_q == last_t);
  assign pass_end = step_end && last_step;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q <= IDLE;
      pair_q <= '0;
      odd_q <= 1'b0;
      select_q <= PAIRS'(1);
      back_q <= 1'b0;
      step_q <= '0;
      t_q <= '0;
    end else begin
      case (state_q)
        IDLE: begin
          pair_q <= '0;
          odd_q <= 1'b0;
          select_q <= PAIRS'(1);
          if (decode_i) begin
            state_q <= DECODE;
          end else if (choose_i) begin
            state_q <= CHOOSE;
          end else if (decide_i) begin
            state_q <= DECIDE;
          end
        end
        DECODE, CHOOSE, DECIDE: begin
          if (!stall) begin
            t_q <= step_end ? '0 : t_q + 1'b1;
          end
          if (step_end) begin
            step_q <= last_step ? '0 : step_q + 1'b1;
          end
          if (pass_end) begin
            back_q <= chaining && !back_q;
          end
          if (pass_end && (decoding || back_q)) begin
            odd_q <= chaining && !odd_q;
            if (decoding || odd_q) begin
              pair_q <= pair_q + 1'b1;
              select_q <= select_q << 1;
            end
            if (last_column) begin
              state_q <= FINISH;
            end
          end
        end
        // Waits until the last command has reached the columns and the last results are sent.
        default:
        if (!send_busy_i && !send_o) begin
          state_q <= IDLE;
        end
      endcase
    end
  end

  assign done_o = (state_q == FINISH) && !send_busy_i && !send_o;

  // Pixels that a chain's step works on.

  logic to_fetch, prepared_in_pass, next_in_pass, in_pass, done_before, chosen_before, result_before, word_before, pair_done;
  logic word_known, smooths, used_before, group_begun, group_done;
  logic [ROW_WIDTH-1:0] fetch_row, prepared_row, next_row, row, row_before, result_row, word_row, used_row;

  function automatic logic [ROW_WIDTH-1:0] row_of(input logic [STEP_WIDTH-1:0] position, input logic back);
    row_of = ROW_WIDTH'(back ? 32'(position) : PIXELS_PER_SRAM - 1 - 32'(position));
  endfunction

  assign fetch_row = row_of(step_q, back_q);
  assign prepared_row = row_of(step_q - STEP_WIDTH'(LEAD - 2), back_q);
  assign next_row = row_of(step_q - STEP_WIDTH'(LEAD - 1), back_q);
  assign row = row_of(step_q - STEP_WIDTH'(LEAD), back_q);
  assign row_before = row_of(step_q - STEP_WIDTH'(LEAD + 1), back_q);
  assign result_row = row_of(step_q - STEP_WIDTH'(LEAD + 2), 1'b1);
  assign word_row = row_of(step_q - STEP_WIDTH'(WORD_LEAD), 1'b1);
  assign used_row = row_of(step_q - STEP_WIDTH'(WORD_LEAD + 1), 1'b1);
  assign to_fetch = (step_q < STEP_WIDTH'(PIXELS_PER_SRAM));
  assign prepared_in_pass = (step_q >= STEP_WIDTH'(LEAD - 2)) && (step_q < STEP_WIDTH'(PIXELS_PER_SRAM + LEAD - 2));
  assign next_in_pass = (step_q >= STEP_WIDTH'(LEAD - 1)) && (step_q < STEP_WIDTH'(PIXELS_PER_SRAM + LEAD - 1));
  assign in_pass = (step_q >= STEP_WIDTH'(LEAD)) && (step_q < STEP_WIDTH'(PIXELS_PER_SRAM + LEAD));
  assign done_before = back_q && (step_q >= STEP_WIDTH'(LEAD + 1));  // the best labels of the pixel before are known, or the column has ended
  assign chosen_before = done_before && (step_q < STEP_WIDTH'(PIXELS_PER_SRAM + LEAD + 1));
  assign result_before = back_q && (step_q >= STEP_WIDTH'(LEAD + 2));  // the best labels of the pixel two steps before and of its neighbours are known
  assign word_before = back_q && (step_q >= STEP_WIDTH'(WORD_LEAD));   // a first pointer word is known, or the column has ended
  assign used_before = back_q && (step_q >= STEP_WIDTH'(WORD_LEAD + 1));

  generate
    if (PRIOR != 0) begin : g_prior
      assign word_known = word_before && (step_q < STEP_WIDTH'(PIXELS_PER_SRAM + WORD_LEAD));
      assign pair_done = word_before && word_row[0];
      assign group_begun = choosing && done_before && (32'(row_before) % GROUP_SIZE == 0 || last_step);
      assign group_done = choosing && used_before && (32'(used_row) % GROUP_SIZE == GROUP_SIZE - 1 || last_step);
    end else begin : g_no_prior
      assign word_known = word_before;
      assign pair_done = word_before && (word_row[0] || last_step);
      assign group_begun = 1'b0;
      assign group_done = 1'b0;
      logic unused_prior;
      assign unused_prior = ^{prior_i, used_before, used_row};
    end
  endgenerate

  assign smooths = deciding || (choosing && SMOOTH_STARTS != 0);
  // The stall also blocks write_message: the message is written beside what was read from the same word, and the write makes the read
  // data undefined, so a second write would corrupt the word.
  assign stall = deciding && (t_q == '0) && send_waits_i;

  // Schedule.

  function automatic logic at(input int t, input int clock);
    at = (t == clock);
  endfunction

  function automatic logic during(input int t, input int first, input int last);
    during = (t >= first) && (t <= last);
  endfunction

  // True `times` times from `first` on, every `period` clocks; `period` is a power of two.
  function automatic logic every(input int t, input int first, input int period, input int times);
    every = (t >= first) && (t < first + period * times) && (((t - first) & (period - 1)) == 0);
  endfunction

  `DTOF_TYPE(dtof_pool_pkg, pool_column_command_t) columns;
  `DTOF_TYPE(dtof_pool_pkg, pool_decode_command_t) decode;
  `DTOF_TYPE(dtof_pool_pkg, beside_command_t) beside;
  `DTOF_TYPE(dtof_pool_pkg, chain_command_t) chain;
  `DTOF_TYPE(dtof_pool_pkg, pool_engine_command_t) command;
  int t, last;
  logic write_message, write_position, read_next, read_before, read_cell, read_message;
  assign t = 32'(t_q);
  assign last = 32'(last_t);

  always_comb begin
    columns = '0;
    decode = '0;
    beside = '0;
    chain = '0;
    command = '0;
    write_message = 1'b0;
    write_position = 1'b0;
    read_next = 1'b0;
    read_before = 1'b0;
    read_cell = 1'b0;
    read_message = 1'b0;

    // Decode. The bins of the five groups are read in successive clocks, because the decoder adds a bin's five counts in successive
    // clocks.
    if (decoding) begin
      columns.read_above    = every(t, 0, OCTET, OCTETS);
      columns.read_own      = every(t, 1, OCTET, OCTETS);
      columns.read_below    = every(t, 2, OCTET, OCTETS);
      columns.read_left     = every(t, 3, OCTET, OCTETS);
      columns.read_right    = every(t, 4, OCTET, OCTETS);
      decode.capture_above  = every(t, DECODE_LINE_CLOCKS, OCTET, OCTETS);
      decode.capture_own    = every(t, DECODE_LINE_CLOCKS + 1, OCTET, OCTETS);
      decode.capture_below  = every(t, DECODE_LINE_CLOCKS + 2, OCTET, OCTETS);
      decode.capture_left   = every(t, DECODE_LINE_CLOCKS + 3, OCTET, OCTETS);
      decode.capture_right  = every(t, DECODE_LINE_CLOCKS + 4, OCTET, OCTETS);
      decode.count_own      = during(t, COUNT_OWN, COUNT_OWN + BINS - 1);
      decode.fill           = during(t, FILL, SEARCH - 1);
      decode.search         = during(t, SEARCH, LAST_OF_DECODE);
      decode.first_label    = during(t, SEARCH, SEARCH + BINS - 1);
      decode.candidate      = every(t, FIRST_CANDIDATE, BINS, LABELS);
      columns.read_prior    = at(t, TAKE_PRIOR - DECODE_LINE_CLOCKS) && (PRIOR != 0) && prior_i;
      decode.take_prior     = at(t, TAKE_PRIOR) && (PRIOR != 0);
      columns.read_group    = at(t, LAST_SIGNIFICANCE);
      columns.write_group   = at(t, LAST_OF_DECODE);
    end

    // Choose: evidence of the neighbouring columns, for the pixel to be fetched and for the prepared pixel.
    if (choosing) begin
      columns.fetch_right_pixel = at(t, 0) && to_fetch;
      columns.fetch_right_group = at(t, 1) && to_fetch;
      beside.take_right_pixel   = at(t, TAKE_RIGHT);
      beside.rank               = during(t, RANK, RANK + LABELS - 1);
      beside.first_rank         = at(t, RANK);
      beside.late_rank          = (t >= RANK + FIRST_LATE_LABEL);
      beside.take_ranks         = at(t, 0);
      read_cell                 = at(t, READ_CELL) && prepared_in_pass;
      beside.compare            = during(t, COMPARE, COMPARE + LABELS - 1);
      beside.late_compare       = (t >= COMPARE + FIRST_LATE_LABEL);
    end

    // Choose and decide. The best labels of a pixel are known in the next step, in which it is the pixel before.
    if (chaining) begin
      chain.begin_step       = at(t, 0);
      write_message          = at(t, 0) && !back_q && in_pass && !stall;
      read_before            = at(t, 0) && chosen_before;
      write_position         = at(t, BELIEF) && chosen_before;
      command.take_choice    = at(t, BELIEF) && choosing && chosen_before;
      command.next_group     = at(t, BELIEF) && group_begun;
      command.take_position  = at(t, BELIEF) && smooths && done_before;
      command.take_distances = at(t, DISTANCES) && smooths;
      command.take_word      = at(t, (SMOOTH_STARTS != 0) ? RESULT : BELIEF) && choosing && word_known;
      command.take_result    = at(t, RESULT) && deciding && result_before;
      columns.send           = at(t, SEND) && deciding && result_before;
      chain.spread           = at(t, SPREAD);
      chain.pass_label       = during(t, PASS, PASS + (choosing ? LABELS : DECIDE_LABELS) - 1);
      columns.fetch_pixel    = at(t, last - 1 - LINE_CLOCKS) && to_fetch;
      columns.fetch_group    = at(t, last - LINE_CLOCKS) && to_fetch;
      columns.read_pair      = at(t, last - READ_CLOCKS) && choosing && pair_done;
      columns.read_used      = at(t, last - READ_CLOCKS) && group_done;
      command.take_pixel     = at(t, last - 1);
      read_message           = at(t, last - dtof_pkg::POOL_ENGINE_MESSAGE_CLOCKS) && back_q && next_in_pass;
      columns.write_pair     = at(t, last) && choosing && pair_done;
      columns.write_used     = at(t, last) && group_done;
      command.take_used      = at(t, last) && choosing && to_fetch && (PRIOR != 0);
      read_next              = at(t, last) && !back_q && next_in_pass;
      chain.advance          = at(t, last);
    end

    // Fields that accompany the commands.
    decode.own_bin = 5'(t - COUNT_OWN);
    decode.pair = 5'(t - FILL);
    decode.missing = 2'(decoding && step_q == '0) + 2'(decoding && last_step) + 2'(decoding && first_pair);
    beside.has_left = !first_pair || odd_q;
    chain.target = 3'(t - TARGET);
    chain.clear_message = (step_q < STEP_WIDTH'(LEAD));
    command.odd_pixel = 1'(fetch_row);
    command.odd_word = 1'(word_row);
    command.has_position = chosen_before;
    command.decoding = decoding;
    command.choosing = choosing;
    command.deciding = deciding;
    command.giving_used = group_done;
    command.back = back_q;
    command.write_scratch = write_message || write_position;
    command.read_scratch = read_next || read_before || read_cell || read_message;
    command.decode = decode;
    command.beside = beside;
    if (choosing) begin
      command.choose = chain;
    end
    if (deciding) begin
      command.decide = chain;
    end
  end

  // SRAM access of the columns.

  logic read_bins, group_word, used_word, fetch_right, fetch_group, toward_left, toward_right, upper_d, neighbour_d;
  logic [STEP_WIDTH-1:0] read_group;
  logic [OCTETS_WIDTH-1:0] bins_read;  // octets read so far of each group

  assign read_bins = columns.read_above || columns.read_own || columns.read_below || columns.read_left || columns.read_right;
  assign group_word = columns.read_prior || columns.read_group || columns.write_group;
  assign used_word = columns.read_used || columns.write_used;
  assign fetch_right = columns.fetch_right_pixel || columns.fetch_right_group;
  assign fetch_group = columns.fetch_right_group || columns.fetch_group;
  assign read_d_o = read_bins || columns.read_prior || columns.read_group || fetch_right || columns.fetch_pixel
      || columns.fetch_group || columns.read_pair || columns.read_used;
  assign write_d_o = columns.write_group || columns.write_pair || columns.write_used;

  // At the array's borders the group or pair itself replaces its missing neighbour.
  assign read_group = (columns.read_above && step_q != '0) ? step_q - 1'b1
      : (columns.read_below && !last_step) ? step_q + 1'b1
      : step_q;
  assign toward_left = columns.read_left && !first_pair;
  assign neighbour_d = columns.read_right || (fetch_right && odd_q);
  assign toward_right = neighbour_d && !last_pair;
  assign select_d = toward_left ? select_q >> 1 : toward_right ? select_q << 1 : select_q;

  assign bins_read = OCTETS_WIDTH'(t_q >> $clog2(OCTET));
  assign address_d_o = read_bins
      ? ADDR_WIDTH'(32'(read_group) * GROUP_PAIRS + ((LINE_HALVES == 1) ? 32'(bins_read) >> 1 : 32'(bins_read)))
      : group_word ? ADDR_WIDTH'(PIXEL_WORDS + (32'(step_q) >> 1))
      : fetch_group ? ADDR_WIDTH'(PIXEL_WORDS + 32'(fetch_row) / (2 * GROUP_SIZE))
      : used_word ? ADDR_WIDTH'(PIXEL_WORDS + 32'(used_row) / (2 * GROUP_SIZE))
      : (columns.fetch_pixel || columns.fetch_right_pixel) ? ADDR_WIDTH'(32'(fetch_row) >> 1)
      : ADDR_WIDTH'(32'(word_row) >> 1);
  assign upper_d = read_bins ? (LINE_HALVES == 1) && bins_read[0]
      : group_word ? step_q[0]
      : fetch_group ? 1'((32'(fetch_row) / GROUP_SIZE) & 1)
      : used_word ? 1'((32'(used_row) / GROUP_SIZE) & 1)
      : columns.fetch_right_pixel ? !odd_q
      : odd_q;

  // Commands are registered: they leave one clock after their t.

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      send_o <= 1'b0;
      command_o <= '0;
    end else begin
      send_o <= columns.send;
      command_o <= command;
    end
  end

  always_ff @(posedge clk_i) begin
    template_bin_o <= $clog2(BINS)'(t - TAKE_TEMPLATE + 1);
    select_o <= select_d;
    upper_o <= upper_d;
    neighbour_o <= neighbour_d;
    column_o <= COLUMN_WIDTH'({pair_q, odd_q});
    scratch_row_o <= write_message ? row : (write_position || read_before) ? row_before : read_cell ? prepared_row : next_row;
    if (columns.send) begin
      send_column_o <= COLUMN_WIDTH'({pair_q, odd_q});
      send_row_o <= result_row;
      send_last_o <= last_column && last_step;
    end
  end

  // Rules for the table, and for the starts of operations.

  logic [15:0] accesses;
  assign accesses = {columns.read_above, columns.read_own, columns.read_below, columns.read_left, columns.read_right,
                     columns.read_prior, columns.read_group, columns.write_group, columns.fetch_right_pixel,
                     columns.fetch_right_group, columns.fetch_pixel, columns.fetch_group, columns.read_pair,
                     columns.write_pair, columns.read_used, columns.write_used};

  `DTOF_ASSERT(a_one_access, (accesses & (accesses - 1'b1)) == '0, "the schedule has two SRAM accesses in a clock")
  `DTOF_ASSERT(a_one_message, 32'(write_message) + 32'(write_position) + 32'(read_next) + 32'(read_before) + 32'(read_cell)
               + 32'(read_message) <= 1,
               "the schedule has two accesses of the scratch memory in a clock")
  `DTOF_ASSERT(a_one_pair, (select_o & (select_o - 1'b1)) == '0,
               "several pairs are selected, whose words are combined by OR")
  `DTOF_ASSERT(a_start, !(decode_i || choose_i || decide_i)
               || (state_q == IDLE && 32'(decode_i) + 32'(choose_i) + 32'(decide_i) == 1),
               "an operation is started together with another one, or while one is in work")

endmodule

`default_nettype wire
