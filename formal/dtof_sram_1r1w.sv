// SPDX-License-Identifier: Apache-2.0
// Two-port SRAM for proofs: contents are arbitrary until written; a read of an address in the clock in which it is written returns an
// arbitrary value.

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
  logic [WIDTH-1:0] anything;

  arbitrary_value #(.WIDTH(WIDTH)) u_anything (.value_o(anything));

  always_ff @(posedge clk_i) begin
    if (we_i) begin
      memory[waddr_i] <= wdata_i;
    end
    if (re_i) begin
      rdata_o <= (we_i && (waddr_i == raddr_i)) ? anything : memory[raddr_i];
    end
  end

endmodule

`default_nettype wire
