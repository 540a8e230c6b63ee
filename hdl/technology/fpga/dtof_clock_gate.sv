// SPDX-License-Identifier: Apache-2.0
// Replacement of the clock gate for FPGAs: no gate, because a gated clock would leave the global clock tree. Registers that hold do so
// without the gate, too. The ports are those of technology/behavioural/dtof_clock_gate.sv. If the gate is needed (dtof_subsystem
// with CLOCK_WAITS = 1), elaboration stops: use CLOCK_WAITS = 0, or instantiate the family's clock buffer with an enable here (BUFGCE
// of AMD, DCCA of Lattice's ECP5).
// Latency: none. Cost: none.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_clock_gate #(
    parameter int NEEDED = 0  // 1: the logic behind the gate fails without the gate; 0: the gate only saves power
) (
    input  logic clk_i,
    input  logic enable_i,
    input  logic scan_mode_i,
    output logic clk_o
);

  `DTOF_REQUIRE(g_needed, NEEDED == 0, "dtof_clock_gate: this technology has no clock gate: CLOCK_WAITS must be 0")

  assign clk_o = clk_i;

  logic unused;
  assign unused = ^{enable_i, scan_mode_i};

endmodule

`default_nettype wire
