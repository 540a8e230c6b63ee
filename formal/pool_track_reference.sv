// SPDX-License-Identifier: Apache-2.0
// Reference of poolPointer's track phase (docs/reference/poolpointer.md, "Timestamps", "Thinning", "Track"): a pixel's word after an
// acquisition in which the pixel has one or two timestamps. In signed integers of W bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_track_reference #(
    parameter int W = 18,
    parameter int LABELS = 5,
    parameter int MOST_SCORE = 15
) (
    input  logic signed [W-1:0]   preferred_i,  // P
    input  logic signed [W-1:0]   other_i,
    input  logic                 two_i,        // there is another timestamp
    input  logic                 thinned_i,    // P is thinned
    input  logic [LABELS*W-1:0] cells_i,
    input  logic [W-1:0]          background_i,
    input  logic [LABELS*W-1:0] scores_i,
    input  logic [W-1:0]          leader_i,
    input  logic signed [W-1:0]   offset_i,
    output logic [LABELS*W-1:0] scores_o,
    output logic [W-1:0]          leader_o,
    output logic signed [W-1:0]   offset_o
);

  // Lowest label whose window has x; LABELS if there is none.
  function automatic logic [W-1:0] label_of(input logic signed [W-1:0] x, input logic [LABELS*W-1:0] cells);
    integer k;
    logic signed [W-1:0] away;
    label_of = 32'(LABELS);
    for (k = LABELS - 1; k >= 0; k = k - 1) begin
      away = (x >>> 9) - $signed(cells[W*k+:W]);
      if (away >= -4 && away < 4) label_of = 32'(k);
    end
  endfunction

  function automatic logic [W-1:0] of(input logic [LABELS*W-1:0] values, input logic [W-1:0] label);
    integer k;
    of = 32'd0;
    for (k = 0; k < LABELS; k = k + 1) begin
      if (label == 32'(k)) of = values[W*k+:W];
    end
  endfunction

  logic signed [W-1:0] x, e, step;
  logic [W-1:0] label, leads;
  integer k;

  always_comb begin
    x = preferred_i;
    if (two_i && label_of(preferred_i, cells_i) == 32'(LABELS) && label_of(other_i, cells_i) != 32'(LABELS)) x = other_i;
    leads = of(scores_i, leader_i);
    step = (leads < 32'd3) ? 4 : (leads < 32'd8) ? 2 : 1;
    e = (preferred_i - $signed((of(cells_i, leader_i) << 9) + (offset_i << 6))) >>> 9;
    label = label_of(x, cells_i);
    scores_o = scores_i;
    leader_o = leader_i;
    offset_o = offset_i;
    for (k = 0; k < LABELS; k = k + 1) begin
      if (background_i < 32'd4 || !thinned_i) begin
        if (of(scores_i, label) < 32'(MOST_SCORE)) begin
          if (label == 32'(k)) scores_o[W*k+:W] = scores_i[W*k+:W] + 32'd1;
        end else if (label != 32'(LABELS) && label != 32'(k) && scores_i[W*k+:W] != 32'd0) begin
          scores_o[W*k+:W] = scores_i[W*k+:W] - 32'd1;
        end
      end
    end
    if (background_i < 32'd4 || !thinned_i) begin
      if (e >= 1 && e <= 7) offset_o = (offset_i + step > 31) ? 31 : offset_i + step;
      if (e >= -8 && e <= -2) offset_o = (offset_i - step < -32) ? -32 : offset_i - step;
      if (label != 32'(LABELS) && label != leader_i && of(scores_o, label) > of(scores_o, leader_i)) begin
        leader_o = label;
        offset_o = 0;
      end
    end
  end

endmodule

`default_nettype wire
