// SPDX-License-Identifier: Apache-2.0
// hit[k] = (-WINDOW <= (X >> 9) - cell[k] < WINDOW), for the candidates in use (docs/reference/poolpointer.md and
// poolpointer2.md, Track).
`include "properties.svh"

module label_match_properties #(
    parameter int LABELS = 5,
    parameter int DARK_LABELS = 5,
    parameter int BRIGHT_LABELS = 5,
    parameter int WINDOW = 5
) (
    input logic                clk_i,
    input logic                valid_i,
    input logic [        15:0] position_i,
    input logic                bright_i,
    input logic [LABELS*7-1:0] cells_i
);

  logic checking;
  assign checking = 1'b1;

  logic [LABELS-1:0] hits, expected;

  label_match #(
      .LABELS       (LABELS),
      .DARK_LABELS  (DARK_LABELS),
      .BRIGHT_LABELS(BRIGHT_LABELS),
      .WINDOW       (WINDOW)
  ) u_dut (
      .valid_i (valid_i),
      .cell_i  (position_i[15:9]),
      .bright_i(bright_i),
      .cells_i (cells_i),
      .hits_o  (hits)
  );

  integer k, distance, candidates;
  always_comb begin
    candidates = bright_i ? BRIGHT_LABELS : DARK_LABELS;
    distance = 0;
    expected = '0;
    for (k = 0; k < LABELS; k = k + 1) begin
      distance = (32'(position_i) >> 9) - 32'(cells_i[k*7+:7]);
      expected[k] = valid_i && (k < candidates) && (distance >= -WINDOW) && (distance < WINDOW);
    end
  end

  `PROVE(a_hits, hits == expected)

endmodule
