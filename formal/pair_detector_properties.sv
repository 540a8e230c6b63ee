// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pair_detector: after a scan, with pauses, the result is the lowest pair with the largest sum, and lean comes from its
// two neighbours. The counts are arbitrary constants, and the harness watches one arbitrary pair; a scan may be cut off by the next.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pair_detector_properties #(
    parameter int BIN_WIDTH = 2,
    parameter int COUNT_WIDTH = 2
) (
    input logic clk_i,
    input logic read_i,
    input logic restart_i  // the address is a pixel's first
);

  localparam int BINS = 1 << BIN_WIDTH;
  localparam int ADDRESS_WIDTH = BIN_WIDTH + 1;
  localparam int SUM_WIDTH = BIN_WIDTH + COUNT_WIDTH;

  logic checking = 1'b0;
  (* anyconst *) logic [BINS*COUNT_WIDTH-1:0] counts;
  (* anyconst *) logic [BIN_WIDTH-1:0] watched;

  // Address that is read next; any number of addresses may follow beyond the bins.
  logic [ADDRESS_WIDTH-1:0] next_q = '0;
  logic [ADDRESS_WIDTH-1:0] address;
  logic past;
  logic any_q = 1'b0;    // an address was read
  logic past_q = 1'b0;   // the last address was beyond the bins
  logic done_q = 1'b0;   // the last two addresses were beyond the bins
  logic first_q = 1'b0;  // the last address was a pixel's first

  assign address = restart_i ? '0 : next_q;
  assign past = (32'(address) >= BINS);

  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
    if (read_i) begin
      any_q <= 1'b1;
      next_q <= past ? address : address + 1'b1;
      past_q <= past;
      done_q <= past && past_q;
      first_q <= (address == '0);
    end
  end

  logic [BIN_WIDTH-1:0] peak;
  logic [COUNT_WIDTH:0] count;
  logic signed [COUNT_WIDTH+1:0] lean;
  logic [SUM_WIDTH-1:0] sum;
  logic shows_first;
  logic [COUNT_WIDTH-1:0] last;

  dtof_pair_detector #(
      .BIN_WIDTH  (BIN_WIDTH),
      .COUNT_WIDTH(COUNT_WIDTH)
  ) u_dut (
      .clk_i     (clk_i),
      .read_s2_i (read_i),
      .first_s2_i(address == '0),
      .past_s2_i (past),
      .bin_s2_i  (BIN_WIDTH'(address)),
      .count_s2_i(counts[BIN_WIDTH'(address)*COUNT_WIDTH+:COUNT_WIDTH]),
      .peak_o    (peak),
      .count_o   (count),
      .lean_o    (lean),
      .sum_o     (sum),
      .first_o   (shows_first),
      .last_o    (last)
  );

  // Pairs from the equation: pair k at k; pairs 0 and BINS extend beyond the ends.
  logic [(BINS+2)*COUNT_WIDTH-1:0] padded;
  logic [COUNT_WIDTH:0] pairs[BINS+1];
  logic [SUM_WIDTH-1:0] all;
  integer k;
  assign padded = {COUNT_WIDTH'(0), counts, COUNT_WIDTH'(0)};
  always_comb begin
    all = '0;
    for (k = 0; k <= BINS; k = k + 1) begin
      pairs[k] = (COUNT_WIDTH + 1)'(padded[k*COUNT_WIDTH+:COUNT_WIDTH])
          + (COUNT_WIDTH + 1)'(padded[(k+1)*COUNT_WIDTH+:COUNT_WIDTH]);
      all = all + ((k < BINS) ? SUM_WIDTH'(counts[(k%BINS)*COUNT_WIDTH+:COUNT_WIDTH]) : '0);
    end
  end

  logic [COUNT_WIDTH:0] before, behind;
  assign before = pairs[ADDRESS_WIDTH'(peak) - 1'b1];
  assign behind = pairs[ADDRESS_WIDTH'(peak) + 1'b1];

  `PROVE(a_a_pair, !done_q || peak != '0)
  `PROVE(a_its_sum, !done_q || count == pairs[ADDRESS_WIDTH'(peak)])
  `PROVE(a_none_is_larger, !done_q || watched == '0 || pairs[ADDRESS_WIDTH'(watched)] <= count)
  `PROVE(a_lowest_of_a_tie, !done_q || watched == '0 || watched >= peak || pairs[ADDRESS_WIDTH'(watched)] != count)
  `PROVE(a_lean, !done_q || lean == $signed({1'b0, behind}) - $signed({1'b0, before}))
  `PROVE(a_sum, !done_q || sum == all)
  `PROVE(a_mean_of_rest_is_less, !done_q || all == '0
         || ((all - SUM_WIDTH'(count)) >> (BIN_WIDTH - 1)) < SUM_WIDTH'(count))
  `PROVE(a_one_bin, !any_q || shows_first == first_q)
  `PROVE(a_one_bin_shows, !first_q || (peak == '0 && last == counts[COUNT_WIDTH-1:0]))
  `GOAL(done_q && peak == (BIN_WIDTH)'(BINS - 1) && behind == (COUNT_WIDTH + 1)'(1))

endmodule

`default_nettype wire
