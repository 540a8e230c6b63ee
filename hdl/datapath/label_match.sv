// SPDX-License-Identifier: Apache-2.0
// Which candidates of a group a timestamp supports. Combinational.
//
// Equation (docs/reference/poolpointer.md, Track): hit[k] = (-WINDOW <= (X >> 9) - cell[k] < WINDOW), for the
// candidates in use.
// Cost: a 7-bit subtractor and a range check a candidate.
module label_match #(
    parameter int LABELS = 6,
    parameter int DARK_LABELS = 6,
    parameter int BRIGHT_LABELS = 6,
    parameter int WINDOW = 5  // cells to either side of a candidate
) (
    input  logic                                       valid_i,   // there is a timestamp
    input  logic [        dtof_pkg::POOL_CELL_WIDTH-1:0] cell_i,    // its cell, X >> 9
    input  logic                                       bright_i,
    input  logic [LABELS*dtof_pkg::POOL_CELL_WIDTH-1:0] cells_i,   // the candidates'
    output logic [                           LABELS-1:0] hits_o
);

  localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH;

  genvar k;
  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_label
      // From -WINDOW .. WINDOW - 1 to 0 .. 2 WINDOW - 1: one comparison.
      logic [CELL_WIDTH:0] distance;
      logic in_use;
      assign distance = {1'b0, cell_i} - {1'b0, cells_i[k*CELL_WIDTH+:CELL_WIDTH]} + (CELL_WIDTH + 1)'(WINDOW);
      assign in_use = bright_i ? (k < BRIGHT_LABELS) : (k < DARK_LABELS);
      assign hits_o[k] = valid_i && in_use && (distance < (CELL_WIDTH + 1)'(2 * WINDOW));
    end
  endgenerate

endmodule
