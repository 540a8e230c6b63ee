// SPDX-License-Identifier: Apache-2.0
// The rules of an AXI4-Lite subordinate: each response follows its request, in a later clock, and stays until its ready; no response is
// EXOKAY. The manager may do anything.
// Source: AMBA AXI Protocol Specification (IHI 0022), sections A3.2, A3.3 and B1.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module axi_lite_rules #(
    parameter int MOST_OPEN = 7  // limit of the requests of a kind without a response, at most 7
) (
    input logic        clk_i,
    input logic        rst_ni,
    input logic        checking,
    input logic        awvalid_i,
    input logic        awready_i,
    input logic        wvalid_i,
    input logic        wready_i,
    input logic        bvalid_i,
    input logic        bready_i,
    input logic [ 1:0] bresp_i,
    input logic        arvalid_i,
    input logic        arready_i,
    input logic        rvalid_i,
    input logic        rready_i,
    input logic [31:0] rdata_i,
    input logic [ 1:0] rresp_i
);

  localparam logic [1:0] EXOKAY = 2'b01;

  axi_stream_rules #(
      .WIDTH(2)
  ) u_b (
      .clk_i   (clk_i),
      .rst_ni  (rst_ni),
      .checking(checking),
      .tvalid_i(bvalid_i),
      .tready_i(bready_i),
      .tdata_i (bresp_i)
  );

  axi_stream_rules #(
      .WIDTH(34)
  ) u_r (
      .clk_i   (clk_i),
      .rst_ni  (rst_ni),
      .checking(checking),
      .tvalid_i(rvalid_i),
      .tready_i(rready_i),
      .tdata_i ({rresp_i, rdata_i})
  );

  // Requests and parts of requests without a response.
  logic [2:0] addresses_q, data_q, reads_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      {addresses_q, data_q, reads_q} <= '0;
    end else begin
      addresses_q <= addresses_q + 3'(awvalid_i && awready_i) - 3'(bvalid_i && bready_i);
      data_q <= data_q + 3'(wvalid_i && wready_i) - 3'(bvalid_i && bready_i);
      reads_q <= reads_q + 3'(arvalid_i && arready_i) - 3'(rvalid_i && rready_i);
    end
  end

  `PROVE(a_write_response_follows, !(rst_ni && bvalid_i) || (addresses_q != '0 && data_q != '0))
  `PROVE(a_read_response_follows, !(rst_ni && rvalid_i) || reads_q != '0)
  `PROVE(a_few_open, !rst_ni || (32'(addresses_q) <= MOST_OPEN && 32'(data_q) <= MOST_OPEN && 32'(reads_q) <= MOST_OPEN))
  `PROVE(a_write_response, !(rst_ni && bvalid_i) || bresp_i != EXOKAY)
  `PROVE(a_read_response, !(rst_ni && rvalid_i) || rresp_i != EXOKAY)

endmodule

`default_nettype wire
