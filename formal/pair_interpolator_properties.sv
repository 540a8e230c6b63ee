// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pair_interpolator: the place is the integer quotient of twice the lean and three times the height, in units of
// 2^-PLACE_WIDTH bin. The pair is an arbitrary constant; the steps come with pauses.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pair_interpolator_properties #(
    parameter int BIN_WIDTH = 2,
    parameter int COUNT_WIDTH = 2,
    parameter int PLACE_WIDTH = 3
) (
    input logic clk_i,
    input logic step_i
);

  localparam int SUM_WIDTH = BIN_WIDTH + COUNT_WIDTH;
  localparam int PLACE_BITS = dtof_pkg::max_of(PLACE_WIDTH, 1);
  localparam int STEPS = 2 + PLACE_WIDTH;
  localparam int STEP_WIDTH = $clog2(STEPS + 1);
  localparam int WIDE = SUM_WIDTH + PLACE_WIDTH + 4;

  logic checking = 1'b0;
  (* anyconst *) logic [COUNT_WIDTH:0] before;
  (* anyconst *) logic [COUNT_WIDTH:0] count;
  (* anyconst *) logic [COUNT_WIDTH:0] behind;
  (* anyconst *) logic [SUM_WIDTH-1:0] sum;
  logic [STEP_WIDTH-1:0] step_q = '0;  // number of steps so far

  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
    if (step_i) begin
      step_q <= (32'(step_q) == STEPS) ? (STEP_WIDTH)'(1) : step_q + 1'b1;
    end
  end

  logic first;
  assign first = (step_q == '0) || (32'(step_q) == STEPS);

  logic [WIDE-1:0] rest, height, lean, offset, dividend, divisor;
  logic lower;
  logic [PLACE_BITS-1:0] place;
  logic [COUNT_WIDTH-1:0] confidence;

  dtof_pair_interpolator #(
      .BIN_WIDTH  (BIN_WIDTH),
      .COUNT_WIDTH(COUNT_WIDTH),
      .PLACE_WIDTH(PLACE_WIDTH)
  ) u_dut (
      .clk_i       (clk_i),
      .settle_i    (step_i && first),
      .begin_i     (step_i && step_q == STEP_WIDTH'(1)),
      .divide_i    (step_i && !first && step_q >= STEP_WIDTH'(2)),
      .count_i     (count),
      .lean_i      ($signed({1'b0, behind}) - $signed({1'b0, before})),
      .sum_i       (sum),
      .lower_o     (lower),
      .place_o     (place),
      .confidence_o(confidence)
  );

  assign rest = WIDE'(sum - SUM_WIDTH'(count)) >> (BIN_WIDTH - 1);
  assign height = WIDE'(count) - rest;
  assign lean = (before > behind) ? WIDE'(before - behind) : WIDE'(behind - before);
  assign offset = (PLACE_WIDTH == 0) ? '0 : WIDE'(place ^ {PLACE_BITS{lower}});
  assign dividend = ((lean < height) ? lean : height) << (PLACE_WIDTH + 1);
  assign divisor = height + (height << 1);

  // No neighbouring pair is higher, a pair is a part of the sum, and the mean of the others is less than the highest pair,
  // unless the histogram is empty (proved of dtof_pair_detector).
  `ASSUME(m_highest, before <= count && behind <= count)
  `ASSUME(m_part, SUM_WIDTH'(count) <= sum)
  `ASSUME(m_mean, sum == '0 || rest < WIDE'(count))

  logic done;
  assign done = (32'(step_q) == STEPS);

  `PROVE(a_lower, !done || lower == (before > behind))
  `PROVE(a_fits, !done || height == '0 || PLACE_WIDTH == 0 || offset * divisor <= dividend)
  `PROVE(a_no_more_fits, !done || height == '0 || PLACE_WIDTH == 0 || (offset + 1'b1) * divisor > dividend)
  `PROVE(a_no_height_no_place, !done || height != '0 || offset == '0)
  `PROVE(a_confidence, !done || (WIDE'(confidence) == height) || (height > WIDE'(confidence) && confidence == '1))
  `GOAL(done && lower && offset == (WIDE)'(1) && confidence == '1)

endmodule

`default_nettype wire
