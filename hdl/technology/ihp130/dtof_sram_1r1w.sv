// SPDX-License-Identifier: Apache-2.0
// Two-port memory of flip-flops, for a small array in a process without SRAM macros. It replaces the module in technology/behavioural and
// has the same contract: one read and one write port, one clock.
//
// Read:   rdata_o has the word one clock after re_i and holds it until the next read.
// Write:  wdata_i is stored at the clock edge that ends a clock with we_i.
// Read and write of one address in one clock: the word is written, the read data are undefined. They are the old word here.
// Side band: this memory does not use cfg_i and connects it to cfg_o, so that a simulation can check the whole path.
// Latency: one clock. Cost: (DEPTH + 1) x WIDTH flip-flops, a multiplexer of DEPTH words, a decoder.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_sram_1r1w #(
    parameter int DEPTH = 16,
    parameter int WIDTH = 8,
    parameter int CFG_WIDTH = 1,
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

  assign cfg_o = cfg_i;

  logic [WIDTH-1:0] memory[DEPTH];

  always_ff @(posedge clk_i) begin
    if (we_i) begin
      memory[waddr_i] <= wdata_i;
    end
  end

  always_ff @(posedge clk_i) begin
    if (re_i) begin
      rdata_o <= memory[raddr_i];
    end
  end

endmodule

`default_nettype wire
