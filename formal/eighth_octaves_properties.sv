// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_eighth_octaves: the logarithm follows its definition: the power of two below x, and the eighths of the way to the
// next power.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module eighth_octaves_properties #(
    parameter int WIDTH = 13,
    localparam int LOGARITHM_WIDTH = 3 + dtof_pkg::index_width(WIDTH)
) (
    input logic             clk_i,
    input logic [WIDTH-1:0] x_i
);

  logic checking;
  assign checking = 1'b1;

  logic [LOGARITHM_WIDTH-1:0] logarithm;
  logic [WIDTH+3:0] eight_times, power;

  dtof_eighth_octaves #(.WIDTH(WIDTH)) u_dut (.x_i(x_i), .logarithm_o(logarithm));

  assign power = (WIDTH + 4)'(1) << (logarithm >> 3);
  assign eight_times = {1'b0, x_i, 3'b000};

  `PROVE(a_nothing, x_i != '0 || logarithm == '0)
  `PROVE(a_power, x_i == '0 || ((WIDTH + 4)'(x_i) >= power && (WIDTH + 4)'(x_i) < power << 1))
  `PROVE(a_eighths, x_i == '0 || ((eight_times >> (logarithm >> 3)) == (WIDTH + 4)'(logarithm[2:0]) + (WIDTH + 4)'(8)))

endmodule

`default_nettype wire
