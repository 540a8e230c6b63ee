// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_timestamp_input: a timestamp x is a detection if gate_begin <= x < gate_end and x is not all ones; it is at T0 after
// STAGES clocks and at T1 one clock later; the register of T1 holds the last detection.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module timestamp_input_properties #(
    parameter int NP = 10,
    parameter int TIME_GATE = 1,
    parameter int STAGES = 2
) (
    input logic          clk_i,
    input logic [NP-1:0] timestamp_i,
    input logic [NP-1:0] gate_begin_i,
    input logic [NP-1:0] gate_end_i
);

  logic [NP-1:0] timestamp_t1, last_q;
  logic detected_t0, detected_t1;
  logic expected;

  dtof_timestamp_input #(
      .NP       (NP),
      .TIME_GATE(TIME_GATE),
      .STAGES   (STAGES)
  ) u_dut (
      .clk_i         (clk_i),
      .timestamp_i   (timestamp_i),
      .gate_begin_i  (gate_begin_i),
      .gate_end_i    (gate_end_i),
      .detected_t0_o (detected_t0),
      .detected_t1_o (detected_t1),
      .timestamp_t1_o(timestamp_t1)
  );

  // Timestamps at the input, that of the last clock lowest; `known` is all ones when the harness has seen all of them.
  logic [STAGES+1:0] known = '0;
  logic checking, expected_q;
  logic [(STAGES+1)*NP-1:0] timestamps_q;
  logic [NP-1:0] timestamp_t0, timestamp_q;

  assign checking = known[STAGES+1];
  assign timestamp_t0 = timestamps_q[(STAGES-1)*NP+:NP];
  assign timestamp_q = timestamps_q[STAGES*NP+:NP];
  assign expected = (32'(timestamp_t0) != (1 << NP) - 1)
      && ((TIME_GATE == 0) || (gate_begin_i <= timestamp_t0 && timestamp_t0 < gate_end_i));

  always_ff @(posedge clk_i) begin
    known <= {known[STAGES:0], 1'b1};
    expected_q <= expected;
    timestamps_q <= {timestamps_q[STAGES*NP-1:0], timestamp_i};
    last_q <= timestamp_t1;
  end

  `PROVE(a_detected, detected_t0 == expected)
  `PROVE(a_detected_late, detected_t1 == expected_q)
  `PROVE(a_detection_passes, !expected_q || timestamp_t1 == timestamp_q)
  `PROVE(a_kept, expected_q || timestamp_t1 == last_q)
  `GOAL(detected_t1)

endmodule

`default_nettype wire
