// SPDX-License-Identifier: Apache-2.0
// AXI4-Lite to APB4, one transfer at a time; of a read and a write that wait both, the kind that was not last goes first.
//
// A write needs its address and its data, which may come in any order. pslverr_i becomes the response SLVERR. prot is not
// looked at.
// Latency: from the last of a request's parts to its response, three clocks and the APB's wait states.
// Cost: address, data and response of a transfer, five state bits.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_axi_lite_to_apb #(
    parameter int ADDR_WIDTH = 12
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    // AXI4-Lite
    input  logic                  s_axi_awvalid_i,
    output logic                  s_axi_awready_o,
    input  logic [ADDR_WIDTH-1:0] s_axi_awaddr_i,
    input  logic                  s_axi_wvalid_i,
    output logic                  s_axi_wready_o,
    input  logic [          31:0] s_axi_wdata_i,
    input  logic [           3:0] s_axi_wstrb_i,
    output logic                  s_axi_bvalid_o,
    input  logic                  s_axi_bready_i,
    output logic [           1:0] s_axi_bresp_o,
    input  logic                  s_axi_arvalid_i,
    output logic                  s_axi_arready_o,
    input  logic [ADDR_WIDTH-1:0] s_axi_araddr_i,
    output logic                  s_axi_rvalid_o,
    input  logic                  s_axi_rready_i,
    output logic [          31:0] s_axi_rdata_o,
    output logic [           1:0] s_axi_rresp_o,
    // APB4
    output logic                  psel_o,
    output logic                  penable_o,
    output logic                  pwrite_o,
    output logic [ADDR_WIDTH-1:0] paddr_o,
    output logic [          31:0] pwdata_o,
    output logic [           3:0] pstrb_o,
    input  logic                  pready_i,
    input  logic [          31:0] prdata_i,
    input  logic                  pslverr_i
);

  localparam logic [1:0] OKAY = 2'b00;
  localparam logic [1:0] SLVERR = 2'b10;

  logic select_q, enable_q, write_q, bvalid_q, rvalid_q, error_q;
  logic [ADDR_WIDTH-1:0] address_q;
  logic [31:0] data_q;
  logic [3:0] strobe_q;
  logic free, can_write, can_read, takes_write, takes_read, ends;

  assign free = !select_q && !bvalid_q && !rvalid_q;
  assign can_write = s_axi_awvalid_i && s_axi_wvalid_i;
  assign can_read = s_axi_arvalid_i;
  // write_q is the kind of the last transfer.
  assign takes_write = free && can_write && (!write_q || !can_read);
  assign takes_read = free && can_read && (write_q || !can_write);
  assign ends = select_q && enable_q && pready_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      select_q <= 1'b0;
      enable_q <= 1'b0;
      write_q <= 1'b0;
      bvalid_q <= 1'b0;
      rvalid_q <= 1'b0;
    end else begin
      if (takes_write || takes_read) begin
        select_q <= 1'b1;
        enable_q <= 1'b0;
        write_q <= takes_write;
      end else if (ends) begin
        select_q <= 1'b0;
        enable_q <= 1'b0;
      end else if (select_q) begin
        enable_q <= 1'b1;
      end
      bvalid_q <= (ends && write_q) || (bvalid_q && !s_axi_bready_i);
      rvalid_q <= (ends && !write_q) || (rvalid_q && !s_axi_rready_i);
    end
  end

  always_ff @(posedge clk_i) begin
    if (takes_write) begin
      address_q <= s_axi_awaddr_i;
      data_q <= s_axi_wdata_i;
      strobe_q <= s_axi_wstrb_i;
    end else if (takes_read) begin
      address_q <= s_axi_araddr_i;
      strobe_q <= '0;
    end else if (ends) begin
      data_q <= prdata_i;
      error_q <= pslverr_i;
    end
  end

  assign s_axi_awready_o = takes_write;
  assign s_axi_wready_o = takes_write;
  assign s_axi_arready_o = takes_read;
  assign s_axi_bvalid_o = bvalid_q;
  assign s_axi_bresp_o = error_q ? SLVERR : OKAY;
  assign s_axi_rvalid_o = rvalid_q;
  assign s_axi_rdata_o = data_q;
  assign s_axi_rresp_o = error_q ? SLVERR : OKAY;
  assign psel_o = select_q;
  assign penable_o = enable_q;
  assign pwrite_o = write_q;
  assign paddr_o = address_q;
  assign pwdata_o = data_q;
  assign pstrb_o = strobe_q;

endmodule

`default_nettype wire
