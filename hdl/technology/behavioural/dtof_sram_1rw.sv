// SPDX-License-Identifier: Apache-2.0
// Stand-in for a single-port SRAM macro: one port that reads or writes, one clock. Replace it for silicon.
//
// Read:   with en_i and not we_i, rdata_o has the word one clock later and holds it until the next access.
// Write:  with en_i and we_i, the parts of wdata_i with wparts_i are stored at the clock edge; rdata_o is undefined afterwards. A part
//         without wparts_i has the data that are stored already. So a macro with a write mask saves power, and one without may write all.
// Undefined data are X, so that a module that relies on them fails at once, and synthesis is free to infer a block RAM
// without extra logic. Verilator has no X: contents are random until written, and undefined read data are the inverted write data.
// Side band: this memory does not use cfg_i and connects it to cfg_o, so that a simulation can check the whole path.
// Latency: one clock. Cost: DEPTH x WIDTH bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_sram_1rw #(
    parameter int DEPTH = 16,
    parameter int WIDTH = 8,
    parameter int PARTS = 1,  // parts of a word, of equal width, which a write may leave as they are
    parameter int CFG_WIDTH = 1,
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

  assign cfg_o = cfg_i;

  logic [WIDTH-1:0] memory[DEPTH];

  localparam int PART_WIDTH = WIDTH / PARTS;

  genvar p;
  generate
    for (p = 0; p < PARTS; p = p + 1) begin : g_part
      always_ff @(posedge clk_i) begin
        if (en_i && we_i && wparts_i[p]) begin
          memory[addr_i][p*PART_WIDTH+:PART_WIDTH] <= wdata_i[p*PART_WIDTH+:PART_WIDTH];
        end
      end
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    if (en_i) begin
`ifdef VERILATOR
      rdata_o <= we_i ? ~wdata_i : memory[addr_i];
`else
      rdata_o <= we_i ? {WIDTH{1'bx}} : memory[addr_i];
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
      $display("%m: single-port SRAM, %0d words x %0d bits", DEPTH, WIDTH);
    end
  end
`endif

endmodule

`default_nettype wire
