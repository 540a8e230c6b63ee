// SPDX-License-Identifier: Apache-2.0
// Stand-in for an integrated clock-gating cell. Replace it for silicon.
//
// A clock period with enable_i high ends with a rising edge of clk_o; with enable_i low it ends without an edge. scan_mode_i enables all
// edges. The latch is transparent while clk_i is low, so enable_i may settle until clk_i rises, and clk_o has no glitch.
// Latency: none. Cost: one cell.

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

  logic enable_q;

  always_latch begin
    if (!clk_i) begin
      enable_q = enable_i || scan_mode_i;
    end
  end

  assign clk_o = clk_i && enable_q;

  logic unused;
  assign unused = (NEEDED != 0);

endmodule

`default_nettype wire
