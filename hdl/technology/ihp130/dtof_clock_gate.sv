// SPDX-License-Identifier: Apache-2.0
// Clock gate of IHP SG13G2: the cell sg13g2_lgcp_1, a latch and an AND. The ports are those of technology/behavioural/dtof_clock_gate.sv.
// Latency: none. Cost: one cell and an OR gate.

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

  sg13g2_lgcp_1 u_gate (
      .CLK (clk_i),
      .GATE(enable_i || scan_mode_i),
      .GCLK(clk_o)
  );

  logic unused;
  assign unused = (NEEDED != 0);

endmodule

`default_nettype wire
