// SPDX-License-Identifier: Apache-2.0
// The timestamp register of a column (T0) and, with TIME_GATE = 1, the digital time gate in front of it.
//
// Equation: x' = (gate_begin_i <= x < gate_end_i) ? x : "no detection" (all ones).
// Latency: one clock, with or without the gate. gate_begin_i and gate_end_i do not change during a frame.
// Cost: NP flip-flops; the gate adds two comparators of NP bits, TIME_GATE = 0 nothing.
module time_gate #(
    parameter int NP = 10,
    parameter int TIME_GATE = 0
) (
    input  logic          clk_i,
    input  logic [NP-1:0] timestamp_i,
    input  logic [NP-1:0] gate_begin_i,
    input  logic [NP-1:0] gate_end_i,
    output logic [NP-1:0] timestamp_t1_o
);

  logic [NP-1:0] timestamp_d, timestamp_q;

  generate
    if (TIME_GATE != 0) begin : g_gate
      logic outside;
      assign outside = (timestamp_i < gate_begin_i) || (timestamp_i >= gate_end_i);
      assign timestamp_d = timestamp_i | {NP{outside}};
    end else begin : g_no_gate
      logic unused_gate;
      assign unused_gate = ^{gate_begin_i, gate_end_i};
      assign timestamp_d = timestamp_i;
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    timestamp_q <= timestamp_d;
  end

  assign timestamp_t1_o = timestamp_q;

endmodule
