// SPDX-License-Identifier: Apache-2.0
// Reference of poolPointer's rule for moving a position closer to its neighbours (docs/reference/poolpointer.md, "Choose", "Decide").

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_closer_reference #(
    parameter int W = 18
) (
    input  logic signed [W-1:0] centre_i,
    input  logic [3*W-1:0]    beside_i,   // above, below, left
    input  logic [2:0]         present_i,
    input  logic signed [W-1:0] reach_i,    // T
    output logic [2:0]         near_o,
    output logic signed [W-1:0] moved_o
);

  logic signed [W-1:0] sum, away;
  integer i;

  always_comb begin
    sum = 0;
    for (i = 0; i < 3; i = i + 1) begin
      away = beside_i[W*i+:W] - centre_i;
      near_o[i] = present_i[i] && away >= -reach_i && away <= reach_i;
      if (near_o[i]) sum = sum + away;
    end
    // The quotient is rounded towards zero.
    moved_o = (sum < 0) ? centre_i - ((-sum) >>> 2) : centre_i + (sum >>> 2);
  end

endmodule

`default_nettype wire
