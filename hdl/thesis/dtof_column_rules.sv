// SPDX-License-Identifier: Apache-2.0
// Rules for the signals that all columns of dtof_array share, as assertions: checked in simulation, proved in the array (proof
// dtof_array); synthesis leaves it out.
//
// 1. Timestamps and scans are never in a column at the same time, so that they can share its memories.
// 2. A pixel's word is not set in the clock in which a word is written. If timestamps do not change words and the SRAM has one port,
//    a word is not set in the clock in which a word is read.
// 3. The result chain does not load and shift in the same clock.
// Latency: none. Cost: none in silicon.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_column_rules #(
    parameter int COARSE_PASSES = 1,
    parameter int WORD_MOVED = 0  // 1: timestamps change a pixel's word, in an SRAM with the ports for this
) (
    input logic clk_i,
    input logic rst_ni,
    input logic first_pass_i,
    input logic final_pass_i,
    input logic beat_t1_i,
    input logic visit_t1_i,
    input logic beat_t5_i,
    input logic scan_s0_i,
    input logic clear_s1_i,
    input logic scan_s2_i,
    input logic word_read_i,
    input logic word_read_done_i,
    input logic word_set_i,
    input logic word_write_i,
    input logic result_load_i,
    input logic result_shift_i
);

  logic word_read_q;
  logic [2:1] scan_sn_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      word_read_q <= 1'b0;
      scan_sn_q <= '0;
    end else begin
      word_read_q <= word_read_i;
      scan_sn_q <= {scan_sn_q[1], scan_s0_i};
    end
  end

  `DTOF_ASSERT(a_first_and_final, COARSE_PASSES == 0 || !(first_pass_i && final_pass_i),
               "a pass of several is the first and the final one")
  `DTOF_ASSERT(a_stream_or_scan, !((beat_t1_i || beat_t5_i) && (scan_s0_i || clear_s1_i)),
               "scanned or cleared with timestamps in the pipeline")
  `DTOF_ASSERT(a_visit, !visit_t1_i || beat_t1_i, "a visit begins without a timestamp")
  `DTOF_ASSERT(a_scan_stages, scan_s2_i == scan_sn_q[2], "a scanned count is not two clocks behind its address")
  `DTOF_ASSERT(a_read_done, word_read_done_i == word_read_q, "a word's data is not one clock behind its read")
  `DTOF_ASSERT(a_one_write, !(word_set_i && word_write_i), "a word is set while another one is written")
  `DTOF_ASSERT(a_one_access, WORD_MOVED != 0 || !(word_set_i && word_read_i),
               "a word is set while another one is read")
  `DTOF_ASSERT(a_load_or_shift, !(result_load_i && result_shift_i), "a result is loaded while the chain shifts")

endmodule

`default_nettype wire
