// SPDX-License-Identifier: Apache-2.0
// Technology module for a compiled single-port SRAM with active-low controls and no byte write enable.
//
// One branch per macro: copy a branch for every size in use. A size without a macro stops elaboration, so that no
// memory becomes flip-flops by accident. The polarity of the controls is the only logic. If a compiler's data
// input must be held, or its write needs a mask, adapt this module only.
// Latency: one clock. Cost: one macro.
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

  assign cfg_o = cfg_i;  // this compiler's macros have no side band

  generate
    if (DEPTH == 160 && WIDTH == 14) begin : g_160x14
      sp_ram_160x14 u_macro (
          .CLK(clk_i),
          .CEN(!en_i),
          .WEN(!we_i),
          .A  (addr_i),
          .D  (wdata_i),
          .Q  (rdata_o)
      );
    end else begin : g_no_macro
      // An unknown module stops every tool; the message has the size in the instance's path.
      sram_size_without_macro #(
          .DEPTH(DEPTH),
          .WIDTH(WIDTH)
      ) u_no_macro ();
    end
  endgenerate

endmodule
