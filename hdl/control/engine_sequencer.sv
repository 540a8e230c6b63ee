// SPDX-License-Identifier: Apache-2.0
// poolPointer: tells all engines and their columns what to do in each clock, in lockstep, once per array.
//
// 1. The controller starts one of three operations. The engines take their columns one after the other; a column has as
//    many steps as it needs, and every step takes the same number of clocks.
// 2. Decode: a step is a group. The bins of the group and of its neighbours above and below are read, word by word, and
//    run into the decoder's ring one a clock. The ring then turns once for each candidate, and the group's word is
//    written.
// 3. Choose and decide: a step is a pixel of a chain. A first pass goes from a column's last pixel to its first, keeping
//    the messages, and a second one goes back. Pixels are fetched two steps before they become this pixel. When all
//    labels of the next pixel have passed, this one's best two labels are known, early in the next step. Choose writes
//    two pixels' first pointer words together; decide gives each pixel's result to the output, and stands still at the
//    beginning of a step while the output has not taken the last one.
//
// Schedule: the table below. A line says in which clocks t of a step a command is given. Columns and engines have it in
//   the next clock, and what takes longer takes the clocks that the module in question states (dtof_pkg). The clocks of
//   the two products stand in docs/reference/blocks/pool_control.md.
// Latency, K labels: a column's groups x (32 K + 43), (pixels + 3) x max(K + 4, 6) a pass, decide's (pixels + 3) x 6.
// Cost: counters and a register of the commands, per array.
`include "dtof_macros.svh"
`include "engine_command.svh"

