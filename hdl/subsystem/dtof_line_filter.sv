// SPDX-License-Identifier: Apache-2.0
// Replaces timestamps that do not count by "no detection": those of disabled columns and, with TIME_GATE = 1, those outside the
// time gate. Combinational.
//
// Equation: x' = (column enabled and gate_begin_i <= x < gate_end_i) ? x : "no detection" (all ones).
// Latency: none; the arrays register the line.
// Cost: NP gates per column; with TIME_GATE = 1 two more comparators of NP bits per column.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_line_filter #(
    parameter int NP = 10,
    parameter int SRAM_NUM = 200,
    parameter int TIME_GATE = 0
) (
    input  logic [SRAM_NUM*NP-1:0] line_i,       // column 0 in the lowest bits
    input  logic [   SRAM_NUM-1:0] enable_i,
    input  logic [         NP-1:0] gate_begin_i,
    input  logic [         NP-1:0] gate_end_i,
    output logic [SRAM_NUM*NP-1:0] line_o
);

  genvar c;
  generate
    for (c = 0; c < SRAM_NUM; c = c + 1) begin : g_column
      logic outside;
      if (TIME_GATE != 0) begin : g_gate
        assign outside = (line_i[c*NP+:NP] < gate_begin_i) || (line_i[c*NP+:NP] >= gate_end_i);
      end else begin : g_no_gate
        assign outside = 1'b0;
      end
      assign line_o[c*NP+:NP] = line_i[c*NP+:NP] | {NP{outside || !enable_i[c]}};
    end
    if (TIME_GATE == 0) begin : g_unused
      logic unused_gate;
      assign unused_gate = ^{gate_begin_i, gate_end_i};
    end
  endgenerate

endmodule

`default_nettype wire
