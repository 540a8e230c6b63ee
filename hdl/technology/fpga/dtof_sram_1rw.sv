// SPDX-License-Identifier: Apache-2.0
// Single-port memory for FPGAs: one port that reads or writes, one clock, in block RAM. It replaces the module in technology/behavioural
// and has the same contract.
//
// Read:   with en_i and not we_i, rdata_o has the word one clock later and holds it until the next access.
// Write:  with en_i and we_i, wdata_i is stored at the clock edge; rdata_o is undefined afterwards. It is X here, so that a
// tool needs no extra logic, whatever its block RAM returns.
// Side band: this memory does not use cfg_i and connects it to cfg_o, so that a simulation can check the whole path.
// Latency: one clock. Cost: DEPTH x WIDTH bits of block RAM.

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

  // All parts are written: those without wparts_i have the data that are stored.
  logic unused_parts;
  assign unused_parts = ^wparts_i;

  (* ram_style = "block" *) logic [WIDTH-1:0] memory[DEPTH];

  always_ff @(posedge clk_i) begin
    if (en_i && we_i) begin
      memory[addr_i] <= wdata_i;
    end
  end

  always_ff @(posedge clk_i) begin
    if (en_i) begin
      rdata_o <= we_i ? {WIDTH{1'bx}} : memory[addr_i];
    end
  end

endmodule

`default_nettype wire
