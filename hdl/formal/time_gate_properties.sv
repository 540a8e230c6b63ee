// SPDX-License-Identifier: Apache-2.0
// A timestamp x with gate_begin <= x < gate_end passes, any other becomes "no detection"; one clock late.
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
  logic [NP-1:0] timestamp_t1, timestamp_q, gate_begin_q, gate_end_q;

  time_gate #(
      .NP       (NP),
      .TIME_GATE(TIME_GATE)
  ) u_dut (
      .clk_i         (clk_i),
      .timestamp_i   (timestamp_i),
      .gate_begin_i  (gate_begin_i),
      .gate_end_i    (gate_end_i),
      .timestamp_t1_o(timestamp_t1)
  );

  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
    timestamp_q <= timestamp_i;
    gate_begin_q <= gate_begin_i;
    gate_end_q <= gate_end_i;
  end

  logic in_gate;
  assign in_gate = (TIME_GATE == 0) || (gate_begin_q <= timestamp_q && timestamp_q < gate_end_q);

  `PROVE(a_in_gate_passes, !in_gate || timestamp_t1 == timestamp_q)
  `PROVE(a_outside_is_no_detection, in_gate || timestamp_t1 == '1)
  `GOAL(timestamp_t1 != '1)

endmodule
