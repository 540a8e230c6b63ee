// SPDX-License-Identifier: Apache-2.0
// An SRAM with a read and a write port and a memory self-test (MBIST): dtof_march_test in front of the macro dtof_macro_1r1w, whose ports are
// those of dtof_sram_1r1w in hdl/technology/behavioural.
//
// Side band and test as in dtof_sram_1rw of this folder. The test uses one port in each clock, so it does not find a fault that needs a read
// and a write in one clock.
// Latency: one clock, as without a test. Cost: dtof_march_test, and a multiplexer at each input of the macro.
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

  logic test, test_en, test_we, done, good;
  logic [ADDR_WIDTH-1:0] test_addr;
  logic [WIDTH-1:0] test_wdata;
  logic [CFG_WIDTH-1:0] macro_cfg;

  assign test = cfg_i[0];

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
      .rdata_i(rdata_o),
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
      .re_i   (test ? test_en && !test_we : re_i),
      .raddr_i(test ? test_addr : raddr_i),
      .rdata_o(rdata_o),
      .we_i   (test ? test_en && test_we : we_i),
      .waddr_i(test ? test_addr : waddr_i),
      .wdata_i(test ? test_wdata : wdata_i)
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
