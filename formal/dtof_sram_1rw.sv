// SPDX-License-Identifier: Apache-2.0
// Single-port SRAM for proofs: contents are arbitrary until written; read data are arbitrary after a write.

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

  logic [WIDTH-1:0] memory[DEPTH];
  logic [WIDTH-1:0] anything;

  arbitrary_value #(.WIDTH(WIDTH)) u_anything (.value_o(anything));

  always_ff @(posedge clk_i) begin
    if (en_i) begin
      if (we_i) begin
        memory[addr_i] <= wdata_i;
        rdata_o <= anything;
      end else begin
        rdata_o <= memory[addr_i];
      end
    end
  end

endmodule

`default_nettype wire
