// SPDX-License-Identifier: Apache-2.0
// Stand-in for a two-port SRAM macro: one read and one write port, one clock. Replace it for silicon.
//
// Read:   rdata_o has the word one clock after re_i and holds it until the next read.
// Write:  wdata_i is stored at the clock edge that ends a clock with we_i.
// Read and write of one address in one clock: the word is written, the read data are undefined.
// Undefined data are X, so that a module that relies on them fails at once, and synthesis is free to infer a block RAM
// without extra logic. Verilator has no X: contents are random until written, and undefined read data are inverted.
// Side band: this memory does not use cfg_i and connects it to cfg_o, so that a simulation can check the whole path.
// Latency: one clock. Cost: DEPTH x WIDTH bits.

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
`ifdef VERILATOR
      rdata_o <= (we_i && (waddr_i == raddr_i)) ? ~memory[raddr_i] : memory[raddr_i];
`else
      rdata_o <= (we_i && (waddr_i == raddr_i)) ? {WIDTH{1'bx}} : memory[raddr_i];
`endif
    end
  end

`ifndef SYNTHESIS
  initial begin
`ifdef VERILATOR
    for (int address = 0; address < DEPTH; address = address + 1) begin
      for (int filled = 0; filled < WIDTH; filled = filled + 32) begin
        memory[address] = WIDTH'({memory[address], $urandom});
      end
    end
`endif
    if ($test$plusargs("sram_report") != 0) begin
      $display("%m: two-port SRAM, %0d words x %0d bits", DEPTH, WIDTH);
    end
  end
`endif

endmodule

`default_nettype wire
