// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_near_significance: no near candidate has a larger significance than the result, one near candidate has the same, and
// without a near candidate the result is 0.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module near_significance_properties #(
    parameter int LABELS = 5,
    parameter int KEPT_WIDTH = 3
) (
    input logic                         clk_i,
    input logic [         LABELS*7-1:0] cells_i,
    input logic [LABELS*KEPT_WIDTH-1:0] significances_i,
    input logic [                  6:0] cell_i
);

  logic checking = 1'b0;
  logic [LABELS*7-1:0] cells_q;
  logic [LABELS*KEPT_WIDTH-1:0] significances_q;
  logic [6:0] cell_q;

  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
    {cells_q, significances_q, cell_q} <= {cells_i, significances_i, cell_i};
  end

  logic [KEPT_WIDTH-1:0] significance;
  logic [LABELS-1:0] near, not_more, equal;

  dtof_near_significance #(.LABELS(LABELS), .KEPT_WIDTH(KEPT_WIDTH)) u_dut (
      .clk_i(clk_i),
      .take_i(1'b1),
      .cells_i(cells_i),
      .significances_i(significances_i),
      .cell_i(cell_i),
      .significance_o(significance)
  );

  genvar k;
  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_label
      assign near[k] = (32'(cells_q[k*7+:7]) + 4 >= 32'(cell_q)) && (32'(cells_q[k*7+:7]) <= 32'(cell_q) + 4);
      assign not_more[k] = !near[k] || (significances_q[k*KEPT_WIDTH+:KEPT_WIDTH] <= significance);
      assign equal[k] = near[k] && (significances_q[k*KEPT_WIDTH+:KEPT_WIDTH] == significance);
    end
  endgenerate

  `PROVE(a_none_has_more, &not_more)
  `PROVE(a_one_has_it, |equal || significance == '0)

endmodule

`default_nettype wire
