// SPDX-License-Identifier: Apache-2.0
// Model of IHP's clock gate for simulations of RTL: a latch that is transparent while the clock is low, and an AND.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module sg13g2_lgcp_1 (
    input  logic CLK,
    input  logic GATE,
    output logic GCLK
);

  logic enable;

  always_latch begin
    if (!CLK) begin
      enable = GATE;
    end
  end

  assign GCLK = CLK && enable;

endmodule

`default_nettype wire