module engine_sequencer #(
    parameter int PIXELS_PER_SRAM = 160,  // rows of a column
    parameter int GROUP_SIZE = 8,         // rows of a group
    parameter int LABELS = 8,             // candidates of a group, 2 to 8
    parameter int BINS_PER_WORD = 8,      // coarse bins of a word, a power of two
    parameter int ENGINE_COLUMNS = 25,    // columns of an engine
    localparam int GROUPS = (PIXELS_PER_SRAM + GROUP_SIZE - 1) / GROUP_SIZE,
    localparam int PIXEL_WORDS = GROUPS * (GROUP_SIZE / 2),
    localparam int ADDR_WIDTH = dtof_pkg::index_width(PIXEL_WORDS + GROUPS),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(ENGINE_COLUMNS)
) (
    input  logic                      clk_i,
    input  logic                      rst_ni,
    // a clock that starts an operation; one at a time, and none before done_o of the one before
    input  logic                      decode_i,
    input  logic                      choose_i,
    input  logic                      decide_i,
    output logic                      done_o,         // the operation's last clock; its results are sent
    // columns: one clock early (_d), for the array to register and spread; at most one access a clock
    output logic                      read_d_o,
    output logic                      write_d_o,
    output logic [    ADDR_WIDTH-1:0] address_d_o,
    output logic                      load_d_o,       // the SRAM's data are registered, a clock after read_d_o
    output logic [ENGINE_COLUMNS-1:0] select_o,       // not early; exactly one, the column of what _d has just commanded
    // engines, in step with what the columns get
    output engine_command_t           command_o,
    output logic [     ROW_WIDTH-1:0] message_row_o,  // of write_message and read_message
    // results of all engines: column e ENGINE_COLUMNS + send_column_o of engine e, column by column, row by row
    output logic                      send_o,         // only while send_waits_i is low
    output logic [  COLUMN_WIDTH-1:0] send_column_o,  // held until the next
    output logic [     ROW_WIDTH-1:0] send_row_o,
    output logic                      send_last_o,    // the frame's last pixel
    input  logic                      send_waits_i,   // the results given last have not been taken
    input  logic                      send_busy_i     // results are still being sent
);

  localparam int POOLED_LABELS = 3;
  localparam int DECIDE_LABELS = 2;
  localparam int LEAD = 2;  // steps a pixel is fetched ahead
  localparam int BINS = dtof_pkg::POOL_COARSE_BINS;
  localparam int BIN_WIDTH = $clog2(BINS_PER_WORD);
  localparam int GROUP_PAIRS = GROUP_SIZE / 2;

  // Clocks of a step, from the modules' latencies.

  localparam int READ_CLOCKS = dtof_pkg::POOL_PAIR_READ_CLOCKS;
  localparam int LINE_CLOCKS = READ_CLOCKS + dtof_pkg::POOL_ENGINE_LINE_CLOCKS;  // from a read to a command that uses it

  localparam int FILL = LINE_CLOCKS + dtof_pkg::POOL_DECODER_FILL_CLOCKS;
  localparam int SEARCH = FILL + BINS;  // the ring is full; a turn takes BINS clocks
  localparam int FIRST_CANDIDATE = SEARCH + BINS - 1 + dtof_pkg::POOL_DECODER_CANDIDATE_CLOCKS;
  localparam int LAST_CANDIDATE = FIRST_CANDIDATE + BINS * (LABELS - 1);
  localparam int LAST_OF_DECODE = LAST_CANDIDATE + READ_CLOCKS;

  localparam int SPREAD = dtof_pkg::POOL_CHAIN_SPREAD_CLOCKS;
  localparam int PASS = SPREAD + 1;  // label 0; the last one passes in the last clock of the step
  localparam int TARGET = PASS - dtof_pkg::POOL_CHAIN_TARGET_CLOCKS;
  localparam int BELIEF = dtof_pkg::POOL_CHAIN_BELIEF_CLOCKS - 1;  // of the next step
  localparam int SEND = BELIEF + dtof_pkg::POOL_ENGINE_RESULT_CLOCKS;
  localparam int LAST_OF_DECIDE = PASS + DECIDE_LABELS - 1;
  localparam int LAST_OF_CHOOSE = dtof_pkg::max_of(PASS + LABELS - 1, LAST_OF_DECIDE);

  localparam int T_WIDTH = $clog2(LAST_OF_DECODE + 1);
  localparam int STEP_WIDTH = $clog2(PIXELS_PER_SRAM + LEAD + 1);

  // Where the operation is: column, pass, step, and clock of the step.

  localparam logic [2:0] IDLE = 3'd0;
  localparam logic [2:0] DECODE = 3'd1;
  localparam logic [2:0] CHOOSE = 3'd2;
  localparam logic [2:0] DECIDE = 3'd3;
  localparam logic [2:0] FINISH = 3'd4;

  logic [2:0] state_q;
  logic [COLUMN_WIDTH-1:0] column_q;
  logic [ENGINE_COLUMNS-1:0] select_q, select_delayed_q;
  logic back_q;                     // the second pass of a chain
  logic [STEP_WIDTH-1:0] step_q;    // of decode the group; of a chain the pixel in its pass's direction, + LEAD
  logic [T_WIDTH-1:0] t_q, last_t;
  logic decoding, choosing, deciding, chaining, last_column, last_step, step_end, pass_end, stall;

  assign decoding = (state_q == DECODE);
  assign choosing = (state_q == CHOOSE);
  assign deciding = (state_q == DECIDE);
  assign chaining = choosing || deciding;
  assign last_t = decoding ? T_WIDTH'(LAST_OF_DECODE) : choosing ? T_WIDTH'(LAST_OF_CHOOSE) : T_WIDTH'(LAST_OF_DECIDE);
  assign last_step = (step_q == (decoding ? STEP_WIDTH'(GROUPS - 1) : STEP_WIDTH'(PIXELS_PER_SRAM + LEAD)));
  assign last_column = (column_q == COLUMN_WIDTH'(ENGINE_COLUMNS - 1));
  assign step_end = (decoding || chaining) && (t_q == last_t);
  assign pass_end = step_end && last_step;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q <= IDLE;
      column_q <= '0;
      select_q <= ENGINE_COLUMNS'(1);
      back_q <= 1'b0;
      step_q <= '0;
      t_q <= '0;
    end else begin
      case (state_q)
        IDLE: begin
          column_q <= '0;
          select_q <= ENGINE_COLUMNS'(1);
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
            column_q <= column_q + 1'b1;
            select_q <= select_q << 1;
            if (last_column) begin
              state_q <= FINISH;
            end
          end
        end
        // The last command reaches the columns; the last results are sent.
        default:
        if (!send_busy_i) begin
          state_q <= IDLE;
        end
      endcase
    end
  end

  assign done_o = (state_q == FINISH) && !send_busy_i;

  // Which pixels a chain's step is about.

  logic to_fetch, in_pass, next_in_pass, done_before, pair_done;
  logic [ROW_WIDTH-1:0] fetch_row, next_row, row, row_before;

  function automatic logic [ROW_WIDTH-1:0] row_of(input logic [STEP_WIDTH-1:0] position, input logic back);
    row_of = ROW_WIDTH'(back ? 32'(position) : PIXELS_PER_SRAM - 1 - 32'(position));
  endfunction

  assign fetch_row = row_of(step_q, back_q);
  assign next_row = row_of(step_q - STEP_WIDTH'(LEAD - 1), back_q);
  assign row = row_of(step_q - STEP_WIDTH'(LEAD), back_q);
  assign row_before = row_of(step_q - STEP_WIDTH'(LEAD + 1), back_q);
  assign to_fetch = (step_q < STEP_WIDTH'(PIXELS_PER_SRAM));
  assign next_in_pass = (step_q >= STEP_WIDTH'(LEAD - 1)) && (step_q < STEP_WIDTH'(PIXELS_PER_SRAM + LEAD - 1));
  assign in_pass = (step_q >= STEP_WIDTH'(LEAD)) && (step_q < STEP_WIDTH'(PIXELS_PER_SRAM + LEAD));
  assign done_before = back_q && (step_q >= STEP_WIDTH'(LEAD + 1));  // the pixel before has its best labels
  assign pair_done = done_before && (row_before[0] || last_step);

  assign stall = deciding && done_before && (t_q == '0) && send_waits_i;

  // The schedule.

  function automatic logic at(input int t, input int clock);
    at = (t == clock);
  endfunction

  function automatic logic during(input int t, input int first, input int last);
    during = (t >= first) && (t <= last);
  endfunction

  // `times` times from `first` on, `period` clocks apart, a power of two.
  function automatic logic every(input int t, input int first, input int period, input int times);
    every = (t >= first) && (t < first + period * times) && (((t - first) & (period - 1)) == 0);
  endfunction

  column_command_t columns;
  decode_command_t decode;
  chain_command_t chain;
  engine_command_t command;
  int t, last;
  assign t = 32'(t_q);
  assign last = 32'(last_t);

  always_comb begin
    columns = '0;
    decode = '0;
    chain = '0;
    command = '0;

    // A group. The words of the group above, of the group itself and of the group below are read one clock after the other,
    // so that a bin's three counts arrive one after the other, too, and one adder makes their sum.
    if (decoding) begin
      columns.read_above    = every(t, 0, BINS_PER_WORD, BINS / BINS_PER_WORD);
      columns.read_own      = every(t, 1, BINS_PER_WORD, BINS / BINS_PER_WORD);
      columns.read_below    = every(t, 2, BINS_PER_WORD, BINS / BINS_PER_WORD);
      decode.capture_above  = every(t, LINE_CLOCKS, BINS_PER_WORD, BINS / BINS_PER_WORD);
      decode.capture_own    = every(t, LINE_CLOCKS + 1, BINS_PER_WORD, BINS / BINS_PER_WORD);
      decode.capture_below  = every(t, LINE_CLOCKS + 2, BINS_PER_WORD, BINS / BINS_PER_WORD);
      decode.fill           = during(t, FILL, SEARCH - 1);
      decode.search         = during(t, SEARCH, LAST_OF_DECODE);
      decode.first_label    = during(t, SEARCH, SEARCH + BINS - 1);
      decode.pooled         = during(t, SEARCH, SEARCH + POOLED_LABELS * BINS - 1);
      decode.candidate      = every(t, FIRST_CANDIDATE, BINS, LABELS);
      columns.read_group    = at(t, LAST_CANDIDATE);
      columns.write_group   = at(t, LAST_OF_DECODE);
    end

    // A pixel. Its best labels are known in the next step, when it is the pixel before.
    if (chaining) begin
      chain.begin_step      = at(t, 0);
      command.write_message = at(t, 0) && !back_q && in_pass;
      command.take_choice   = at(t, BELIEF) && choosing && done_before;
      command.take_result   = at(t, BELIEF) && deciding && done_before;
      columns.send          = at(t, SEND) && deciding && done_before;
      chain.spread          = at(t, SPREAD);
      chain.pass_label      = during(t, PASS, choosing ? PASS + LABELS - 1 : LAST_OF_DECIDE);
      columns.fetch_pixel   = at(t, last - 1 - LINE_CLOCKS) && to_fetch;
      columns.fetch_group   = at(t, last - LINE_CLOCKS) && to_fetch;
      columns.read_pair     = at(t, last - READ_CLOCKS) && choosing && pair_done;
      command.take_pixel    = at(t, last - 1);
      command.read_message  = at(t, last - dtof_pkg::POOL_ENGINE_MESSAGE_CLOCKS) && back_q && next_in_pass;
      columns.write_pair    = at(t, last) && choosing && pair_done;
      chain.advance         = at(t, last);
    end

    // What goes with the commands.
    decode.pair = 5'(t - FILL);
    chain.target = 3'(t - TARGET);
    chain.clear_message = (step_q < STEP_WIDTH'(LEAD));
    command.odd_pixel = 1'(fetch_row);
    command.odd_result = 1'(row_before);
    command.decoding = decoding;
    command.deciding = deciding;
    command.decode = decode;
    if (choosing) begin
      command.choose = chain;
    end
    if (deciding) begin
      command.decide = chain;
    end
  end

  // The columns' part.

  logic read_bins, group_word;
  logic [STEP_WIDTH-1:0] read_group;

  assign read_bins = columns.read_above || columns.read_own || columns.read_below;
  assign group_word = columns.read_group || columns.write_group;
  assign read_d_o = read_bins || columns.read_group || columns.fetch_pixel || columns.fetch_group || columns.read_pair;
  assign write_d_o = columns.write_group || columns.write_pair;

  // The first and the last group are their own missing neighbours.
  assign read_group = (columns.read_above && step_q != '0) ? step_q - 1'b1
      : (columns.read_below && !last_step) ? step_q + 1'b1
      : step_q;

  assign address_d_o = read_bins ? ADDR_WIDTH'(32'(read_group) * GROUP_PAIRS + (32'(t_q) >> BIN_WIDTH))
      : group_word ? ADDR_WIDTH'(PIXEL_WORDS + 32'(step_q))
      : columns.fetch_pixel ? ADDR_WIDTH'(32'(fetch_row) >> 1)
      : columns.fetch_group ? ADDR_WIDTH'(PIXEL_WORDS + 32'(fetch_row) / GROUP_SIZE)
      : ADDR_WIDTH'(32'(row_before) >> 1);

  // What is given in a clock leaves in the next.

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      load_d_o <= 1'b0;
      send_o <= 1'b0;
      command_o <= '0;
    end else begin
      load_d_o <= read_d_o;
      send_o <= columns.send;
      command_o <= command;
    end
  end

  always_ff @(posedge clk_i) begin
    select_delayed_q <= select_q;
    message_row_o <= command.write_message ? row : next_row;
    if (columns.send) begin
      send_column_o <= column_q;
      send_row_o <= row_before;
      send_last_o <= last_column && last_step;
    end
  end

  assign select_o = select_delayed_q;

  // What the table must keep to, and who starts operations.

  logic [8:0] accesses;
  assign accesses = {columns.read_above, columns.read_own, columns.read_below, columns.read_group, columns.write_group,
                     columns.fetch_pixel, columns.fetch_group, columns.read_pair, columns.write_pair};

  `DTOF_ASSERT(a_one_access, (accesses & (accesses - 1'b1)) == '0, "the schedule has two SRAM accesses in a clock")
  `DTOF_ASSERT(a_one_message, !(command.write_message && command.read_message),
               "the schedule has two accesses of the scratch memory in a clock")
  `DTOF_ASSERT(a_one_column, (select_delayed_q & (select_delayed_q - 1'b1)) == '0,
               "several columns are selected, whose words are combined by OR")
  `DTOF_ASSERT(a_start, !(decode_i || choose_i || decide_i)
               || (state_q == IDLE && 32'(decode_i) + 32'(choose_i) + 32'(decide_i) == 1),
               "an operation is started together with another one, or while one is in work")

endmodule
