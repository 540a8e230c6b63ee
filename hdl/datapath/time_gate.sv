// SPDX-License-Identifier: Apache-2.0
// The timestamp register of a column (T0) and, with TIME_GATE = 1, the digital time gate in front of it.
//
// Equation: a detection is a timestamp x that is not all ones and, with the gate, gate_begin_i <= x < gate_end_i.
// Latency: one clock, with or without the gate. gate_begin_i and gate_end_i do not change during a frame.
// The register loads detections alone: between them what follows it rests, and so does its clock.
// Cost: NP + 1 flip-flops; the gate adds two comparators of NP bits, TIME_GATE = 0 nothing.
module time_gate #(
    parameter int NP = 10,
    parameter int TIME_GATE = 0
) (
    input  logic          clk_i,
    input  logic [NP-1:0] timestamp_i,
    input  logic [NP-1:0] gate_begin_i,
    input  logic [NP-1:0] gate_end_i,
    output logic          detected_t0_o,  // timestamp_i is a detection; combinational
    output logic          detected_t1_o,
    output logic [NP-1:0] timestamp_t1_o  // of the last detection
);

  logic in_gate, detected_q;
  logic [NP-1:0] timestamp_q;

  generate
    if (TIME_GATE != 0) begin : g_gate
      assign in_gate = !(timestamp_i < gate_begin_i) && !(timestamp_i >= gate_end_i);
    end else begin : g_no_gate
      logic unused_gate;
      assign unused_gate = ^{gate_begin_i, gate_end_i};
      assign in_gate = 1'b1;
    end
  endgenerate

  assign detected_t0_o = in_gate && (timestamp_i != '1);

  always_ff @(posedge clk_i) begin
    detected_q <= detected_t0_o;
    if (detected_t0_o) begin
      timestamp_q <= timestamp_i;
    end
  end

  assign detected_t1_o = detected_q;
  assign timestamp_t1_o = timestamp_q;

endmodule
