// SPDX-License-Identifier: Apache-2.0
// An SRAM with a read and a write port, a memory self-test (MBIST) and a scan bypass: dtof_march_test and dtof_scan_bypass around the macro
// dtof_macro_1r1w, whose ports are those of dtof_sram_1r1w in hdl/technology/behavioural.
//
// Side band, test and scan as in dtof_sram_1rw of this folder. The test uses one port in each clock, so it does not find a fault that needs a read
// and a write in one clock.
// Latency: one clock, as without a test. Cost: dtof_march_test, dtof_scan_bypass, and a multiplexer at each input of the macro.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_sram_1r1w #(
    parameter int DEPTH = 16,
    parameter int WIDTH = 8,
    parameter int CFG_WIDTH = 2,
    localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1
) (
    input  logic                  clk_i,
    input  logic [ CFG_WIDTH-1:0] cfg_i,
    output logic [ CFG_WIDTH-1:0] cfg_o,
    input  logic                  re_i,
    input  logic [ADDR_WIDTH-1:0] raddr_i,
    output logic [     WIDTH-1:0] rdata_o,
    input  logic                  we_i,
    input  logic [ADDR_WIDTH-1:0] waddr_i,
    input  logic [     WIDTH-1:0] wdata_i
);

  `DTOF_REQUIRE(g_illegal_cfg, CFG_WIDTH >= 2, "dtof_sram_1r1w with a self-test: DTOF_SRAM_CFG_WIDTH must be at least 2")

  logic test, scan, test_en, test_we, done, good;
  logic [ADDR_WIDTH-1:0] test_addr;
  logic [WIDTH-1:0] test_wdata, macro_rdata;
  logic [CFG_WIDTH-1:0] macro_cfg;

  assign test = cfg_i[0];
  assign scan = cfg_i[1] && !test;

  dtof_march_test #(
      .DEPTH(DEPTH),
      .WIDTH(WIDTH)
  ) u_march_test (
      .clk_i  (clk_i),
      .run_i  (test),
      .en_o   (test_en),
      .we_o   (test_we),
      .addr_o (test_addr),
      .wdata_o(test_wdata),
      .rdata_i(macro_rdata),
      .done_o (done),
      .good_o (good)
  );

  dtof_macro_1r1w #(
      .DEPTH    (DEPTH),
      .WIDTH    (WIDTH),
      .CFG_WIDTH(CFG_WIDTH)
  ) u_macro (
      .clk_i  (clk_i),
      .cfg_i  (cfg_i),
      .cfg_o  (macro_cfg),
      .re_i   (test ? test_en && !test_we : re_i && !scan),
      .raddr_i(test ? test_addr : raddr_i),
      .rdata_o(macro_rdata),
      .we_i   (test ? test_en && test_we : we_i && !scan),
      .waddr_i(test ? test_addr : waddr_i),
      .wdata_i(test ? test_wdata : wdata_i)
  );

  dtof_scan_bypass #(
      .INPUTS(2 + 2 * ADDR_WIDTH + WIDTH),
      .WIDTH (WIDTH)
  ) u_scan_bypass (
      .clk_i        (clk_i),
      .scan_i       (scan),
      .inputs_i     ({re_i, we_i, raddr_i, waddr_i, wdata_i}),
      .macro_rdata_i(macro_rdata),
      .rdata_o      (rdata_o)
  );

  assign cfg_o[1:0] = {good, done};

  generate
    if (CFG_WIDTH > 2) begin : g_more
      assign cfg_o[CFG_WIDTH-1:2] = macro_cfg[CFG_WIDTH-1:2];
    end
  endgenerate

  logic unused_cfg;
  assign unused_cfg = ^macro_cfg[1:0];

endmodule

`default_nettype wire
