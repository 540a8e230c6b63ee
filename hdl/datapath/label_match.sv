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
  localparam int LOW_WIDTH = $clog2(2 * WINDOW);
  localparam int HIGH_WIDTH = CELL_WIDTH + 1 - LOW_WIDTH;

  // From -WINDOW .. WINDOW - 1 to 0 .. 2 WINDOW - 1: one comparison. What only the timestamp decides is shared.
  logic [CELL_WIDTH:0] top;
  logic [HIGH_WIDTH-1:0] one_less;
  assign top = {1'b0, cell_i} + (CELL_WIDTH + 1)'(WINDOW);
  assign one_less = top[CELL_WIDTH:LOW_WIDTH] - 1'b1;

  genvar k;
  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_label
      logic [CELL_WIDTH-1:0] centre;
      logic in_use, near;
      assign centre = cells_i[k*CELL_WIDTH+:CELL_WIDTH];
      if (2 * WINDOW == 2 ** LOW_WIDTH) begin : g_power_of_two
        // top - centre has no high bits: those of both are equal, or one apart where the low ones borrow.
        assign near = ((top[LOW_WIDTH-1:0] < centre[LOW_WIDTH-1:0]) ? one_less : top[CELL_WIDTH:LOW_WIDTH])
            == {1'b0, centre[CELL_WIDTH-1:LOW_WIDTH]};
      end else begin : g_any_width
        logic [CELL_WIDTH:0] distance;
        assign distance = top - {1'b0, centre};
        assign near = (distance < (CELL_WIDTH + 1)'(2 * WINDOW));
      end
      assign in_use = bright_i ? (k < BRIGHT_LABELS) : (k < DARK_LABELS);
      assign hits_o[k] = valid_i && in_use && near;
    end
  endgenerate

  logic unused;
  assign unused = ^{1'b0, one_less};

endmodule
