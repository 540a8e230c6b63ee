// SPDX-License-Identifier: Apache-2.0
// poolPointer 2: the largest significance of a group's candidates within a coarse bin of a position.
//
// Equation (docs/reference/poolpointer2.md, Confidence): max of Z[k] over the candidates k with |cell[k] - cell| <= 4, 0 without
// one.
//
// Combinational. Cost: LABELS subtractors and comparisons of 8 bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_near_significance #(
    parameter int LABELS = 5,
    parameter int KEPT_WIDTH = 3,  // bits of a significance
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH
) (
    input  logic [LABELS*CELL_WIDTH-1:0] cells_i,
    input  logic [LABELS*KEPT_WIDTH-1:0] significances_i,
    input  logic [       CELL_WIDTH-1:0] cell_i,          // of the position
    output logic [       KEPT_WIDTH-1:0] significance_o
);

  localparam logic signed [CELL_WIDTH:0] REACH = (CELL_WIDTH + 1)'(4);

  logic [LABELS-1:0] near;

  genvar k;
  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_label
      logic signed [CELL_WIDTH:0] distance;
      assign distance = $signed({1'b0, cells_i[k*CELL_WIDTH+:CELL_WIDTH]}) - $signed({1'b0, cell_i});
      assign near[k] = (distance <= REACH) && (distance >= -REACH);
    end
  endgenerate

  int label;
  always_comb begin
    significance_o = '0;
    for (label = 0; label < LABELS; label = label + 1) begin
      if (near[label] && significances_i[label*KEPT_WIDTH+:KEPT_WIDTH] > significance_o) begin
        significance_o = significances_i[label*KEPT_WIDTH+:KEPT_WIDTH];
      end
    end
  end

endmodule

`default_nettype wire
