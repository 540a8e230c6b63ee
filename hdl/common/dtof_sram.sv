// SPDX-License-Identifier: Apache-2.0
// The SRAM of all read-outs: DEPTH words of WIDTH bits behind PORTS ports.
//
// Contract: read data are valid one clock after read_en_i; a write is visible to reads in later clocks.
// PORTS = 2: a read of an address in the clock in which it is written returns undefined data.
// PORTS = 1: a read and a write in one clock are illegal, and read data are undefined after a write.
// PARTS > 1 (PORTS = 1 only): a word has PARTS parts of equal width. A part without write_parts_i must have the data that are stored, so that
// a macro with a write mask need not write the part.
// The technology folder has the macros; no other file changes for silicon.
// +sram_report prints size and organisation at the start of a simulation.
// Latency: one clock. Cost: one SRAM macro.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_sram #(
    parameter int PORTS = 2,   // 1: one port that reads or writes, 2: one read and one write port
    parameter int DEPTH = 160,  // words
    parameter int WIDTH = 10,   // bits of a word
    parameter int PARTS = 1,   // parts of a word
    localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] cfg_i,  // side band of the macro
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] cfg_o,
    input  logic                  read_en_i,
    input  logic [ADDR_WIDTH-1:0] read_addr_i,
    output logic [     WIDTH-1:0] read_data_o,
    input  logic                  write_en_i,
    input  logic [ADDR_WIDTH-1:0] write_addr_i,
    input  logic [     PARTS-1:0] write_parts_i,  // with write_en_i: parts that may differ from what is stored
    input  logic [     WIDTH-1:0] write_data_i
);

  `DTOF_REQUIRE(g_illegal_ports, PORTS == 1 || PORTS == 2, "dtof_sram: PORTS must be 1 or 2")
  `DTOF_REQUIRE(g_illegal_depth, DEPTH >= 1, "dtof_sram: DEPTH must be at least 1")
  `DTOF_REQUIRE(g_illegal_width, WIDTH >= 1, "dtof_sram: WIDTH must be at least 1")

  `DTOF_REQUIRE(g_illegal_parts, PARTS >= 1 && WIDTH % PARTS == 0 && (PARTS == 1 || PORTS == 1),
                "dtof_sram: PARTS must divide WIDTH, and be 1 with two ports")

  generate
    if (PORTS == 2) begin : g_two_ports
      logic unused_parts;
      assign unused_parts = ^write_parts_i;
      dtof_sram_1r1w #(
          .DEPTH    (DEPTH),
          .WIDTH    (WIDTH),
          .CFG_WIDTH(dtof_pkg::SRAM_CFG_WIDTH)
      ) u_macro (
          .clk_i  (clk_i),
          .cfg_i  (cfg_i),
          .cfg_o  (cfg_o),
          .re_i   (read_en_i),
          .raddr_i(read_addr_i),
          .rdata_o(read_data_o),
          .we_i   (write_en_i),
          .waddr_i(write_addr_i),
          .wdata_i(write_data_i)
      );
    end else begin : g_one_port
      dtof_sram_1rw #(
          .DEPTH    (DEPTH),
          .WIDTH    (WIDTH),
          .PARTS    (PARTS),
          .CFG_WIDTH(dtof_pkg::SRAM_CFG_WIDTH)
      ) u_macro (
          .clk_i  (clk_i),
          .cfg_i  (cfg_i),
          .cfg_o  (cfg_o),
          .en_i   (read_en_i || write_en_i),
          .we_i   (write_en_i),
          .addr_i (write_en_i ? write_addr_i : read_addr_i),
          .wparts_i(write_parts_i),
          .wdata_i(write_data_i),
          .rdata_o(read_data_o)
      );
      `DTOF_ASSERT(a_one_access, !(read_en_i && write_en_i), "single-port SRAM read and written in one clock")
    end
  endgenerate

  // The comparison has 32 bits, so that it also holds for a depth that fills the address range.
  `DTOF_ASSERT(a_read_in_range, !read_en_i || (32'(read_addr_i) < DEPTH), "SRAM read beyond its depth")
  `DTOF_ASSERT(a_some_part, !write_en_i || write_parts_i != '0, "SRAM write of no part")
  `DTOF_ASSERT(a_write_in_range, !write_en_i || (32'(write_addr_i) < DEPTH), "SRAM write beyond its depth")

endmodule

`default_nettype wire
