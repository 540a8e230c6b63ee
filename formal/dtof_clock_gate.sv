// SPDX-License-Identifier: Apache-2.0
// Clock gate for proofs with one clock: clk_o is the enable of the clock edge that ends the step. With `gated_clock = true` in proofs.toml,
// scripts/formal.py replaces each flip-flop behind clk_o by one that keeps its value while clk_o is low (formal/gated_clock.v).

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_clock_gate #(
    parameter int NEEDED = 0
) (
    input  logic clk_i,
    input  logic enable_i,
    input  logic scan_mode_i,
    output logic clk_o
);

  assign clk_o = enable_i || scan_mode_i;

  logic unused;
  assign unused = clk_i ^ (NEEDED != 0);

endmodule

`default_nettype wire
