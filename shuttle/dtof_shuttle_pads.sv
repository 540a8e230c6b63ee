// SPDX-License-Identifier: Apache-2.0
// dtof_shuttle with the pads of IHP SG13G2 (library sg13g2_io): five signals, two pads of each supply.
//
// The names of the instances are those that a script for the pad ring places. A pad has no clocked part.
// Latency: that of dtof_shuttle. Cost: 13 pads.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_shuttle_pads #(
    parameter int READOUT = dtof_pkg::READOUT_EZPOINTER,  // as in dtof_shuttle
    parameter int COLUMNS = 16,
    parameter int ROWS = 16
) (
    inout wire clk_pad,
    inout wire rst_n_pad,
    inout wire rx_pad,
    inout wire tx_pad,
    inout wire frame_pad
);

  logic clk, rst_n, rx, tx, frame;

  (* keep *) sg13g2_IOPadIn u_pad_clk (.pad(clk_pad), .p2c(clk));
  (* keep *) sg13g2_IOPadIn u_pad_rst_n (.pad(rst_n_pad), .p2c(rst_n));
  (* keep *) sg13g2_IOPadIn u_pad_rx (.pad(rx_pad), .p2c(rx));
  (* keep *) sg13g2_IOPadOut4mA u_pad_tx (.pad(tx_pad), .c2p(tx));
  (* keep *) sg13g2_IOPadOut4mA u_pad_frame (.pad(frame_pad), .c2p(frame));

  // Supplies of the core (Vdd, Vss) and of the pads (IOVdd, IOVss). A layout connects them by abutment.
  (* keep *) sg13g2_IOPadVdd u_pad_vdd_0 ();
  (* keep *) sg13g2_IOPadVdd u_pad_vdd_1 ();
  (* keep *) sg13g2_IOPadVss u_pad_vss_0 ();
  (* keep *) sg13g2_IOPadVss u_pad_vss_1 ();
  (* keep *) sg13g2_IOPadIOVdd u_pad_iovdd_0 ();
  (* keep *) sg13g2_IOPadIOVdd u_pad_iovdd_1 ();
  (* keep *) sg13g2_IOPadIOVss u_pad_iovss_0 ();
  (* keep *) sg13g2_IOPadIOVss u_pad_iovss_1 ();

  dtof_shuttle #(
      .READOUT(READOUT),
      .COLUMNS(COLUMNS),
      .ROWS   (ROWS)
  ) u_core (
      .clk_i  (clk),
      .rst_ni (rst_n),
      .rx_i   (rx),
      .tx_o   (tx),
      .frame_o(frame)
  );

endmodule

`default_nettype wire
