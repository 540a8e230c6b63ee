// SPDX-License-Identifier: Apache-2.0
// Eight times the logarithm to base 2: lg(x) = 8 e + m for x = 2^e (1 + m / 8 + ...); lg(0) = 0. Combinational.
//
// Equation (docs/reference/poolpointer.md, Significance): Mitchell's approximation with three bits of the mantissa. The result
// is at most 1.69 below 8 log2(x).
//
// The highest 1 of x_i selects its own position (e) and the three bits below it (m).
// Latency: none. Cost: two levels of gates per bit.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_eighth_octaves #(
    parameter int WIDTH = 13,  // at least 2
    localparam int LOGARITHM_WIDTH = 3 + dtof_pkg::index_width(WIDTH)
) (
    input  logic [          WIDTH-1:0] x_i,
    output logic [LOGARITHM_WIDTH-1:0] logarithm_o
);

  logic [WIDTH+1:0] padded;  // x_i without its highest bit, which is never below another 1, and three zeros
  logic [WIDTH-1:0] highest;

  assign padded = {x_i[WIDTH-2:0], 3'b000};
  assign highest[WIDTH-1] = x_i[WIDTH-1];

  genvar i;
  generate
    for (i = 0; i < WIDTH - 1; i = i + 1) begin : g_place
      assign highest[i] = x_i[i] && (x_i[WIDTH-1:i+1] == '0);
    end
  endgenerate

  int place;
  always_comb begin
    logarithm_o = '0;
    for (place = 0; place < WIDTH; place = place + 1) begin
      logarithm_o = logarithm_o
          | ({LOGARITHM_WIDTH{highest[place]}} & {(LOGARITHM_WIDTH - 3)'(place), padded[place+:3]});
    end
  end

endmodule

`default_nettype wire
