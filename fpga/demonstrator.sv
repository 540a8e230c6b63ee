// SPDX-License-Identifier: Apache-2.0
// Top module of an FPGA that demonstrates dtof_subsystem without a sensor (make fpga, docs/user/integration.md): demonstrator_core, and a
// reset without an input. The FPGA's configuration clears the registers of the reset, which ends eight clocks later.
// Latency: that of dtof_subsystem. Cost: that of demonstrator_core, four flip-flops.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module demonstrator #(
    parameter int READOUT = dtof_pkg::READOUT_HISPOINTER,  // or dtof_pkg::READOUT_POOLPOINTER: lean
    parameter int NP = 10,
    parameter int COLUMNS = 8,
    parameter int ROWS = 8,
    parameter int ACQUISITIONS = 1000,
    parameter int CLOCKS_PER_BIT = 12
) (
    input  logic clk_i,
    input  logic rx_i,
    output logic tx_o,
    output logic frame_o  // toggles with every frame: for a light
);

  logic [2:0] awake_q = '0;
  logic rst_n = 1'b0;

  always_ff @(posedge clk_i) begin
    if (awake_q != '1) begin
      awake_q <= awake_q + 1'b1;
    end
    rst_n <= (awake_q == '1);
  end

  demonstrator_core #(
      .READOUT       (READOUT),
      .NP            (NP),
      .COLUMNS       (COLUMNS),
      .ROWS          (ROWS),
      .ACQUISITIONS  (ACQUISITIONS),
      .CLOCKS_PER_BIT(CLOCKS_PER_BIT)
  ) u_core (
      .clk_i  (clk_i),
      .rst_ni (rst_n),
      .rx_i   (rx_i),
      .tx_o   (tx_o),
      .frame_o(frame_o)
  );

endmodule

`default_nettype wire
