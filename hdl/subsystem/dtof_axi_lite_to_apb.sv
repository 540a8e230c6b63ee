// SPDX-License-Identifier: Apache-2.0
// AXI4-Lite to APB4, one transfer at a time. If a read and a write are both pending, the kind that was not last goes first.
//
// 1. Address and data of a request are registered as they come, in any order: every ready comes from flip-flops, and no path leads
//    from one channel to another. In reset every ready is low, so that a master in another reset domain loses no request.
// 2. A read, or a write with both of its parts, starts on the APB when the transfer before has ended and its response will have room.
// 3. Two responses of each kind are stored until their ready. pslverr_i becomes the response SLVERR. The prot signals are not used.
//
// Schedule: clock 0 the last part of a request, clock 1 that part is registered, clocks 2 and 3 setup and access on the APB,
//   clock 4 the response. Latency: four clocks from the last part of a request to its response, plus wait states of the APB.
// Throughput: a read every two clocks plus wait states.
// Cost: address and data of a request and of a transfer, two responses of each kind, eleven state bits.
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

  // Requests: each part is held until the APB transfer starts.

  logic aw_held_q, w_held_q, ar_held_q, takes_write, takes_read;
  logic [ADDR_WIDTH-1:0] aw_address_q, ar_address_q;
  logic [31:0] w_data_q;
  logic [3:0] w_strobe_q;

  logic live_q;  // not in reset

  assign s_axi_awready_o = live_q && !aw_held_q;
  assign s_axi_wready_o = live_q && !w_held_q;
  assign s_axi_arready_o = live_q && !ar_held_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      live_q <= 1'b0;
      aw_held_q <= 1'b0;
      w_held_q <= 1'b0;
      ar_held_q <= 1'b0;
    end else begin
      live_q <= 1'b1;
      aw_held_q <= aw_held_q ? !takes_write : (live_q && s_axi_awvalid_i);
      w_held_q <= w_held_q ? !takes_write : (live_q && s_axi_wvalid_i);
      ar_held_q <= ar_held_q ? !takes_read : (live_q && s_axi_arvalid_i);
    end
  end

  always_ff @(posedge clk_i) begin
    if (!aw_held_q) begin
      aw_address_q <= s_axi_awaddr_i;
    end
    if (!w_held_q) begin
      w_data_q <= s_axi_wdata_i;
      w_strobe_q <= s_axi_wstrb_i;
    end
    if (!ar_held_q) begin
      ar_address_q <= s_axi_araddr_i;
    end
  end

  // APB transfer.

  logic select_q, enable_q, write_q;  // write_q: the last transfer was a write
  logic [ADDR_WIDTH-1:0] address_q;
  logic [31:0] data_q;
  logic [3:0] strobe_q;
  logic [1:0] writes_q, reads_q;  // stored responses
  logic free, can_write, can_read, ends;

  assign ends = select_q && enable_q && pready_i;
  assign free = !select_q || ends;
  assign can_write = aw_held_q && w_held_q && (writes_q == 2'd0 || (writes_q == 2'd1 && !(select_q && write_q)));
  assign can_read = ar_held_q && (reads_q == 2'd0 || (reads_q == 2'd1 && !(select_q && !write_q)));
  assign takes_write = free && can_write && (!write_q || !can_read);
  assign takes_read = free && can_read && (write_q || !can_write);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      select_q <= 1'b0;
      enable_q <= 1'b0;
      write_q <= 1'b0;
    end else if (free) begin
      select_q <= takes_write || takes_read;
      enable_q <= 1'b0;
      if (takes_write || takes_read) begin
        write_q <= takes_write;
      end
    end else begin
      enable_q <= 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (takes_write) begin
      address_q <= aw_address_q;
      data_q <= w_data_q;
      strobe_q <= w_strobe_q;
    end else if (takes_read) begin
      address_q <= ar_address_q;
      strobe_q <= '0;
    end
  end

  assign psel_o = select_q;
  assign penable_o = enable_q;
  assign pwrite_o = write_q;
  assign paddr_o = address_q;
  assign pwdata_o = data_q;
  assign pstrb_o = strobe_q;

  // Responses: one at the port, and one behind it.

  logic [32:0] read_q, read_behind_q;  // {error, data}
  logic write_error_q, write_error_behind_q;
  logic write_ends, read_ends, write_leaves, read_leaves;

  assign write_ends = ends && write_q;
  assign read_ends = ends && !write_q;
  assign write_leaves = s_axi_bvalid_o && s_axi_bready_i;
  assign read_leaves = s_axi_rvalid_o && s_axi_rready_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      writes_q <= '0;
      reads_q <= '0;
    end else begin
      writes_q <= writes_q + 2'(write_ends) - 2'(write_leaves);
      reads_q <= reads_q + 2'(read_ends) - 2'(read_leaves);
    end
  end

  always_ff @(posedge clk_i) begin
    if (writes_q == 2'd0 || write_leaves) begin
      write_error_q <= (writes_q == 2'd2) ? write_error_behind_q : pslverr_i;
    end
    if (writes_q != 2'd2) begin
      write_error_behind_q <= pslverr_i;
    end
    if (reads_q == 2'd0 || read_leaves) begin
      read_q <= (reads_q == 2'd2) ? read_behind_q : {pslverr_i, prdata_i};
    end
    if (reads_q != 2'd2) begin
      read_behind_q <= {pslverr_i, prdata_i};
    end
  end

  assign s_axi_bvalid_o = (writes_q != 2'd0);
  assign s_axi_bresp_o = write_error_q ? SLVERR : OKAY;
  assign s_axi_rvalid_o = (reads_q != 2'd0);
  assign s_axi_rdata_o = read_q[31:0];
  assign s_axi_rresp_o = read_q[32] ? SLVERR : OKAY;

endmodule

`default_nettype wire
