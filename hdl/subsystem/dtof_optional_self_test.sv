// SPDX-License-Identifier: Apache-2.0
// The self-test of dtof_subsystem: with SELF_TEST = 1 a dtof_self_test, and the choice of the frame for which it works; with SELF_TEST = 0 nothing,
// and all outputs are 0.
//
// A self-test begins when all words have left, so that the words behind its begin are its own.
// Latency: that of dtof_self_test.
// Cost: that of dtof_self_test.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_optional_self_test #(
    parameter int SELF_TEST = 0,
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SRAM_NUM = 200,
    parameter int SLOTS = 2
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   self_test_i,   // software asks for a self-test
    input  logic                   words_left_i,  // the sink has not taken all words
    input  logic                   busy_i,        // a frame is in progress, or the array's reset
    input  logic                   begin_i,       // a frame begins
    input  logic                   abort_i,
    input  logic [           31:0] seed_i,
    input  logic [           31:0] expected_i,
    input  logic                   take_i,        // the array takes a line
    input  logic                   word_ends_i,   // the last word of a frame has left
    input  logic [           31:0] crc_i,
    output logic                   refused_o,     // self_test_i has no effect
    output logic                   chosen_o,      // the frame that begins is a self-test
    output logic                   frame_o,       // the frame that began last is a self-test
    output logic [SRAM_NUM*NP-1:0] line_o,
    output logic                   busy_o,
    output logic                   passed_o,
    output logic                   failed_o
);

  assign refused_o = self_test_i && words_left_i;
  assign chosen_o = self_test_i && !words_left_i && !busy_i;

  generate
    if (SELF_TEST != 0) begin : g_self_test
      dtof_self_test #(
          .NP             (NP),
          .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
          .SRAM_NUM       (SRAM_NUM),
          .SLOTS          (SLOTS)
      ) u_self_test (
          .clk_i      (clk_i),
          .rst_ni     (rst_ni),
          .clear_i    (self_test_i),
          .chosen_i   (chosen_o),
          .begin_i    (begin_i),
          .abort_i    (abort_i),
          .seed_i     (seed_i),
          .expected_i (expected_i),
          .take_i     (take_i),
          .word_ends_i(word_ends_i),
          .crc_i      (crc_i),
          .line_o     (line_o),
          .frame_o    (frame_o),
          .busy_o     (busy_o),
          .passed_o   (passed_o),
          .failed_o   (failed_o)
      );
    end else begin : g_no_self_test
      logic unused;
      assign unused = ^{clk_i, rst_ni, begin_i, abort_i, seed_i, expected_i, take_i, word_ends_i, crc_i};
      assign line_o = '0;
      assign {frame_o, busy_o, passed_o, failed_o} = '0;
    end
  endgenerate

endmodule

`default_nettype wire
