// SPDX-License-Identifier: Apache-2.0
// Stand-in for a two-port SRAM macro: one read and one write port, one clock. Swap for silicon.
//
// Read:   rdata_o shows the word one clock after re_i and keeps it until the next read.
// Write:  wdata_i is stored at the clock edge that ends a clock with we_i.
// Read and write of one address in one clock: the word is written, the read data is undefined (shown
//         inverted here, so that a user that relies on it fails at once).
// Contents are random until written.
module sram_1r1w #(
    parameter int DEPTH = 16,
    parameter int WIDTH = 8,
    localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1
) (
    input  logic                  clk_i,
    input  logic                  re_i,
    input  logic [ADDR_WIDTH-1:0] raddr_i,
    output logic [     WIDTH-1:0] rdata_o,
    input  logic                  we_i,
    input  logic [ADDR_WIDTH-1:0] waddr_i,
    input  logic [     WIDTH-1:0] wdata_i
);

  logic [WIDTH-1:0] memory[DEPTH];

`ifndef SYNTHESIS
  integer address;
  initial begin
    for (address = 0; address < DEPTH; address = address + 1) begin
      memory[address] = WIDTH'($urandom);
    end
    if ($test$plusargs("sram_report") != 0) begin
      $display("%m: two-port SRAM, %0d words x %0d bits", DEPTH, WIDTH);
    end
  end
`endif

  always_ff @(posedge clk_i) begin
    if (we_i) begin
      memory[waddr_i] <= wdata_i;
    end
    if (re_i) begin
      rdata_o <= (we_i && (waddr_i == raddr_i)) ? ~memory[raddr_i] : memory[raddr_i];
    end
  end

endmodule
