// SPDX-License-Identifier: Apache-2.0
// APB4 slave in front of photon_generator: a word for each pixel, at offset 4 (row x COLUMNS + column), sets the code of the pixel's
// target. The place of a sensor's own registers.
//
// The slave refuses reads, bytes, other offsets and codes that have more than NP bits, with PSLVERR.
// Schedule: photon_generator takes a target in COLUMNS + ROWS x COLUMNS clocks; a write that comes earlier waits so long.
// Cost: a counter.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module soc_scene_registers #(
    parameter int NP = 10,
    parameter int COLUMNS = 4,
    parameter int ROWS = 8,
    localparam int PIXEL_WIDTH = dtof_pkg::index_width(ROWS * COLUMNS)
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   psel_i,
    input  logic                   penable_i,
    input  logic                   pwrite_i,
    input  logic [           11:0] paddr_i,
    input  logic [           31:0] pwdata_i,
    input  logic [            3:0] pstrb_i,
    output logic                   pready_o,
    output logic                   pslverr_o,
    output logic                   target_write_o,
    output logic [PIXEL_WIDTH-1:0] target_pixel_o,
    output logic [         NP-1:0] target_code_o
);

  localparam int PIXELS = ROWS * COLUMNS;
  localparam int MOST_PIXELS = 1024;  // words of 4 KiB
  localparam int WAIT_CLOCKS = COLUMNS + PIXELS;
  localparam int COUNT_WIDTH = $clog2(WAIT_CLOCKS + 1);

  `DTOF_REQUIRE(g_illegal_pixels, PIXELS >= 2 && PIXELS <= MOST_PIXELS,
                "soc_scene_registers: ROWS times COLUMNS must be 2 to 1024")

  logic [COUNT_WIDTH-1:0] wait_q;
  logic legal;

  assign legal = pwrite_i && (pstrb_i == '1) && (paddr_i[1:0] == '0) && ({1'b0, paddr_i[11:2]} < 11'(PIXELS))
      && (pwdata_i[31:NP] == '0);
  assign pready_o = !legal || (wait_q == '0);
  assign pslverr_o = !legal;
  assign target_write_o = psel_i && penable_i && legal && (wait_q == '0);
  assign target_pixel_o = paddr_i[2+:PIXEL_WIDTH];
  assign target_code_o = pwdata_i[NP-1:0];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      wait_q <= '0;
    end else if (target_write_o) begin
      wait_q <= COUNT_WIDTH'(WAIT_CLOCKS);
    end else if (wait_q != '0) begin
      wait_q <= wait_q - 1'b1;
    end
  end

endmodule

`default_nettype wire
