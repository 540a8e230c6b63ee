// SPDX-License-Identifier: Apache-2.0
// Stores the time gate of a frame, once per array.
//
// Equation: gate = values of the ports in the clock of a start_i while busy_i is low.
// Latency: one clock, long before the first timestamp can come.
// Cost: 2 NP flip-flops; with TIME_GATE = 0 none, and the outputs are 0.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_gate_register #(
    parameter int NP = 10,
    parameter int TIME_GATE = 0
) (
    input  logic          clk_i,
    input  logic          start_i,
    input  logic          busy_i,
    input  logic [NP-1:0] gate_begin_i,
    input  logic [NP-1:0] gate_end_i,
    output logic [NP-1:0] gate_begin_o,
    output logic [NP-1:0] gate_end_o
);

  generate
    if (TIME_GATE != 0) begin : g_gate
      logic [NP-1:0] gate_begin_q, gate_end_q;
      always_ff @(posedge clk_i) begin
        if (start_i && !busy_i) begin
          gate_begin_q <= gate_begin_i;
          gate_end_q <= gate_end_i;
        end
      end
      assign gate_begin_o = gate_begin_q;
      assign gate_end_o = gate_end_q;
    end else begin : g_no_gate
      logic unused;
      assign unused = ^{clk_i, start_i, busy_i, gate_begin_i, gate_end_i};
      assign gate_begin_o = '0;
      assign gate_end_o = '0;
    end
  endgenerate

endmodule

`default_nettype wire
