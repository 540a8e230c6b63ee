// SPDX-License-Identifier: Apache-2.0
// The rules of APB4 for the side of a port that the design is: the requester drives psel_i to pstrb_i, the completer pready_i and
// pslverr_i. The other side may do anything. dtof_apb_protocol of hdl/assertions has the rules of both sides for simulators.
// Source: AMBA APB Protocol Specification (IHI 0024), sections 3 and 4.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module apb_rules #(
    parameter int ADDR_WIDTH = 12,
    parameter int REQUESTER = 0,  // 1: the design is the requester, 0: the completer
    parameter int MOST_WAITS = 0  // limit of the completer's wait states in a transfer, at most 14
) (
    input logic                  clk_i,
    input logic                  rst_ni,
    input logic                  checking,
    input logic                  psel_i,
    input logic                  penable_i,
    input logic                  pwrite_i,
    input logic [ADDR_WIDTH-1:0] paddr_i,
    input logic [          31:0] pwdata_i,
    input logic [           3:0] pstrb_i,
    input logic                  pready_i,
    input logic                  pslverr_i
);

  logic access, ends;
  assign access = psel_i && penable_i;
  assign ends = access && pready_i;

  generate
    if (REQUESTER != 0) begin : g_requester
      localparam int WIDTH = ADDR_WIDTH + 37;
      logic under_way_q;  // the transfer of the last clock has not ended
      logic [WIDTH-1:0] request, request_q;
      assign request = {pwrite_i, paddr_i, pwdata_i, pstrb_i};
      always_ff @(posedge clk_i) begin
        under_way_q <= rst_ni && psel_i && !ends;
        request_q <= request;
      end
      `PROVE(a_access_follows_setup, !rst_ni || penable_i == (psel_i && under_way_q))
      `PROVE(a_request_stays, !(rst_ni && under_way_q) || (psel_i && request == request_q))
      `PROVE(a_read_without_strobes, !(rst_ni && psel_i && !pwrite_i) || pstrb_i == '0)
      `PROVE(a_idle_in_reset, rst_ni || !psel_i)
      logic unused;
      assign unused = pslverr_i;
    end else begin : g_completer
      logic [3:0] waits_q;
      always_ff @(posedge clk_i) begin
        waits_q <= (rst_ni && access && !pready_i) ? waits_q + 1'b1 : '0;
      end
      `PROVE(a_answer, !(rst_ni && access && !pready_i) || 32'(waits_q) < MOST_WAITS)
      `PROVE(a_error_with_answer, !(rst_ni && pslverr_i) || ends)
      logic unused;
      assign unused = ^{pwrite_i, paddr_i, pwdata_i, pstrb_i};
    end
  endgenerate

endmodule

`default_nettype wire
