// SPDX-License-Identifier: Apache-2.0
// Requests of a processor as APB4 transfers, one at a time.
//
// A request is taken when req_valid_i and req_ready_o are high. rsp_valid_o is high for one clock, the last one of the transfer, with
// the data of a read and the slave's error.
// Schedule: a transfer takes two clocks and the clocks in which the slave waits; the next request is taken behind them.
// Cost: the request's registers, two state bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module soc_apb_master (
    input  logic        clk_i,
    input  logic        rst_ni,
    input  logic        req_valid_i,
    output logic        req_ready_o,
    input  logic        req_write_i,
    input  logic [31:0] req_addr_i,
    input  logic [31:0] req_wdata_i,
    input  logic [ 3:0] req_strb_i,
    output logic        rsp_valid_o,
    output logic [31:0] rsp_rdata_o,
    output logic        rsp_error_o,
    output logic        psel_o,
    output logic        penable_o,
    output logic        pwrite_o,
    output logic [31:0] paddr_o,
    output logic [31:0] pwdata_o,
    output logic [ 3:0] pstrb_o,
    input  logic        pready_i,
    input  logic [31:0] prdata_i,
    input  logic        pslverr_i
);

  logic select_q, enable_q, write_q;
  logic [31:0] addr_q, wdata_q;
  logic [3:0] strb_q;

  assign req_ready_o = !select_q;
  assign rsp_valid_o = enable_q && pready_i;
  assign rsp_rdata_o = prdata_i;
  assign rsp_error_o = pslverr_i;
  assign psel_o = select_q;
  assign penable_o = enable_q;
  assign pwrite_o = write_q;
  assign paddr_o = addr_q;
  assign pwdata_o = wdata_q;
  assign pstrb_o = strb_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      select_q <= 1'b0;
      enable_q <= 1'b0;
    end else if (!select_q) begin
      select_q <= req_valid_i;
    end else if (!enable_q) begin
      enable_q <= 1'b1;
    end else if (pready_i) begin
      select_q <= 1'b0;
      enable_q <= 1'b0;
    end
  end

  always_ff @(posedge clk_i) begin
    if (req_valid_i && req_ready_o) begin
      write_q <= req_write_i;
      addr_q <= req_addr_i;
      wdata_q <= req_wdata_i;
      strb_q <= req_write_i ? req_strb_i : '0;
    end
  end

endmodule

`default_nettype wire
