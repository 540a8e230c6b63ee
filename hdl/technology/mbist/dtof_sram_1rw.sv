// SPDX-License-Identifier: Apache-2.0
// A single-port SRAM with a memory self-test (MBIST) and a scan bypass: dtof_march_test and dtof_scan_bypass around the macro dtof_macro_1rw,
// whose ports are those of dtof_sram_1rw in hdl/technology/behavioural.
//
// Side band: cfg_i[0] high runs the test, which the array's clock must reach (scan_mode_i high). cfg_o[0]: the test has ended. cfg_o[1]: no
// word was wrong. The tops AND the cfg_o of all memories, so both bits high mean that all memories are good. Higher bits are the macro's.
// The test overwrites the memory. cfg_i[1] high, with cfg_i[0] low, is for scan: the macro rests and keeps its words, and the read data come
// from dtof_scan_bypass. While both bits are low, the macro is connected as without a test.
// Latency: one clock, as without a test. Cost: dtof_march_test, dtof_scan_bypass, and a multiplexer at each input of the macro.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_sram_1rw #(
    parameter int DEPTH = 16,
    parameter int WIDTH = 8,
    parameter int PARTS = 1,  // parts of a word, of equal width, which a write may leave as they are
    parameter int CFG_WIDTH = 2,
    localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1
) (
    input  logic                  clk_i,
    input  logic [ CFG_WIDTH-1:0] cfg_i,
    output logic [ CFG_WIDTH-1:0] cfg_o,
    input  logic                  en_i,
    input  logic                  we_i,
    input  logic [ADDR_WIDTH-1:0] addr_i,
    input  logic [     PARTS-1:0] wparts_i,  // with we_i: parts that may differ from what is stored
    input  logic [     WIDTH-1:0] wdata_i,
    output logic [     WIDTH-1:0] rdata_o
);

  `DTOF_REQUIRE(g_illegal_cfg, CFG_WIDTH >= 2, "dtof_sram_1rw with a self-test: DTOF_SRAM_CFG_WIDTH must be at least 2")

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

  dtof_macro_1rw #(
      .DEPTH    (DEPTH),
      .WIDTH    (WIDTH),
      .PARTS    (PARTS),
      .CFG_WIDTH(CFG_WIDTH)
  ) u_macro (
      .clk_i  (clk_i),
      .cfg_i  (cfg_i),
      .cfg_o  (macro_cfg),
      .en_i   (test ? test_en : en_i && !scan),
      .we_i   (test ? test_we : we_i),
      .addr_i (test ? test_addr : addr_i),
      .wparts_i(wparts_i | {PARTS{test}}),
      .wdata_i(test ? test_wdata : wdata_i),
      .rdata_o(macro_rdata)
  );

  dtof_scan_bypass #(
      .INPUTS(2 + ADDR_WIDTH + PARTS + WIDTH),
      .WIDTH (WIDTH)
  ) u_scan_bypass (
      .clk_i        (clk_i),
      .scan_i       (scan),
      .inputs_i     ({en_i, we_i, addr_i, wparts_i, wdata_i}),
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
