// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_peak_detector: after any number of a pixel's bins, the peak is the lowest bin with the largest count. The harness
// watches one arbitrary bin: its count is not larger than the peak's, its count is not equal with a lower index, and the peak is a bin that was read.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module peak_detector_properties #(
    parameter int BIN_WIDTH = 3,
    parameter int COUNT_WIDTH = 3,
    parameter int SHARE_SHIFT = 3
) (
    input logic                   clk_i,
    input logic                   read_i,
    input logic                   first_i,
    input logic [  BIN_WIDTH-1:0] bin_i,
    input logic [COUNT_WIDTH-1:0] count_i
);

  localparam int BINS = 1 << BIN_WIDTH;
  localparam int SUM_WIDTH = BIN_WIDTH + COUNT_WIDTH;

  logic checking = 1'b0;
  (* anyconst *) logic [BIN_WIDTH-1:0] watched;
  logic [BIN_WIDTH-1:0] peak;
  logic [COUNT_WIDTH-1:0] count, confidence;

  dtof_peak_detector #(
      .BIN_WIDTH  (BIN_WIDTH),
      .COUNT_WIDTH(COUNT_WIDTH),
      .SHARE_SHIFT(SHARE_SHIFT)
  ) u_dut (
      .clk_i       (clk_i),
      .read_s2_i   (read_i),
      .first_s2_i  (first_i),
      .bin_s2_i    (bin_i),
      .count_s2_i  (count_i),
      .peak_o      (peak),
      .count_o     (count),
      .confidence_o(confidence)
  );

  // A pixel's bins come in order from 0 on, with pauses, and may end early with the next pixel's first bin.
  logic [BIN_WIDTH:0] seen_q;
  logic [COUNT_WIDTH-1:0] watched_count_q;
  logic [SUM_WIDTH-1:0] sum_q;
  logic any_q = 1'b0;
  logic watched_seen;

  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
    if (read_i) begin
      any_q <= 1'b1;
      seen_q <= first_i ? (BIN_WIDTH + 1)'(1) : seen_q + (BIN_WIDTH + 1)'(1);
      sum_q <= (first_i ? '0 : sum_q) + SUM_WIDTH'(count_i);
      if (bin_i == watched) begin
        watched_count_q <= count_i;
      end
    end
  end

  always_comb begin
    if (read_i) begin
      m_first: assume (any_q || first_i);
      m_in_order: assume (bin_i == (first_i ? '0 : seen_q[BIN_WIDTH-1:0]));
      m_no_more: assume (first_i || 32'(seen_q) < BINS);
    end
  end

  assign watched_seen = any_q && ((BIN_WIDTH + 1)'(watched) < seen_q);

  // S - C is never negative, so the shift is a division rounded down.
  logic [SUM_WIDTH-1:0] share, height;
  assign share = (sum_q - SUM_WIDTH'(count)) >> SHARE_SHIFT;
  assign height = (SUM_WIDTH'(count) > share) ? SUM_WIDTH'(count) - share : '0;

  `PROVE(a_peak_was_seen, !any_q || (BIN_WIDTH + 1)'(peak) < seen_q)
  `PROVE(a_none_is_larger, !watched_seen || watched_count_q <= count)
  `PROVE(a_lowest_index, !(watched_seen && watched_count_q == count) || watched >= peak)
  `PROVE(a_count_is_the_peaks, !(watched_seen && watched == peak) || watched_count_q == count)
  `PROVE(a_sum_includes_the_peak, !any_q || sum_q >= SUM_WIDTH'(count))
  `PROVE(a_confidence, !any_q || SUM_WIDTH'(confidence) == height)
  `GOAL(any_q && 32'(seen_q) == BINS && peak == (BIN_WIDTH)'(BINS - 1) && watched == (BIN_WIDTH)'(1)
        && watched_count_q == (COUNT_WIDTH)'(1))

endmodule

`default_nettype wire
