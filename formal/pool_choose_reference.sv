// SPDX-License-Identifier: Apache-2.0
// Reference of poolPointer's choose (docs/reference/poolpointer.md, "Choose") for a column whose pixels are of one group: the first pointer
// words. In signed integers of W bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_choose_reference #(
    parameter int W = 18,
    parameter int ROWS = 2,
    parameter int LABELS = 5,
    parameter int HAS_LEFT = 0,
    parameter int HAS_RIGHT = 1
) (
    input  logic [LABELS*W-1:0]      cells_i,
    input  logic [W-1:0]               background_i,
    input  logic [ROWS*LABELS*W-1:0] scores_i,
    input  logic [ROWS*W-1:0]        leaders_i,
    input  logic [ROWS*W-1:0]        offsets_i,
    input  logic [ROWS*LABELS*W-1:0] right_scores_i,
    input  logic [ROWS*W-1:0]        left_cells_i,   // cell chosen in each row of the column to the left
    input  logic [ROWS*W-1:0]        left_starts_i,  // S(a) of each row of the column to the left
    output logic [ROWS*W-1:0]        labels_o,       // a
    output logic [ROWS*W-1:0]        cells_o,        // cell[a]
    output logic [ROWS*W-1:0]        starts_o,       // S(a)
    output logic [ROWS*W-1:0]        pointers_o,     // pa
    output logic [ROWS*W-1:0]        rivals_o,       // pb
    output logic [ROWS*W-1:0]        advantages_o    // n
);

  function automatic logic signed [W-1:0] of(input logic [LABELS*W-1:0] values, input logic [W-1:0] label);
    integer k;
    of = 0;
    for (k = 0; k < LABELS; k = k + 1) begin
      if (label == 32'(k)) of = values[W*k+:W];
    end
  endfunction

  // The label of the largest value but that of `without`; the lowest label on a tie.
  function automatic logic [W-1:0] best(input logic [LABELS*W-1:0] values, input logic [W-1:0] without);
    integer k;
    logic signed [W-1:0] value, highest;
    best = 32'(LABELS);
    highest = 0;
    for (k = 0; k < LABELS; k = k + 1) begin
      value = values[W*k+:W];
      if (without != 32'(k) && (best == 32'(LABELS) || value > highest)) begin
        best = 32'(k);
        highest = value;
      end
    end
  endfunction

  function automatic logic [LABELS*W-1:0] own_evidence(input logic [LABELS*W-1:0] scores, input logic [W-1:0] background);
    integer k;
    for (k = 0; k < LABELS; k = k + 1) begin
      own_evidence[W*k+:W] = scores[W*k+:W] - ((k >= 2) ? background >> 3 : 32'd0);
    end
  endfunction

  function automatic logic far(input logic signed [W-1:0] cell_of_label, input logic signed [W-1:0] other);
    logic signed [W-1:0] away;
    away = cell_of_label - other;
    far = away > 4 || away < -4;
  endfunction

  logic [ROWS*LABELS*W-1:0] evidence, positions, beliefs;
  logic [W-1:0] lambda;
  assign lambda = 32'd2 + (((background_i << 2) + background_i) >> 4);

  pool_chain_reference #(
      .ROWS  (ROWS),
      .LABELS(LABELS)
  ) u_chain (
      .evidence_i (evidence),
      .positions_i(positions),
      .lambda_i   (lambda),
      .beliefs_o  (beliefs)
  );

  genvar r;
  generate
    for (r = 0; r < ROWS; r = r + 1) begin : g_row
      logic [LABELS*W-1:0] own, right, mine;
      logic [W-1:0] p, q, cost, limit;
      logic signed [W-1:0] between;
      integer k;

      always_comb begin
        own = own_evidence(scores_i[r*LABELS*W+:LABELS*W], background_i);
        right = own_evidence(right_scores_i[r*LABELS*W+:LABELS*W], background_i);
        p = best(right, 32'(LABELS));
        q = best(right, p);
        between = of(right, p) - of(right, q);
        limit = 32'd1 + (((background_i << 1) + background_i) >> 4);
        for (k = 0; k < LABELS; k = k + 1) begin
          cost = 32'd0;
          if (HAS_LEFT != 0 && far(cells_i[W*k+:W], left_cells_i[W*r+:W])) cost = 32'd1 + limit;
          if (HAS_RIGHT != 0 && far(cells_i[W*k+:W], of(cells_i, p))) begin
            cost = cost + ((far(cells_i[W*k+:W], of(cells_i, q)) || between > $signed(limit)) ? limit : between);
          end
          mine[W*k+:W] = own[W*k+:W] - cost;
        end
      end

      assign evidence[r*LABELS*W+:LABELS*W] = mine;
      for (genvar g = 0; g < LABELS; g = g + 1) begin : g_label
        assign positions[(r*LABELS+g)*W+:W] = cells_i[W*g+:W] << 9;
      end

      logic [LABELS*W-1:0] belief;
      logic [W-1:0] a, b;
      logic signed [W-1:0] margin, second;
      assign belief = beliefs[r*LABELS*W+:LABELS*W];
      assign a = best(belief, 32'(LABELS));
      assign b = best(belief, a);
      assign margin = of(belief, a) - of(belief, b);
      assign second = (of(cells_i, b) <<< 9) + ((b == leaders_i[W*r+:W]) ? ($signed(offsets_i[W*r+:W]) <<< 6) : 0);
      assign labels_o[W*r+:W] = a;
      assign cells_o[W*r+:W] = of(cells_i, a);
      assign starts_o[W*r+:W] = (of(cells_i, a) <<< 9) + ((a == leaders_i[W*r+:W]) ? ($signed(offsets_i[W*r+:W]) <<< 6) : 0);
      assign rivals_o[W*r+:W] = second >>> 9;
      assign advantages_o[W*r+:W] = (margin > 63) ? 63 : margin;

      logic [2:0] unused_near;
      pool_closer_reference u_closer (
          .centre_i (starts_o[W*r+:W]),
          .beside_i ({left_starts_i[W*r+:W], starts_o[W*((r+1)%ROWS)+:W], starts_o[W*((r+ROWS-1)%ROWS)+:W]}),
          .present_i({HAS_LEFT != 0, r != ROWS - 1, r != 0}),
          .reach_i  ((background_i < 32'd6) ? W'(1024) : W'(1536)),
          .near_o   (unused_near),
          .moved_o  (pointers_o[W*r+:W])
      );
    end
  endgenerate

endmodule

`default_nettype wire
