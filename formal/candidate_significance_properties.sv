// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_candidate_significance: the significance of a pair follows docs/reference/poolpointer.md, Significance, computed step by
// step on integers. The sums around the pair are constants. A pair that is not better comes after it; the initial registers are free.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module candidate_significance_properties #(
    parameter int SUM_WIDTH = 11,
    parameter int KEPT_WIDTH = 3
) (
    input logic clk_i,
    input logic [2*SUM_WIDTH-1:0] other_ahead_i,
    input logic [2*SUM_WIDTH-1:0] other_behind_i
);

  (* anyconst *) logic [2*SUM_WIDTH-1:0] ahead, behind;
  (* anyconst *) logic [4:0] pair;  // number of the pair, + 1
  (* anyconst *) logic [SUM_WIDTH-1:0] peak;
  (* anyconst *) logic was_used;
  (* anyconst *) logic [2:0] missing;
  (* anyconst *) logic [4:0] offset;
  logic [KEPT_WIDTH-1:0] significance;
  logic [3:0] t_q = 4'd0;
  logic checking;

  assign checking = (t_q != 4'd0);

  always_ff @(posedge clk_i) begin
    t_q <= (t_q == 4'd8) ? t_q : t_q + 4'd1;
  end

  dtof_candidate_significance #(
      .SUM_WIDTH (SUM_WIDTH),
      .KEPT_WIDTH(KEPT_WIDTH)
  ) u_dut (
      .clk_i         (clk_i),
      .active_i      (1'b1),
      .ahead_i       ((t_q == 4'd1) ? ahead : other_ahead_i),
      .behind_i      ((t_q == 4'd1) ? behind : other_behind_i),
      .better_i      (t_q == 4'd2),
      .new_peak_i    (t_q == 4'd4),
      .pair_i        (pair),
      .peak_i        (peak),
      .raised_i      (was_used ? SUM_WIDTH'(28) : '0),
      .missing_i     (missing),
      .offset_i      (offset),
      .significance_o(significance)
  );

  integer low, high, around, height, variance, square, level, kept;

  function automatic integer lg(input integer x);
    integer e;
    lg = 0;
    for (e = 0; e <= 15; e = e + 1) begin
      if (x >= (1 << e)) lg = 8 * e + ((x << 3) >> e) - 8;
    end
  endfunction

  always_comb begin
    low = 32'(behind[SUM_WIDTH-1:0]) + 32'(behind[SUM_WIDTH+:SUM_WIDTH]);
    high = 32'(ahead[SUM_WIDTH-1:0]) + 32'(ahead[SUM_WIDTH+:SUM_WIDTH]);
    around = (pair < 5'd5) ? 2 * high + high / 4 : (pair > 5'd27) ? 2 * low : low + high;
    height = 4 * (32'(peak) - (was_used ? 28 : 0)) - around;
    variance = around + around / 8 + 64;
    square = 2 * lg(height) - lg(variance) - 36 - 32'(offset) - 4 * 32'(missing);
    level = (height <= 0 || square < 0) ? 0 : (square >= 28) ? 7 : square / 4;
    kept = (KEPT_WIDTH == 3) ? level : (level == 0) ? 0 : (level - 1) / 2;
  end

  `ASSUME(m_a_pair, pair != 5'd0)
  `ASSUME(m_missing, missing <= 3'd4)
  `PROVE(a_significance, t_q != 4'd7 || 32'(significance) == kept)
  `GOAL(t_q == 4'd7 && level == 5 && pair == 5'd2 && was_used)

endmodule

`default_nettype wire
