// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_line_filter: a timestamp leaves unchanged if its column is enabled and, with TIME_GATE = 1, the gate includes it; any other
// timestamp leaves as no detection. The harness watches one arbitrary column of any line, with any mask and any gate.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module line_filter_properties #(
    parameter int NP = 10,
    parameter int SRAM_NUM = 5,
    parameter int TIME_GATE = 1
) (
    input logic                   clk_i,
    input logic [SRAM_NUM*NP-1:0] line_i,
    input logic [   SRAM_NUM-1:0] enable_i,
    input logic [         NP-1:0] gate_begin_i,
    input logic [         NP-1:0] gate_end_i
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic [SRAM_NUM*NP-1:0] line;

  dtof_line_filter #(
      .NP       (NP),
      .SRAM_NUM (SRAM_NUM),
      .TIME_GATE(TIME_GATE)
  ) u_dut (
      .line_i      (line_i),
      .enable_i    (enable_i),
      .gate_begin_i(gate_begin_i),
      .gate_end_i  (gate_end_i),
      .line_o      (line)
  );

  (* anyconst *) logic [7:0] watched_column;
  localparam int NO_DETECTION = (1 << NP) - 1;

  logic enabled, counts;
  integer before, behind, first, past;
  assign enabled = ((enable_i >> watched_column) & 1'b1) != '0;
  assign before = 32'(NP'(line_i >> (32'(watched_column) * NP)));
  assign behind = 32'(NP'(line >> (32'(watched_column) * NP)));
  assign first = 32'(gate_begin_i);
  assign past = 32'(gate_end_i);
  assign counts = enabled && (TIME_GATE == 0 || (first <= before && before < past));

  `ASSUME(m_watched, 32'(watched_column) < SRAM_NUM)
  `PROVE(a_kept, !counts || behind == before)
  `PROVE(a_replaced, counts || behind == NO_DETECTION)
  `GOAL(counts && before == past - 1 && first < before && enable_i == SRAM_NUM'(1) << watched_column && watched_column != '0)

endmodule

`default_nettype wire
