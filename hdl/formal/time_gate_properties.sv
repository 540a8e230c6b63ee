// SPDX-License-Identifier: Apache-2.0
// A timestamp x with gate_begin <= x < gate_end that is not all ones is a detection, one clock late; the register keeps the
// last one.
`include "properties.svh"

module time_gate_properties #(
    parameter int NP = 10,
    parameter int TIME_GATE = 1
) (
    input logic          clk_i,
    input logic [NP-1:0] timestamp_i,
    input logic [NP-1:0] gate_begin_i,
    input logic [NP-1:0] gate_end_i
);

  logic checking = 1'b0;
  logic [NP-1:0] timestamp_t1, timestamp_q, last_q;
  logic detected_t0, detected_t1, detected_q;

  time_gate #(
      .NP       (NP),
      .TIME_GATE(TIME_GATE)
  ) u_dut (
      .clk_i         (clk_i),
      .timestamp_i   (timestamp_i),
      .gate_begin_i  (gate_begin_i),
      .gate_end_i    (gate_end_i),
      .detected_t0_o (detected_t0),
      .detected_t1_o (detected_t1),
      .timestamp_t1_o(timestamp_t1)
  );

  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
    timestamp_q <= timestamp_i;
    detected_q <= expected;
    last_q <= timestamp_t1;
  end

  logic expected;
  assign expected = (32'(timestamp_i) != (1 << NP) - 1)
      && ((TIME_GATE == 0) || (gate_begin_i <= timestamp_i && timestamp_i < gate_end_i));

  `PROVE(a_detected, detected_t0 == expected)
  `PROVE(a_detected_late, detected_t1 == detected_q)
  `PROVE(a_detection_passes, !detected_q || timestamp_t1 == timestamp_q)
  `PROVE(a_kept, detected_q || timestamp_t1 == last_q)
  `GOAL(detected_t1)

endmodule
