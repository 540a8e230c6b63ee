// SPDX-License-Identifier: Apache-2.0
// poolPointer: up to four columns, in pairs, and the single-port SRAM that they share. A word has a part for each pair
// (dtof_pool_pair), and all pairs access the same address in a clock, so one wide macro replaces two.
//
// An engine selects one pair and replaces a half of its part; the rest of the word stays as it is. Of a word only those parts are written
// in which a pixel has changed, so that a macro with a write mask takes less power. The two pairs
// may belong to two engines. These never select both pairs in a clock, because all engines work on the pair with the same number.
//
// A read that only columns with detections need (optional_i) is suppressed if no column has such a detection, and the pairs do not load.
// If one pair needs the word, both load it, because a macro may ignore the write mask.
// With PARITY = 1 dtof_pool_word_parity gives the parity of each word that is read or written; dtof_pool_parity_store keeps and checks it.
// Latency: 1 clock from read_i to the pair's read_data_i; POOL_PARITY_CLOCKS to accessed_o and parity_o.
// Cost at the defaults: see reports/area.md.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_quad #(
    parameter int COLUMNS = 4,  // fewer for the last columns of an array
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
    parameter int PARITY = 0,  // 1: accessed_o and parity_o are there, otherwise 0
    parameter int TIME_GATE = 0,
    parameter int PRIOR = 0,
    parameter int BROADCAST_STAGES = 2,  // clocks from the array's control to the columns; timestamps are delayed as much
    localparam int PAIRS = (COLUMNS + 1) / 2,
    localparam int HALF_WIDTH = dtof_pkg::pool_half_width(LABELS, SCORE_BITS, OFFSET_BITS, ADVANTAGE_WIDTH,
                                                           POINTER_SHIFT, RIVAL_MOVES),
    localparam int PIXEL_WIDTH = dtof_pkg::pool_pixel_width(LABELS, SCORE_BITS, OFFSET_BITS, ADVANTAGE_WIDTH, POINTER_SHIFT,
                                                             RIVAL_MOVES),
    localparam int LINE_HALVES = dtof_pkg::pool_line_halves(HALF_WIDTH, COUNT_WIDTH),
    localparam int LINE_WIDTH = LINE_HALVES * HALF_WIDTH,
    localparam int WORD_WIDTH = 2 * HALF_WIDTH,
    localparam int PART_WIDTH = dtof_pkg::pool_part_width(LINE_HALVES),
    localparam int GROUPS = (PIXELS_PER_SRAM + GROUP_SIZE - 1) / GROUP_SIZE,
    localparam int DEPTH = GROUPS * (GROUP_SIZE / 2) + (GROUPS + 1) / 2,
    localparam int ADDR_WIDTH = dtof_pkg::index_width(DEPTH)
) (
    input  logic                        clk_i,
    input  logic                        rst_ni,
    // side band of the SRAM macros; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    input  logic [      COLUMNS*NP-1:0] timestamp_i,
    // SRAM
    input  logic                        read_i,
    input  logic                        optional_i,   // with read_i: only columns with detections need the word
    input  logic                        late_i,       // with optional_i: coarse, the part is not the first; otherwise, the read is for the second row, and
                                                      // the same address was read one clock before if the first row has a detection
    input  logic                        write_i,
    input  logic [      ADDR_WIDTH-1:0] address_i,
    // to dtof_pool_parity_store, POOL_PARITY_CLOCKS after an access of the SRAM
    output logic                        accessed_o,
    output logic                        parity_o,
    // to all pairs, as in dtof_pool_pair
    input  logic [              NP-1:0] gate_begin_i,
    input  logic [              NP-1:0] gate_end_i,
    input  logic                        coarse_i,
    input  logic                        point_i,
    input  logic                        beat_t1_i,
    input  logic                        first_slot_t1_i,
    input  logic                        last_slot_t1_i,
    input  logic                        odd_t1_i,
    input  logic                        second_row_t0_i,
    input  logic                        first_row_t2_i,
    input  logic                        second_row_t2_i,
    input  logic [                 3:0] acquisition_t2_i,
    input  logic [dtof_pkg::POOL_THINNING_WIDTH-1:0] thinning_t2_i,
    input  logic                        keep_first_i,
    input  logic                        keep_last_i,
    input  logic                        load_i,
    input  logic [      PART_WIDTH-1:0] part_i,
    input  logic                        sweep_i,      // from load_i of the first part: this visit is a sweep; make_room_i: the group's second visit in a sweep
    input  logic                        make_room_i,
    input  logic                        word_load_d_i,
    input  logic                        group_load_i,
    input  logic                        group_upper_i,
    input  logic                        engine_i,
    input  logic                        replace_i,
    input  logic                        clear_i,
    input  logic                        upper_i,
    input  logic                        used_i,
    // per pair
    input  logic [           PAIRS-1:0] select_i,
    input  logic [PAIRS*HALF_WIDTH-1:0] engine_word_i,
    // OR of the words to the right of the first pair, and of the second pair, which may be missing; separate ports, as they form a chain
    input  logic [      LINE_WIDTH-1:0] first_beside_i,
    input  logic [      LINE_WIDTH-1:0] second_beside_i,
    output logic [      LINE_WIDTH-1:0] first_word_o,
    output logic [      LINE_WIDTH-1:0] second_word_o
);

  logic [PAIRS*WORD_WIDTH-1:0] read_data, write_data;
  // Parts of a word are pixels. If the two pixels of a half have not the same width, parts are halves.
  localparam int PART_PIXELS = (HALF_WIDTH == 2 * PIXEL_WIDTH) ? 1 : 2;
  localparam int PARTS = 4 * PAIRS / PART_PIXELS;

  logic [4*PAIRS-1:0] writes;
  logic [PARTS-1:0] part_writes;
  logic [PAIRS-1:0] needs;
  logic needed, read, write, engine_load_q, sweep_q, make_room_q;
  logic needed_q;      // a read of the last clock was needed
  logic first_load_q;  // the last clock read a word of pixels, because its first row needs the word
  logic word_load_q;   // the pairs load the word
  logic due_next_q, due_q;  // the time to load a word is the next clock, and this clock, whether the word is needed or not

  assign needed = !optional_i || needs != '0;
  assign read = read_i && (!engine_i || select_i != '0) && needed && !(late_i && first_load_q);
  assign write = write_i && writes != '0;

  dtof_sram #(
      .PORTS(1),
      .DEPTH(DEPTH),
      .WIDTH(PAIRS * WORD_WIDTH),
      .PARTS(PARTS)
  ) u_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (sram_cfg_o),
      .read_en_i   (read),
      .read_addr_i (address_i),
      .read_data_o (read_data),
      .write_en_i  (write),
      .write_addr_i(address_i),
      .write_parts_i(part_writes),
      .write_data_i(write_data)
  );

  generate
    if (PARITY != 0) begin : g_parity
      dtof_pool_word_parity #(
          .PAIRS     (PAIRS),
          .WORD_WIDTH(WORD_WIDTH),
          .LATE_WIDTH(HALF_WIDTH - PIXEL_WIDTH)
      ) u_word_parity (
          .clk_i       (clk_i),
          .read_i      (read),
          .read_data_i (read_data),
          .write_i     (write),
          .write_data_i(write_data),
          .accessed_o  (accessed_o),
          .parity_o    (parity_o)
      );
    end else begin : g_no_parity
      assign accessed_o = 1'b0;
      assign parity_o = 1'b0;
    end
  endgenerate

  // Held in stream phases, which begin long after the engine's last read.
  always_ff @(posedge clk_i) begin
    needed_q <= needed;
    first_load_q <= word_load_d_i && needed;
    word_load_q <= first_load_q || (late_i && needed && !coarse_i);
    due_next_q <= word_load_d_i;
    due_q <= due_next_q;
    sweep_q <= sweep_i;
    make_room_q <= make_room_i;
    if (engine_i) begin
      engine_load_q <= read_i && select_i != '0;
    end
  end

  `DTOF_ASSERT(a_one_pair, (select_i & (select_i - 1'b1)) == '0, "engines ask for both pairs of an SRAM at once")

  genvar w, p;
  generate
    for (w = 0; w < PARTS; w = w + 1) begin : g_part
      assign part_writes[w] = writes[w*PART_PIXELS+:PART_PIXELS] != '0;
    end
    for (p = 0; p < PAIRS; p = p + 1) begin : g_pair
      localparam int PAIR_COLUMNS = (2 * p + 1 < COLUMNS) ? 2 : 1;
      logic [LINE_WIDTH-1:0] word;

      dtof_pool_pair #(
          .COLUMNS         (PAIR_COLUMNS),
          .NP              (NP),
          .SLOTS           (SLOTS),
          .COUNT_WIDTH     (COUNT_WIDTH),
          .LABELS          (LABELS),
          .SCORE_BITS      (SCORE_BITS),
          .OFFSET_BITS     (OFFSET_BITS),
          .ADVANTAGE_WIDTH (ADVANTAGE_WIDTH),
          .POINTER_SHIFT   (POINTER_SHIFT),
          .RIVAL_MOVES     (RIVAL_MOVES),
          .CELL_SHIFT      (CELL_SHIFT),
          .TIME_GATE       (TIME_GATE),
          .PRIOR           (PRIOR),
          .BROADCAST_STAGES(BROADCAST_STAGES)
      ) u_pair (
          .clk_i           (clk_i),
          .timestamp_i     (timestamp_i[2*p*NP+:PAIR_COLUMNS*NP]),
          .gate_begin_i    (gate_begin_i),
          .gate_end_i      (gate_end_i),
          .coarse_i        (coarse_i),
          .point_i         (point_i),
          .beat_t1_i       (beat_t1_i),
          .first_slot_t1_i (first_slot_t1_i),
          .last_slot_t1_i  (last_slot_t1_i),
          .odd_t1_i        (odd_t1_i),
          .second_row_t0_i (second_row_t0_i),
          .first_row_t2_i  (first_row_t2_i),
          .second_row_t2_i (second_row_t2_i),
          .acquisition_t2_i(acquisition_t2_i),
          .thinning_t2_i   (thinning_t2_i),
          .keep_first_i    (keep_first_i),
          .keep_last_i     (keep_last_i),
          .optional_i      (optional_i),
          .late_i          (late_i),
          .load_i          (load_i),
          .needed_i        (needed_q),
          .part_i          (part_i),
          .sweep_i         (sweep_q),
          .make_room_i     (make_room_q),
          .read_i          (read_i),
          .engine_load_i   (engine_load_q),
          .read_data_i     (read_data[p*WORD_WIDTH+:WORD_WIDTH]),
          .needs_o         (needs[p]),
          .write_o         (writes[4*p+:4]),
          .write_data_o    (write_data[p*WORD_WIDTH+:WORD_WIDTH]),
          .first_load_i    (first_load_q),
          .word_load_i     (word_load_q),
          .due_i           (due_q),
          .group_load_i    (group_load_i),
          .group_upper_i   (group_upper_i),
          .engine_i        (engine_i),
          .replace_i       (replace_i),
          .clear_i         (clear_i),
          .select_i        (select_i[p]),
          .upper_i         (upper_i),
          .used_i          (used_i),
          .engine_word_i   (engine_word_i[p*HALF_WIDTH+:HALF_WIDTH]),
          .beside_word_i   ((p == 0) ? first_beside_i : second_beside_i),
          .word_o          (word)
      );
    end

    if (PAIRS == 2) begin : g_both
      assign second_word_o = g_pair[1].word;
    end else begin : g_first_alone
      assign second_word_o = second_beside_i;
    end
  endgenerate

  assign first_word_o = g_pair[0].word;

endmodule

`default_nettype wire
