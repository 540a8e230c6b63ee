// SPDX-License-Identifier: Apache-2.0
// poolPointer: drives all engines in lockstep, column by column, once per array.
//
// Operations: decode (each group's candidates), choose and decide (a chain of pixels, once from the last to the
// first and once back). ENGINE_COLUMNS columns one after the other; engine e works on column
// e ENGINE_COLUMNS + send_column_o.
//
// Decode of a group, clock t (the bins of the groups above, itself and below leave their word one clock apart):
//   t = q BINS_PER_WORD + 0, 1, 2   read word q of the group above, the group, the group below
//   + 4, 5, 6 (end)                 words captured            t = bin + 8   pair sums enter the ring
//   40 + 32 k + i                   search k sees pair i - 1  41 + 32 K     last candidate, then write
//   40 + 32 K                       read the group's word, with which the pair's other column gets its own back
// A step of a chain, clock s of PERIOD = max(labels + 4, 6); steps begin two pixels early to fetch:
//   s = 0                           evidence + message; scratch write (first pass)
//   s = 1, 2, 3                     largest sum, differences  s = 4 ..      one label of the next pixel a clock
//   PERIOD - 5, PERIOD - 4          read the word and the group of the pixel two steps on
//   PERIOD - 3                      choose, second pass: read what is to be written if a pair is complete
//   PERIOD - 2                      word captured; scratch read (second pass)
//   PERIOD - 1                      the pixel is prepared; the chain moves on
//   s = 1 of the next step          choose: pointer word, written with PERIOD - 1 if the pair is complete. decide:
//                                   results handed out, as soon as those of the step before are sent
// SRAM commands are given one clock early (_d); the engine has a word four clocks after its command. Its own commands
// leave a clock after s, results another one later.
// Latency, K labels: a column's groups x (32 K + 43), (pixels + 3) x PERIOD a pass.
// Cost: counters, per array.
`include "dtof_macros.svh"

module engine_sequencer #(
    parameter int PIXELS_PER_SRAM = 160,
    parameter int GROUP_SIZE = 8,
    parameter int LABELS = 8,
    parameter int BINS_PER_WORD = 8,
    parameter int ENGINE_COLUMNS = 25,
    localparam int GROUPS = (PIXELS_PER_SRAM + GROUP_SIZE - 1) / GROUP_SIZE,
    localparam int PIXEL_WORDS = GROUPS * (GROUP_SIZE / 2),
    localparam int ADDR_WIDTH = dtof_pkg::index_width(PIXEL_WORDS + GROUPS),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(ENGINE_COLUMNS),
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS)
) (
    input  logic                      clk_i,
    input  logic                      rst_ni,
    input  logic                      decode_i,            // start
    input  logic                      choose_i,
    input  logic                      decide_i,
    output logic                      done_o,
    // columns
    output logic [ENGINE_COLUMNS-1:0] select_o,
    output logic                      read_d_o,
    output logic                      write_d_o,
    output logic [ADDR_WIDTH-1:0]     address_d_o,
    output logic                      load_d_o,
    // candidate decoder
    output logic                      capture_above_o,
    output logic                      capture_own_o,
    output logic                      capture_below_o,
    output logic                      fill_o,
    output logic                      search_o,
    output logic [4:0]                pair_o,              // bin while filling, pair + 1 while searching
    output logic                      first_label_o,
    output logic                      pooled_o,            // the search is over pooled sums
    output logic                      candidate_o,         // a candidate is known
    // chains
    output logic                      deciding_o,
    output logic                      clear_message_o,
    output logic                      begin_o,             // s = 0
    output logic                      spread_o,            // s = 3
    output logic                      pass_label_o,        // s = 4 ..
    output logic [LABEL_WIDTH-1:0]    target_label_o,      // the label two clocks later
    output logic                      capture_word_o,
    output logic                      advance_o,           // s = PERIOD - 1
    output logic                      odd_pixel_o,         // of the word to capture, valid with capture_word_o
    output logic                      result_o,            // results of a pixel are ready (second pass, s = 1)
    output logic                      result_odd_o,        // its place in the pair
    output logic                      scratch_read_o,
    output logic                      scratch_write_o,
    output logic [ROW_WIDTH-1:0]      scratch_address_o,
    // results
    output logic                      send_o,
    output logic [COLUMN_WIDTH-1:0]   send_column_o,       // held until the next
    output logic [ROW_WIDTH-1:0]      send_row_o,
    output logic                      send_last_o,         // the frame's last pixel
    input  logic                      send_waits_i,        // the results given last have not been taken
    input  logic                      send_busy_i
);

  localparam int POOLED_LABELS = 3;
  localparam int BIN_WIDTH = $clog2(BINS_PER_WORD);
  localparam int GROUP_PAIRS = GROUP_SIZE / 2;
  localparam int LINE_CLOCKS = dtof_pkg::POOL_LINE_CLOCKS;
  localparam int FILL_BEGIN = LINE_CLOCKS + dtof_pkg::POOL_FILL_CLOCKS;
  localparam int SEARCH_BEGIN = FILL_BEGIN + dtof_pkg::POOL_COARSE_BINS;
  localparam int SEARCH_END = SEARCH_BEGIN + 32 * LABELS;
  localparam int LAST_T = SEARCH_END + dtof_pkg::POOL_CANDIDATE_CLOCKS;
  localparam int T_WIDTH = $clog2(LAST_T + 1);
  localparam int SPREAD = dtof_pkg::POOL_SPREAD_CLOCKS;
  localparam int DECIDE_LABELS = 2;
  localparam int DECIDE_PERIOD = SPREAD + 1 + DECIDE_LABELS;
  localparam int CHOOSE_PERIOD = dtof_pkg::max_of(SPREAD + 1 + LABELS, DECIDE_PERIOD);
  localparam int S_WIDTH = $clog2(CHOOSE_PERIOD);
  localparam int FIRST_TARGET = SPREAD + 1 - dtof_pkg::POOL_TARGET_CLOCKS;  // clock of label 0
  localparam int LEAD = 2;  // steps a pixel is fetched ahead
  localparam int N_WIDTH = $clog2(PIXELS_PER_SRAM + LEAD + 1);
  localparam int GROUP_WIDTH = dtof_pkg::index_width(GROUPS);

  localparam logic [1:0] IDLE = 2'd0;
  localparam logic [1:0] DECODE = 2'd1;
  localparam logic [1:0] CHAIN = 2'd2;
  localparam logic [1:0] FINISH = 2'd3;

  logic [1:0] state_q;
  logic deciding_q, back_q;
  logic [COLUMN_WIDTH-1:0] column_q;
  logic [ENGINE_COLUMNS-1:0] select_q;
  logic [GROUP_WIDTH-1:0] group_q;
  logic [T_WIDTH-1:0] t_q;
  logic [S_WIDTH-1:0] s_q, last_s;
  logic [N_WIDTH-1:0] n_q;  // pixel of the step + LEAD, counted in the pass's direction
  logic last_column, last_t, last_group, stall, step_end, pass_end;

  assign last_column = (column_q == COLUMN_WIDTH'(ENGINE_COLUMNS - 1));
  assign last_group = (group_q == GROUP_WIDTH'(GROUPS - 1));
  assign last_t = (t_q == T_WIDTH'(LAST_T));
  assign last_s = deciding_q ? S_WIDTH'(DECIDE_PERIOD - 1) : S_WIDTH'(CHOOSE_PERIOD - 1);
  assign step_end = (state_q == CHAIN) && (s_q == last_s);
  assign pass_end = step_end && (n_q == N_WIDTH'(PIXELS_PER_SRAM + LEAD));

  // Pixel p of a pass in work has n = p + LEAD; results of pixel p are known at s = 1 of n = p + LEAD + 1. Before, with
  // nothing under way, the chain waits until those of the pixel before have been taken.
  logic results_step, give_results;
  assign results_step = (state_q == CHAIN) && back_q && (n_q >= N_WIDTH'(LEAD + 1));
  assign stall = results_step && deciding_q && (s_q == '0) && send_waits_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q <= IDLE;
      deciding_q <= 1'b0;
      back_q <= 1'b0;
      column_q <= '0;
      select_q <= ENGINE_COLUMNS'(1);
      group_q <= '0;
      t_q <= '0;
      s_q <= '0;
      n_q <= '0;
    end else begin
      case (state_q)
        IDLE: begin
          column_q <= '0;
          select_q <= ENGINE_COLUMNS'(1);
          group_q <= '0;
          t_q <= '0;
          s_q <= '0;
          n_q <= '0;
          back_q <= 1'b0;
          deciding_q <= decide_i;
          if (decode_i) begin
            state_q <= DECODE;
          end else if (choose_i || decide_i) begin
            state_q <= CHAIN;
          end
        end
        DECODE: begin
          t_q <= last_t ? '0 : t_q + 1'b1;
          if (last_t) begin
            group_q <= last_group ? '0 : group_q + 1'b1;
            if (last_group) begin
              state_q <= last_column ? FINISH : DECODE;
              column_q <= column_q + 1'b1;
              select_q <= select_q << 1;
            end
          end
        end
        CHAIN: begin
          if (!stall) begin
            s_q <= step_end ? '0 : s_q + 1'b1;
          end
          if (pass_end) begin
            n_q <= '0;
            back_q <= !back_q;
            if (back_q) begin
              state_q <= last_column ? FINISH : CHAIN;
              column_q <= column_q + 1'b1;
              select_q <= select_q << 1;
            end
          end else if (step_end) begin
            n_q <= n_q + 1'b1;
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

  // A command given in the last clock of a column reaches it one clock later.
  logic [ENGINE_COLUMNS-1:0] select_delayed_q;
  always_ff @(posedge clk_i) begin
    select_delayed_q <= select_q;
  end
  assign select_o = select_delayed_q;

  // The columns' words are combined by OR.
  `DTOF_ASSERT(a_one_column, (select_delayed_q & (select_delayed_q - 1'b1)) == '0, "several columns are selected")

  // Decode.

  logic decoding;
  logic [T_WIDTH-1:0] since_search;
  logic [BIN_WIDTH-1:0] phase;
  logic read_bins, read_back, write_group;
  logic [GROUP_WIDTH-1:0] read_group;

  assign decoding = (state_q == DECODE);
  assign phase = t_q[BIN_WIDTH-1:0];
  assign read_bins = decoding && (t_q < T_WIDTH'(dtof_pkg::POOL_COARSE_BINS)) && (32'(phase) < 3);
  assign read_back = decoding && (t_q == T_WIDTH'(SEARCH_END));
  assign write_group = decoding && last_t;
  assign since_search = t_q - T_WIDTH'(SEARCH_BEGIN - 1);

  always_comb begin
    read_group = group_q;
    if (phase == BIN_WIDTH'(0) && group_q != '0) begin
      read_group = group_q - 1'b1;
    end else if (phase == BIN_WIDTH'(2) && !last_group) begin
      read_group = group_q + 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    capture_above_o <= decoding && (phase == BIN_WIDTH'(LINE_CLOCKS - 1));
    capture_own_o <= decoding && (phase == BIN_WIDTH'(LINE_CLOCKS % BINS_PER_WORD));
    capture_below_o <= decoding && (phase == BIN_WIDTH'((LINE_CLOCKS + 1) % BINS_PER_WORD));
    fill_o <= decoding && (t_q >= T_WIDTH'(FILL_BEGIN - 1)) && (t_q < T_WIDTH'(SEARCH_BEGIN - 1));
    search_o <= decoding && (t_q >= T_WIDTH'(SEARCH_BEGIN - 1));
    pair_o <= (t_q < T_WIDTH'(SEARCH_BEGIN - 1)) ? 5'(t_q - T_WIDTH'(FILL_BEGIN - 1)) : since_search[4:0];
    first_label_o <= (since_search < T_WIDTH'(32));
    pooled_o <= (since_search < T_WIDTH'(32 * POOLED_LABELS));
    candidate_o <= decoding && (t_q >= T_WIDTH'(SEARCH_BEGIN + 32)) && (since_search[4:0] == 5'd1);
  end

  // Chains.

  logic chaining, first_pass, second_pass, in_pass, to_fetch;
  logic read_word, read_cells, pair_complete, read_pair, write_pair;
  logic [ROW_WIDTH-1:0] row, next_row, fetch_row, result_row;

  function automatic logic [ROW_WIDTH-1:0] row_of(input logic [N_WIDTH-1:0] position, input logic back);
    row_of = ROW_WIDTH'(back ? 32'(position) : PIXELS_PER_SRAM - 1 - 32'(position));
  endfunction

  assign chaining = (state_q == CHAIN);
  assign first_pass = chaining && !back_q;
  assign second_pass = chaining && back_q;
  assign in_pass = (n_q >= N_WIDTH'(LEAD)) && (n_q < N_WIDTH'(PIXELS_PER_SRAM + LEAD));
  assign to_fetch = (n_q < N_WIDTH'(PIXELS_PER_SRAM));
  assign fetch_row = row_of(n_q, back_q);
  assign row = row_of(n_q - N_WIDTH'(LEAD), back_q);
  assign next_row = row_of(n_q - N_WIDTH'(LEAD - 1), back_q);
  assign result_row = row_of(n_q - N_WIDTH'(LEAD + 1), back_q);

  // The word is captured in the step's last clock, the group's word is there a clock later, when the chain moves on. A
  // pair's word reaches its column in the clock in which what is written with it reaches the SRAM.
  assign read_word = chaining && to_fetch && (s_q == last_s - S_WIDTH'(LINE_CLOCKS));
  assign read_cells = chaining && to_fetch && (s_q == last_s - S_WIDTH'(LINE_CLOCKS - 1));
  assign pair_complete = second_pass && !deciding_q && (n_q >= N_WIDTH'(LEAD + 1))
      && (result_row[0] || n_q == N_WIDTH'(PIXELS_PER_SRAM + LEAD));
  assign read_pair = pair_complete && (s_q == last_s - S_WIDTH'(dtof_pkg::POOL_WORD_CLOCKS - 1));
  assign write_pair = pair_complete && (s_q == last_s);

  assign read_d_o = read_bins || read_back || read_word || read_cells || read_pair;
  assign write_d_o = write_group || write_pair;

  always_comb begin
    address_d_o = '0;
    if (read_bins) begin
      address_d_o = ADDR_WIDTH'(32'(read_group) * GROUP_PAIRS + (32'(t_q) >> BIN_WIDTH));
    end else if (read_back || write_group) begin
      address_d_o = ADDR_WIDTH'(PIXEL_WORDS + 32'(group_q));
    end else if (read_word) begin
      address_d_o = ADDR_WIDTH'(32'(fetch_row) >> 1);
    end else if (read_cells) begin
      address_d_o = ADDR_WIDTH'(PIXEL_WORDS + 32'(fetch_row) / GROUP_SIZE);
    end else if (read_pair || write_pair) begin
      address_d_o = ADDR_WIDTH'(32'(result_row) >> 1);
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      load_d_o <= 1'b0;
    end else begin
      load_d_o <= read_d_o;
    end
  end

  // What the engines get, a clock later.

  logic send_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      scratch_write_o <= 1'b0;
      scratch_read_o <= 1'b0;
      send_q <= 1'b0;
      send_o <= 1'b0;
    end else begin
      scratch_write_o <= first_pass && in_pass && (s_q == '0);
      scratch_read_o <= second_pass && (s_q == last_s - S_WIDTH'(1)) && (n_q >= N_WIDTH'(LEAD - 1))
          && (n_q < N_WIDTH'(PIXELS_PER_SRAM + LEAD - 1));
      send_q <= give_results && deciding_q;
      send_o <= send_q;
    end
  end

  assign give_results = results_step && (s_q == S_WIDTH'(dtof_pkg::POOL_BELIEF_CLOCKS - 1));

  always_ff @(posedge clk_i) begin
    deciding_o <= deciding_q;
    clear_message_o <= (n_q < N_WIDTH'(LEAD));
    begin_o <= chaining && (s_q == '0);
    spread_o <= chaining && (s_q == S_WIDTH'(SPREAD));
    pass_label_o <= chaining && (s_q > S_WIDTH'(SPREAD))
        && (32'(s_q) <= SPREAD + (deciding_q ? DECIDE_LABELS : LABELS));
    target_label_o <= (s_q > S_WIDTH'(FIRST_TARGET)) ? LABEL_WIDTH'(s_q - S_WIDTH'(FIRST_TARGET)) : '0;
    capture_word_o <= chaining && (s_q == last_s - S_WIDTH'(1));
    advance_o <= step_end;
    odd_pixel_o <= fetch_row[0];
    result_o <= give_results;
    result_odd_o <= result_row[0];
    scratch_address_o <= (first_pass && (s_q == '0)) ? row : next_row;
    if (give_results) begin
      send_column_o <= column_q;
      send_row_o <= result_row;
      send_last_o <= last_column && (n_q == N_WIDTH'(PIXELS_PER_SRAM + LEAD));
    end
  end

endmodule
