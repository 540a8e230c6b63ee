// SPDX-License-Identifier: Apache-2.0
// Reference of the chain along a column (docs/reference/poolpointer.md, "Chain"): the belief of each label of each row. In signed integers of W bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_chain_reference #(
    parameter int W = 18,
    parameter int ROWS = 2,
    parameter int LABELS = 2
) (
    input  logic [ROWS*LABELS*W-1:0] evidence_i,
    input  logic [ROWS*LABELS*W-1:0] positions_i,
    input  logic [W-1:0]               lambda_i,
    output logic [ROWS*LABELS*W-1:0] beliefs_o
);

  // Message of a row to the next row: sums of the row, positions of both.
  function automatic logic [LABELS*W-1:0] message(input logic [LABELS*W-1:0] sums, input logic [LABELS*W-1:0] from,
                                                   input logic [LABELS*W-1:0] to, input logic [W-1:0] lambda);
    integer k, m;
    logic signed [W-1:0] top, sum, best, apart;
    top = sums[W-1:0];
    for (k = 1; k < LABELS; k = k + 1) begin
      sum = sums[W*k+:W];
      if (sum > top) top = sum;
    end
    for (m = 0; m < LABELS; m = m + 1) begin
      best = -lambda;
      for (k = 0; k < LABELS; k = k + 1) begin
        apart = from[W*k+:W] - to[W*m+:W];
        sum = sums[W*k+:W] - top;
        if (apart >= -2048 && apart <= 2048 && sum > best) best = sum;
      end
      message[W*m+:W] = best;
    end
  endfunction

  function automatic logic [LABELS*W-1:0] added(input logic [LABELS*W-1:0] a, input logic [LABELS*W-1:0] b);
    integer k;
    for (k = 0; k < LABELS; k = k + 1) added[W*k+:W] = a[W*k+:W] + b[W*k+:W];
  endfunction

  localparam int ROW = LABELS * W;
  logic [ROWS*ROW-1:0] down, up;

  genvar r;
  generate
    for (r = 0; r < ROWS; r = r + 1) begin : g_row
      if (r == 0) begin : g_first
        assign down[0+:ROW] = '0;
      end else begin : g_from_above
        assign down[r*ROW+:ROW] = message(added(evidence_i[(r-1)*ROW+:ROW], down[(r-1)*ROW+:ROW]), positions_i[(r-1)*ROW+:ROW],
                                          positions_i[r*ROW+:ROW], lambda_i);
      end
      if (r == ROWS - 1) begin : g_last
        assign up[r*ROW+:ROW] = '0;
      end else begin : g_from_below
        assign up[r*ROW+:ROW] = message(added(evidence_i[(r+1)*ROW+:ROW], up[(r+1)*ROW+:ROW]), positions_i[(r+1)*ROW+:ROW],
                                        positions_i[r*ROW+:ROW], lambda_i);
      end
      assign beliefs_o[r*ROW+:ROW] = added(evidence_i[r*ROW+:ROW], added(down[r*ROW+:ROW], up[r*ROW+:ROW]));
    end
  endgenerate

endmodule

`default_nettype wire
