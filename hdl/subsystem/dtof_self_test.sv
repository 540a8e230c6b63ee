// SPDX-License-Identifier: Apache-2.0
// Built-in self-test: gives the array lines of pseudo-random timestamps instead of the source's lines, and compares the CRC-32 of the
// frame's words with the expected value.
//
// 1. A frame that begins with chosen_i is a self-test. From its begin to the begin of the next frame frame_o is high: the array takes
//    line_o, the source's lines wait in the line buffer, and no word leaves the subsystem.
// 2. A line follows from three parts: a state of 32 bits, which makes a step of xorshift32 (Marsaglia 2003: shifts 13, 17, 5) per line; a
//    coarse code of the row; a constant of each column. The state begins at seed_i, or 1 instead of 0, in each self-test.
// 3. A timestamp of a column is with a probability of 1/2 in the coarse bin of its pixel's target, of 1/4 anywhere, and of 1/4 no
//    detection. Targets of neighbours lie in different coarse bins. The timestamps of a pixel's slots are in no order.
// 4. After the frame's last word (word_ends_i) the CRC must be expected_i, else failed_o is high for one clock. abort_i ends the
//    self-test without a verdict.
//
// Equation: for column c, MIXED = (c + 1) * 0x9E3779B1 mod 2^32 and r = (state rotated right by 5 c mod 32) ^ MIXED,
//   timestamp = {r[17] ? row_code ^ MIXED[31:27] : r[15:11], r[NP-6:0]}, or all ones if r[17:16] = 1;
//   row_code = 19 row mod 32. With NP < 6 a coarse code has the lowest NP - 1 of these bits.
// SelfTestLines in tb_cpp/subsystem/self_test_reference.hpp is the same in C++.
// Schedule: clock 0 word_ends_i, clock 3 crc_i is the frame's; in clock 4 passed_o is valid and busy_o is low.
// Latency: none; line_o is combinational, behind flip-flops.
// Cost: NP = 10, 160 rows, 2 slots: 53 flip-flops, and 2620 two-input gates and multiplexers for 200 columns (1704 for 100), as Yosys 0.23 synth
// counts them. Around this module dtof_subsystem has a multiplexer of SRAM_NUM x NP bits and 65 flip-flops of registers.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_self_test #(
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SRAM_NUM = 200,
    parameter int SLOTS = 2
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   clear_i,      // clears passed_o: a self-test is commanded
    input  logic                   chosen_i,     // with begin_i: the frame is a self-test
    input  logic                   begin_i,      // a frame begins
    input  logic                   abort_i,      // the frame ends now
    input  logic [           31:0] seed_i,       // sampled with begin_i
    input  logic [           31:0] expected_i,   // stable until the end
    input  logic                   take_i,       // the array takes line_o
    input  logic                   word_ends_i,  // the last word of a frame is taken, and the frame was not aborted
    input  logic [           31:0] crc_i,        // of that frame, three clocks later
    output logic [SRAM_NUM*NP-1:0] line_o,       // column 0 in the lowest bits
    output logic                   frame_o,      // the frame that began last is a self-test
    output logic                   busy_o,       // a self-test is under way, to the comparison
    output logic                   passed_o,     // the last self-test has passed
    output logic                   failed_o      // high for one clock
);

  localparam int COARSE = dtof_pkg::min_of(5, NP - 1);  // bits of a coarse code
  localparam int FINE = NP - COARSE;
  localparam int LINES = PIXELS_PER_SRAM * SLOTS;
  localparam int LINE_WIDTH = dtof_pkg::index_width(LINES);
  localparam int SLOT_WIDTH = dtof_pkg::index_width(SLOTS);

  // The frame, and its verdict.

  logic frame_q, busy_q, passed_q, ends_q, waits_q, compare_q, equal;

  assign equal = (crc_i == expected_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      frame_q <= 1'b0;
      busy_q <= 1'b0;
      passed_q <= 1'b0;
      ends_q <= 1'b0;
      waits_q <= 1'b0;
      compare_q <= 1'b0;
    end else begin
      if (begin_i) begin
        frame_q <= chosen_i;
      end
      busy_q <= (begin_i && chosen_i) || (busy_q && !compare_q && !abort_i);
      ends_q <= word_ends_i && busy_q && !abort_i;
      waits_q <= ends_q && !abort_i;
      compare_q <= waits_q && !abort_i;
      passed_q <= !clear_i && !(begin_i && chosen_i) && (passed_q || (compare_q && equal && !abort_i));
    end
  end

  assign frame_o = frame_q;
  assign busy_o = busy_q;
  assign passed_o = passed_q;
  assign failed_o = compare_q && !equal && !abort_i;

  // Lines.

  logic [31:0] state_q, step_1, step_2, step_3;
  logic [COARSE-1:0] row_code_q;
  logic [LINE_WIDTH-1:0] line_q;
  logic [SLOT_WIDTH-1:0] slot_q;
  logic last_line, last_slot;

  assign step_1 = state_q ^ (state_q << 13);
  assign step_2 = step_1 ^ (step_1 >> 17);
  assign step_3 = step_2 ^ (step_2 << 5);
  assign last_line = (line_q == LINE_WIDTH'(LINES - 1));
  assign last_slot = (slot_q == SLOT_WIDTH'(SLOTS - 1));

  always_ff @(posedge clk_i) begin
    if (begin_i) begin
      state_q <= (seed_i == '0) ? 32'd1 : seed_i;
      row_code_q <= '0;
      line_q <= '0;
      slot_q <= '0;
    end else if (take_i) begin
      state_q <= step_3;
      line_q <= last_line ? '0 : line_q + 1'b1;
      slot_q <= last_slot ? '0 : slot_q + 1'b1;
      if (last_slot) begin
        row_code_q <= last_line ? '0 : row_code_q + COARSE'(19);
      end
    end
  end

  genvar c;
  generate
    for (c = 0; c < SRAM_NUM; c = c + 1) begin : g_column
      localparam int ROTATION = (5 * c) % 32;
      localparam logic [31:0] MIXED = (32'(c) + 32'd1) * 32'h9e3779b1;
      logic [63:0] twice;
      logic [31:0] random;
      logic [COARSE-1:0] coarse;
      assign twice = {state_q, state_q} >> ROTATION;
      assign random = twice[31:0] ^ MIXED;
      assign coarse = random[17] ? row_code_q ^ MIXED[27+:COARSE] : random[11+:COARSE];
      assign line_o[c*NP+:NP] = {coarse, random[FINE-1:0]} | {NP{random[17:16] == 2'b01}};
      logic unused_random;
      assign unused_random = ^{twice[63:32], random};
    end
  endgenerate

endmodule

`default_nettype wire
