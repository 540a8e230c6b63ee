// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_axi_lite_to_apb: every read and every write is on the APB once, in order, with its address and data; its response comes
// back once, in order, with the APB's answer; APB and responses follow their protocols, and both reads and writes make progress. In reset
// no request is taken. The harness watches one arbitrary read and one arbitrary write of every eight, and one arbitrary bit of the data.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module axi_lite_to_apb_properties #(
    parameter int ADDR_WIDTH = 2
) (
    input logic                  clk_i,
    input logic                  reset_i,
    input logic                  awvalid_i,
    input logic [ADDR_WIDTH-1:0] awaddr_i,
    input logic                  wvalid_i,
    input logic [          31:0] wdata_i,
    input logic [           3:0] wstrb_i,
    input logic                  bready_i,
    input logic                  arvalid_i,
    input logic [ADDR_WIDTH-1:0] araddr_i,
    input logic                  rready_i,
    input logic                  pready_i,
    input logic [          31:0] prdata_i,
    input logic                  pslverr_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic awready, wready, bvalid, arready, rvalid, psel, penable, pwrite;
  logic [1:0] bresp, rresp;
  logic [31:0] rdata, pwdata;
  logic [ADDR_WIDTH-1:0] paddr;
  logic [3:0] pstrb;

  dtof_axi_lite_to_apb #(
      .ADDR_WIDTH(ADDR_WIDTH)
  ) u_dut (
      .clk_i          (clk_i),
      .rst_ni         (rst_n),
      .s_axi_awvalid_i(awvalid_i),
      .s_axi_awready_o(awready),
      .s_axi_awaddr_i (awaddr_i),
      .s_axi_wvalid_i (wvalid_i),
      .s_axi_wready_o (wready),
      .s_axi_wdata_i  (wdata_i),
      .s_axi_wstrb_i  (wstrb_i),
      .s_axi_bvalid_o (bvalid),
      .s_axi_bready_i (bready_i),
      .s_axi_bresp_o  (bresp),
      .s_axi_arvalid_i(arvalid_i),
      .s_axi_arready_o(arready),
      .s_axi_araddr_i (araddr_i),
      .s_axi_rvalid_o (rvalid),
      .s_axi_rready_i (rready_i),
      .s_axi_rdata_o  (rdata),
      .s_axi_rresp_o  (rresp),
      .psel_o         (psel),
      .penable_o      (penable),
      .pwrite_o       (pwrite),
      .paddr_o        (paddr),
      .pwdata_o       (pwdata),
      .pstrb_o        (pstrb),
      .pready_i       (pready_i),
      .prdata_i       (prdata_i),
      .pslverr_i      (pslverr_i)
  );

  // Counters of transfers, per channel and on the APB, modulo 8; at most three of a kind are in progress.
  (* anyconst *) logic [2:0] watched;
  (* anyconst *) logic [4:0] watched_bit;
  logic [2:0] aw_q, w_q, ar_q, apb_writes_q, apb_reads_q, b_q, r_q;
  logic [ADDR_WIDTH-1:0] aw_address_q, ar_address_q;
  logic [3:0] strobe_q;
  logic write_bit_q, read_bit_q, write_error_q, read_error_q;
  logic ends;
  logic responds_q;        // a response was taken in the last clock
  logic [3:0] stream_q;    // clocks with reads only, without a pause of master or APB
  logic [3:0] read_wait_q, write_wait_q;  // clocks in which only this module delays a read, or a write

  assign ends = psel && penable && pready_i;

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      {aw_q, w_q, ar_q, apb_writes_q, apb_reads_q, b_q, r_q} <= '0;
      read_wait_q <= '0;
      write_wait_q <= '0;
      responds_q <= 1'b0;
      stream_q <= '0;
    end else begin
      responds_q <= rvalid;
      stream_q <= !(arvalid_i && rready_i && pready_i) || awvalid_i || wvalid_i || aw_q != b_q || w_q != b_q ? '0
          : (stream_q == 4'd8) ? stream_q : stream_q + 1'b1;
      if (awvalid_i && awready) begin
        aw_q <= aw_q + 1'b1;
        if (aw_q == watched) aw_address_q <= awaddr_i;
      end
      if (wvalid_i && wready) begin
        w_q <= w_q + 1'b1;
        if (w_q == watched) {strobe_q, write_bit_q} <= {wstrb_i, wdata_i[watched_bit]};
      end
      if (arvalid_i && arready) begin
        ar_q <= ar_q + 1'b1;
        if (ar_q == watched) ar_address_q <= araddr_i;
      end
      if (ends && pwrite) begin
        apb_writes_q <= apb_writes_q + 1'b1;
        if (apb_writes_q == watched) write_error_q <= pslverr_i;
      end
      if (ends && !pwrite) begin
        apb_reads_q <= apb_reads_q + 1'b1;
        if (apb_reads_q == watched) {read_error_q, read_bit_q} <= {pslverr_i, prdata_i[watched_bit]};
      end
      if (bvalid && bready_i) b_q <= b_q + 1'b1;
      if (rvalid && rready_i) r_q <= r_q + 1'b1;
      read_wait_q <= (ar_q != r_q && pready_i && rready_i && bready_i && !(rvalid && rready_i)) ? read_wait_q + 1'b1 : '0;
      write_wait_q <= (aw_q != b_q && w_q != b_q && pready_i && rready_i && bready_i && !(bvalid && bready_i))
          ? write_wait_q + 1'b1 : '0;
    end
  end

  logic [2:0] reads, writes;
  assign reads = ar_q - r_q;
  assign writes = apb_writes_q - b_q;

  axi_lite_rules #(
      .MOST_OPEN(4)
  ) u_axi_lite_rules (
      .clk_i    (clk_i),
      .rst_ni   (rst_n),
      .checking (checking),
      .awvalid_i(awvalid_i),
      .awready_i(awready),
      .wvalid_i (wvalid_i),
      .wready_i (wready),
      .bvalid_i (bvalid),
      .bready_i (bready_i),
      .bresp_i  (bresp),
      .arvalid_i(arvalid_i),
      .arready_i(arready),
      .rvalid_i (rvalid),
      .rready_i (rready_i),
      .rdata_i  (rdata),
      .rresp_i  (rresp)
  );

  apb_rules #(
      .ADDR_WIDTH(ADDR_WIDTH),
      .REQUESTER (1)
  ) u_apb_rules (
      .clk_i    (clk_i),
      .rst_ni   (rst_n),
      .checking (checking),
      .psel_i   (psel),
      .penable_i(penable),
      .pwrite_i (pwrite),
      .paddr_i  (paddr),
      .pwdata_i (pwdata),
      .pstrb_i  (pstrb),
      .pready_i (pready_i),
      .pslverr_i(pslverr_i)
  );

  `PROVE(a_not_ready_in_reset, rst_n || (!awready && !wready && !arready))
  // APB
  `PROVE(a_read, !(rst_n && psel && !pwrite) || (apb_reads_q != ar_q && (apb_reads_q != watched || (paddr == ar_address_q && pstrb == '0))))
  `PROVE(a_write, !(rst_n && psel && pwrite) || (apb_writes_q != aw_q && apb_writes_q != w_q
         && (apb_writes_q != watched || (paddr == aw_address_q && pstrb == strobe_q && pwdata[watched_bit] == write_bit_q))))
  // Responses
  `PROVE(a_read_response, !(rst_n && rvalid) || (r_q != apb_reads_q
         && (r_q != watched || (rdata[watched_bit] == read_bit_q && rresp == {read_error_q, 1'b0}))))
  `PROVE(a_write_response, !(rst_n && bvalid) || (b_q != apb_writes_q && (b_q != watched || bresp == {write_error_q, 1'b0})))
  `PROVE(a_few, !rst_n || (reads <= 3'd3 && writes <= 3'd2))
  // A request is delayed by its own transfer of two clocks and at most one transfer of the other kind.
  `PROVE(a_reads_go_on, !rst_n || read_wait_q <= 4'd7)
  `PROVE(a_writes_go_on, !rst_n || write_wait_q <= 4'd7)
  `PROVE(a_a_read_every_two_clocks, !(rst_n && stream_q == 4'd8) || rvalid || responds_q)
  `GOAL(rst_n && rvalid && r_q == 3'd2 && reads == 3'd3)

endmodule

`default_nettype wire
