// SPDX-License-Identifier: Apache-2.0
// The rules of an AXI4-Stream source, which also hold for each channel of AXI4-Lite: valid is low in reset; after valid without ready,
// valid stays high and the data stay until ready.
// Source: AMBA AXI-Stream Protocol Specification (IHI 0051), sections 2.2 and 2.8.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module axi_stream_rules #(
    parameter int WIDTH = 1,
    parameter int ASSUMED = 0  // 1: the source is an input of the design, 0: the rules are proved
) (
    input logic             clk_i,
    input logic             rst_ni,
    input logic             checking,
    input logic             tvalid_i,
    input logic             tready_i,
    input logic [WIDTH-1:0] tdata_i    // all signals of the channel except valid and ready
);

  logic waits_q;
  logic [WIDTH-1:0] tdata_q;

  always_ff @(posedge clk_i) begin
    waits_q <= rst_ni && tvalid_i && !tready_i;
    tdata_q <= tdata_i;
  end

  generate
    if (ASSUMED != 0) begin : g_assumed
      `ASSUME(m_valid_holds, !(rst_ni && waits_q) || tvalid_i)
      `ASSUME(m_data_holds, !(rst_ni && waits_q) || tdata_i == tdata_q)
      `ASSUME(m_low_in_reset, rst_ni || !tvalid_i)
    end else begin : g_proved
      `PROVE(a_valid_holds, !(rst_ni && waits_q) || tvalid_i)
      `PROVE(a_data_holds, !(rst_ni && waits_q) || tdata_i == tdata_q)
      `PROVE(a_low_in_reset, rst_ni || !tvalid_i)
    end
  endgenerate

endmodule

`default_nettype wire
