// SPDX-License-Identifier: Apache-2.0
// poolPointer, decide: the largest significance among a group's candidates that are near a position.
//
// Equation (docs/reference/poolpointer.md, Confidence): max of Z[k] over the candidates k with |cell[k] - cell| <= 4; 0 if no
// candidate is that near.
//
// 1. take_i registers which candidates are near, and all significances.
// 2. A level is reached if the significance of a near candidate is at least that level; the result is the highest level reached.
//
// Schedule: significance_o holds until the clock after the next take_i. Latency: 1 clock from take_i.
// Cost: LABELS subtractors and comparators of 8 bits, LABELS (1 + KEPT_WIDTH) flip-flops.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_near_significance #(
    parameter int LABELS = 5,
    parameter int KEPT_WIDTH = 3,  // bits of a significance
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH
) (
    input  logic                         clk_i,
    input  logic                         take_i,
    input  logic [LABELS*CELL_WIDTH-1:0] cells_i,
    input  logic [LABELS*KEPT_WIDTH-1:0] significances_i,
    input  logic [       CELL_WIDTH-1:0] cell_i,          // cell of the position
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

  logic [LABELS-1:0] near_q;
  logic [LABELS*KEPT_WIDTH-1:0] significances_q;

  always_ff @(posedge clk_i) begin
    if (take_i) begin
      near_q <= near;
      significances_q <= significances_i;
    end
  end

  localparam int LEVELS = 1 << KEPT_WIDTH;
  logic [LEVELS*LABELS-1:0] reaches;
  logic [LEVELS:0] reached;  // [l]: level l is reached; [LEVELS] is always 0

  genvar l;
  generate
    for (l = 1; l < LEVELS; l = l + 1) begin : g_level
      for (k = 0; k < LABELS; k = k + 1) begin : g_candidate
        assign reaches[l*LABELS+k] = near_q[k] && (significances_q[k*KEPT_WIDTH+:KEPT_WIDTH] >= KEPT_WIDTH'(l));
      end
      assign reached[l] = (reaches[l*LABELS+:LABELS] != '0);
    end
  endgenerate
  assign reached[0] = 1'b1;
  assign reached[LEVELS] = 1'b0;
  assign reaches[LABELS-1:0] = '0;

  int level;
  always_comb begin
    significance_o = '0;
    for (level = 1; level < LEVELS; level = level + 1) begin
      significance_o = significance_o | (KEPT_WIDTH'(level) & {KEPT_WIDTH{reached[level] && !reached[level+1]}});
    end
  end

  logic unused;
  assign unused = ^{reached[0], reaches[LABELS-1:0]};

endmodule

`default_nettype wire
