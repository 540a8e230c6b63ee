// SPDX-License-Identifier: Apache-2.0
// Top module of a chip for a shared run of an open process (make shuttle, docs/user/shuttle.md): demonstrator_core behind a synchronised
// reset, with memories of flip-flops (hdl/technology/ihp130). The five ports go to pads.
//
// READOUT: ezPointer, or poolPointer with lean's parameters.
// Latency: that of dtof_subsystem. Cost: reports/shuttle.md.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_shuttle #(
    parameter int READOUT = dtof_pkg::READOUT_EZPOINTER,  // or dtof_pkg::READOUT_POOLPOINTER: lean
    parameter int NP = 10,
    parameter int COLUMNS = 16,
    parameter int ROWS = 16,
    parameter int ACQUISITIONS = 1000,
    parameter int CLOCKS_PER_BIT = 16  // 3 Mbaud at 48 MHz
) (
    input  logic clk_i,
    input  logic rst_ni,  // asynchronous to clk_i
    input  logic rx_i,    // serial line: commands (fpga/target_command.sv)
    output logic tx_o,    // serial line: results (fpga/word_sender.sv)
    output logic frame_o  // toggles with every frame
);

  `DTOF_REQUIRE(g_illegal_readout, READOUT == dtof_pkg::READOUT_EZPOINTER || READOUT == dtof_pkg::READOUT_POOLPOINTER,
                "dtof_shuttle: READOUT must be READOUT_EZPOINTER or READOUT_POOLPOINTER")

  logic rst_n;

  dtof_reset_synchroniser u_reset (
      .clk_i      (clk_i),
      .rst_ni     (rst_ni),
      .scan_mode_i(1'b0),
      .rst_no     (rst_n)
  );

  demonstrator_core #(
      .READOUT       (READOUT),
      .NP            (NP),
      .COLUMNS       (COLUMNS),
      .ROWS          (ROWS),
      .ACQUISITIONS  (ACQUISITIONS),
      .CLOCKS_PER_BIT(CLOCKS_PER_BIT),
      .CLOCK_WAITS   (1)
  ) u_core (
      .clk_i  (clk_i),
      .rst_ni (rst_n),
      .rx_i   (rx_i),
      .tx_o   (tx_o),
      .frame_o(frame_o)
  );

endmodule

`default_nettype wire
