// SPDX-License-Identifier: Apache-2.0
// poolPointer, track: which candidates of a group a timestamp supports. Combinational.
//
// Equation (docs/reference/poolpointer.md, Track): hit[k] = (-WINDOW <= (X >> 9) - cell[k] < WINDOW).
// Latency: none. Cost: a 7-bit subtractor and a range check per candidate.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_label_match #(
    parameter int LABELS = 5,
    parameter int WINDOW = 4  // cells on each side of a candidate
) (
    input  logic                                       valid_i,   // the pixel has a timestamp
    input  logic [        dtof_pkg::POOL_CELL_WIDTH-1:0] cell_i,    // cell of the timestamp, X >> 9
    input  logic [LABELS*dtof_pkg::POOL_CELL_WIDTH-1:0] cells_i,   // cells of the candidates
    output logic [                           LABELS-1:0] hits_o
);

  localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH;
  localparam int LOW_WIDTH = $clog2(2 * WINDOW);
  localparam int HIGH_WIDTH = CELL_WIDTH + 1 - LOW_WIDTH;

  // Adding WINDOW moves the range to 0 .. 2 WINDOW - 1, which needs one comparison. All candidates share what depends on cell_i alone.
  logic [CELL_WIDTH:0] top;
  logic [LOW_WIDTH-1:0] top_low;
  logic [HIGH_WIDTH-1:0] top_high, one_less;
  assign top = {1'b0, cell_i} + (CELL_WIDTH + 1)'(WINDOW);
  assign top_low = top[LOW_WIDTH-1:0];
  assign top_high = top[CELL_WIDTH:LOW_WIDTH];
  assign one_less = top_high - 1'b1;

  // Inside if (valid_i), so that a simulator evaluates it for timestamps only; the defaults avoid latches.
  integer k;
  logic [CELL_WIDTH-1:0] centre;
  logic [CELL_WIDTH:0] distance;
  logic near;
  always_comb begin
    hits_o = '0;
    k = 0;
    centre = '0;
    distance = '0;
    near = 1'b0;
    if (valid_i) begin
      for (k = 0; k < LABELS; k = k + 1) begin
        centre = cells_i[k*CELL_WIDTH+:CELL_WIDTH];
        distance = top - {1'b0, centre};
        if (2 * WINDOW == 2 ** LOW_WIDTH) begin
          // Hit if the distance has no high bits: the high parts are equal, or differ by one if the low parts borrow.
          near = ((top_low < LOW_WIDTH'(centre)) ? one_less : top_high) == HIGH_WIDTH'(centre >> LOW_WIDTH);
        end else begin
          near = (distance < (CELL_WIDTH + 1)'(2 * WINDOW));
        end
        hits_o[k] = near;
      end
    end
  end

  logic unused;
  assign unused = ^{1'b0, one_less};

endmodule

`default_nettype wire
