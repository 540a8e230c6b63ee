// SPDX-License-Identifier: Apache-2.0
// Reference of poolPointer's choose (docs/reference/poolpointer.md, "Choose") for a column whose pixels are of one group: the first pointer
// words. In 32-bit integers.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_choose_reference #(
    parameter int ROWS = 2,
    parameter int LABELS = 5,
    parameter int HAS_LEFT = 0,
    parameter int HAS_RIGHT = 1
) (
    input  logic [LABELS*32-1:0]      cells_i,
    input  logic [31:0]               background_i,
    input  logic [ROWS*LABELS*32-1:0] scores_i,
    input  logic [ROWS*32-1:0]        leaders_i,
    input  logic [ROWS*32-1:0]        offsets_i,
    input  logic [ROWS*LABELS*32-1:0] right_scores_i,
    input  logic [ROWS*32-1:0]        left_cells_i,   // cell chosen in each row of the column to the left
    input  logic [ROWS*32-1:0]        left_starts_i,  // S(a) of each row of the column to the left
    output logic [ROWS*32-1:0]        labels_o,       // a
    output logic [ROWS*32-1:0]        cells_o,        // cell[a]
    output logic [ROWS*32-1:0]        starts_o,       // S(a)
    output logic [ROWS*32-1:0]        pointers_o,     // pa
    output logic [ROWS*32-1:0]        rivals_o,       // pb
    output logic [ROWS*32-1:0]        advantages_o    // n
);

  function automatic logic signed [31:0] of(input logic [LABELS*32-1:0] values, input logic [31:0] label);
    integer k;
    of = 0;
    for (k = 0; k < LABELS; k = k + 1) begin
      if (label == 32'(k)) of = values[32*k+:32];
    end
  endfunction

  // The label of the largest value but that of `without`; the lowest label on a tie.
  function automatic logic [31:0] best(input logic [LABELS*32-1:0] values, input logic [31:0] without);
    integer k;
    logic signed [31:0] value, highest;
    best = 32'(LABELS);
    highest = 0;
    for (k = 0; k < LABELS; k = k + 1) begin
      value = values[32*k+:32];
      if (without != 32'(k) && (best == 32'(LABELS) || value > highest)) begin
        best = 32'(k);
        highest = value;
      end
    end
  endfunction

  function automatic logic [LABELS*32-1:0] own_evidence(input logic [LABELS*32-1:0] scores, input logic [31:0] background);
    integer k;
    for (k = 0; k < LABELS; k = k + 1) begin
      own_evidence[32*k+:32] = scores[32*k+:32] - ((k >= 2) ? background >> 3 : 32'd0);
    end
  endfunction

  function automatic logic far(input logic signed [31:0] cell_of_label, input logic signed [31:0] other);
    logic signed [31:0] away;
    away = cell_of_label - other;
    far = away > 4 || away < -4;
  endfunction

  logic [ROWS*LABELS*32-1:0] evidence, positions, beliefs;
  logic [31:0] lambda;
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
      logic [LABELS*32-1:0] own, right, mine;
      logic [31:0] p, q, cost, limit;
      logic signed [31:0] between;
      integer k;

      always_comb begin
        own = own_evidence(scores_i[r*LABELS*32+:LABELS*32], background_i);
        right = own_evidence(right_scores_i[r*LABELS*32+:LABELS*32], background_i);
        p = best(right, 32'(LABELS));
        q = best(right, p);
        between = of(right, p) - of(right, q);
        limit = 32'd1 + (((background_i << 1) + background_i) >> 4);
        for (k = 0; k < LABELS; k = k + 1) begin
          cost = 32'd0;
          if (HAS_LEFT != 0 && far(cells_i[32*k+:32], left_cells_i[32*r+:32])) cost = 32'd1 + limit;
          if (HAS_RIGHT != 0 && far(cells_i[32*k+:32], of(cells_i, p))) begin
            cost = cost + ((far(cells_i[32*k+:32], of(cells_i, q)) || between > $signed(limit)) ? limit : between);
          end
          mine[32*k+:32] = own[32*k+:32] - cost;
        end
      end

      assign evidence[r*LABELS*32+:LABELS*32] = mine;
      for (genvar g = 0; g < LABELS; g = g + 1) begin : g_label
        assign positions[(r*LABELS+g)*32+:32] = cells_i[32*g+:32] << 9;
      end

      logic [LABELS*32-1:0] belief;
      logic [31:0] a, b;
      logic signed [31:0] margin, second;
      assign belief = beliefs[r*LABELS*32+:LABELS*32];
      assign a = best(belief, 32'(LABELS));
      assign b = best(belief, a);
      assign margin = of(belief, a) - of(belief, b);
      assign second = (of(cells_i, b) <<< 9) + ((b == leaders_i[32*r+:32]) ? ($signed(offsets_i[32*r+:32]) <<< 6) : 0);
      assign labels_o[32*r+:32] = a;
      assign cells_o[32*r+:32] = of(cells_i, a);
      assign starts_o[32*r+:32] = (of(cells_i, a) <<< 9) + ((a == leaders_i[32*r+:32]) ? ($signed(offsets_i[32*r+:32]) <<< 6) : 0);
      assign rivals_o[32*r+:32] = second >>> 9;
      assign advantages_o[32*r+:32] = (margin > 63) ? 63 : margin;

      logic [2:0] unused_near;
      pool_closer_reference u_closer (
          .centre_i (starts_o[32*r+:32]),
          .beside_i ({left_starts_i[32*r+:32], starts_o[32*((r+1)%ROWS)+:32], starts_o[32*((r+ROWS-1)%ROWS)+:32]}),
          .present_i({HAS_LEFT != 0, r != ROWS - 1, r != 0}),
          .reach_i  ((background_i < 32'd6) ? 32'd1024 : 32'd1536),
          .near_o   (unused_near),
          .moved_o  (pointers_o[32*r+:32])
      );
    end
  endgenerate

endmodule

`default_nettype wire
