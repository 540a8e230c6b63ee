// SPDX-License-Identifier: Apache-2.0
// Clock gate for FPGAs: none. A gated clock would leave the global clock tree, and what rests does so without it, too. A
// module of the same ports as the one in technology/behavioural, which it takes the place of.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_clock_gate (
    input  logic clk_i,
    input  logic enable_i,
    input  logic scan_mode_i,
    output logic clk_o
);

  assign clk_o = clk_i;

  logic unused;
  assign unused = ^{enable_i, scan_mode_i};

endmodule

`default_nettype wire
