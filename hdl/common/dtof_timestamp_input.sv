// SPDX-License-Identifier: Apache-2.0
// Input of a column's timestamps: selects the detections, delays them by as many clocks as commands of the shared logic take to reach
// the column and, with TIME_GATE = 1, applies the digital time gate.
//
// Equation: a detection is a timestamp x that is not all ones and, with the gate, gate_begin_i <= x < gate_end_i.
// Commands take STAGES clocks to reach a column (dtof_broadcast.sv). Timestamps are delayed by the same number of clocks, so that
// both are aligned in the column. One bit per stage marks a detection. The registers of the timestamp load
// only detections, so without a detection no register switches, and their clocks are gated.
//
//   clock         what happens
//   T0 - STAGES   the timestamp is at the port and is compared with all ones
//   T0            the timestamp is compared with the ends of the gate, which arrive with the commands
//   T1            the column uses the timestamp
//
// Latency: STAGES + 1 clocks, with or without the gate. gate_begin_i and gate_end_i do not change during a frame.
// Cost: (STAGES + 1) (NP + 1) flip-flops; the gate adds two comparators of NP bits, TIME_GATE = 0 nothing.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_timestamp_input #(
    parameter int NP = 10,
    parameter int TIME_GATE = 0,
    parameter int STAGES = 2  // clocks from the array's control to the column, at least 1
) (
    input  logic          clk_i,
    input  logic [NP-1:0] timestamp_i,    // all ones: no detection
    input  logic [NP-1:0] gate_begin_i,
    input  logic [NP-1:0] gate_end_i,
    output logic          detected_t0_o,  // combinational if TIME_GATE = 1
    output logic          detected_t1_o,
    output logic [NP-1:0] timestamp_t1_o  // last detection
);

  `DTOF_REQUIRE(g_illegal_stages, STAGES >= 1, "dtof_timestamp_input: STAGES must be at least 1")

  // [s]: s clocks after the port, before the gate. [STAGES] is at the input of the register of T1.
  logic [STAGES:0] detected;
  logic [(STAGES+1)*NP-1:0] timestamps;
  logic in_gate, detected_q;
  logic [NP-1:0] timestamp_t0, timestamp_q;

  assign detected[0] = (timestamp_i != '1);
  assign timestamps[NP-1:0] = timestamp_i;
  assign timestamp_t0 = timestamps[STAGES*NP+:NP];

  genvar s;
  generate
    for (s = 0; s < STAGES; s = s + 1) begin : g_stage
      logic waiting_detected_q;
      logic [NP-1:0] waiting_q;
      always_ff @(posedge clk_i) begin
        waiting_detected_q <= detected[s];
        if (detected[s]) begin
          waiting_q <= timestamps[s*NP+:NP];
        end
      end
      assign detected[s+1] = waiting_detected_q;
      assign timestamps[(s+1)*NP+:NP] = waiting_q;
    end

    if (TIME_GATE != 0) begin : g_gate
      assign in_gate = !(timestamp_t0 < gate_begin_i) && !(timestamp_t0 >= gate_end_i);
    end else begin : g_no_gate
      logic unused_gate;
      assign unused_gate = ^{gate_begin_i, gate_end_i};
      assign in_gate = 1'b1;
    end
  endgenerate

  assign detected_t0_o = detected[STAGES] && in_gate;

  always_ff @(posedge clk_i) begin
    detected_q <= detected_t0_o;
    if (detected_t0_o) begin
      timestamp_q <= timestamp_t0;
    end
  end

  assign detected_t1_o = detected_q;
  assign timestamp_t1_o = timestamp_q;

endmodule

`default_nettype wire
