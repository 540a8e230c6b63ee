// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_label_match: hit[k] = (-WINDOW <= (X >> 9) - cell[k] < WINDOW) (docs/reference/poolpointer.md, Track).
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module label_match_properties #(
    parameter int LABELS = 5,
    parameter int WINDOW = 4
) (
    input logic                clk_i,
    input logic                valid_i,
    input logic [        15:0] position_i,
    input logic [LABELS*7-1:0] cells_i
);

  logic checking;
  assign checking = 1'b1;

  logic [LABELS-1:0] hits, expected;

  dtof_label_match #(
      .LABELS(LABELS),
      .WINDOW(WINDOW)
  ) u_dut (
      .valid_i(valid_i),
      .cell_i (position_i[15:9]),
      .cells_i(cells_i),
      .hits_o (hits)
  );

  integer k, distance;
  always_comb begin
    distance = 0;
    expected = '0;
    for (k = 0; k < LABELS; k = k + 1) begin
      distance = (32'(position_i) >> 9) - 32'(cells_i[k*7+:7]);
      expected[k] = valid_i && (distance >= -WINDOW) && (distance < WINDOW);
    end
  end

  `PROVE(a_hits, hits == expected)

endmodule

`default_nettype wire
