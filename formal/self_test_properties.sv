// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_self_test: a self-test has one verdict, three clocks after its last word, and none after an abort; frame_o is that of the
// frame that began last; passed_o is never high during a self-test.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module self_test_properties #(
    parameter int NP = 3,
    parameter int PIXELS_PER_SRAM = 3,
    parameter int SRAM_NUM = 2,
    parameter int SLOTS = 2
) (
    input logic        clk_i,
    input logic        reset_i,
    input logic        clear_i,
    input logic        chosen_i,
    input logic        begin_i,
    input logic        abort_i,
    input logic [31:0] seed_i,
    input logic [31:0] expected_i,
    input logic        take_i,
    input logic        word_ends_i,
    input logic [31:0] crc_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic [SRAM_NUM*NP-1:0] line;
  logic frame, busy, passed, failed;

  dtof_self_test #(
      .NP             (NP),
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .SRAM_NUM       (SRAM_NUM),
      .SLOTS          (SLOTS)
  ) u_dut (
      .clk_i      (clk_i),
      .rst_ni     (rst_n),
      .clear_i    (clear_i),
      .chosen_i   (chosen_i),
      .begin_i    (begin_i),
      .abort_i    (abort_i),
      .seed_i     (seed_i),
      .expected_i (expected_i),
      .take_i     (take_i),
      .word_ends_i(word_ends_i),
      .crc_i      (crc_i),
      .line_o     (line),
      .frame_o    (frame),
      .busy_o     (busy),
      .passed_o   (passed),
      .failed_o   (failed)
  );

  // A frame begins while no self-test is under way, not with an abort. A frame has one last word.
  logic under_way_q, frame_q, passes_q;
  logic [1:0] clocks_q;  // since the last word: 1, 2, 3
  `ASSUME(m_begin, !begin_i || (!under_way_q && !abort_i))
  `ASSUME(m_word, !word_ends_i || clocks_q == 2'd0)
  `ASSUME(m_clear, !clear_i || !under_way_q)

  logic ends;
  assign ends = under_way_q && clocks_q == 2'd3 && !abort_i;

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      under_way_q <= 1'b0;
      frame_q <= 1'b0;
      clocks_q <= '0;
      passes_q <= 1'b0;
    end else begin
      if (begin_i) frame_q <= chosen_i;
      under_way_q <= (begin_i && chosen_i) || (under_way_q && !abort_i && !ends);
      clocks_q <= (!under_way_q || abort_i || ends) ? 2'd0 : (word_ends_i || clocks_q != 2'd0) ? clocks_q + 2'd1 : 2'd0;
      if (clear_i || (begin_i && chosen_i)) begin
        passes_q <= 1'b0;
      end else if (ends) begin
        passes_q <= (crc_i == expected_i);
      end
    end
  end

  `PROVE(a_frame, !rst_n || frame == frame_q)
  `PROVE(a_busy, !rst_n || busy == under_way_q)
  `PROVE(a_failed, !rst_n || failed == (ends && crc_i != expected_i))
  `PROVE(a_passed, !rst_n || passed == passes_q)
  `PROVE(a_no_verdict_yet, !rst_n || !(busy && passed))
  `GOAL(rst_n && passed && frame)

endmodule

`default_nettype wire
