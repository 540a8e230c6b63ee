// SPDX-License-Identifier: Apache-2.0
// Finds a histogram's peak and its confidence while the histogram is scanned, one bin per clock (thesis Fig. 4.10).
//
// Equation: peak = lowest bin with the largest count; confidence = max(0, C - ((S - C) >> SHARE_SHIFT)) with C
// the count of the peak and S the sum of all counts: the peak's height above the mean of the other bins.
// Schedule: counts arrive at S2, bin by bin. Latency: the outputs are valid at S3, one clock after the last bin, for one clock, in
// which the next pixel's first bin may already arrive.
// Cost: 2 COUNT_WIDTH + 2 BIN_WIDTH flip-flops, a comparator, an adder, two subtractors.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_peak_detector #(
    parameter int BIN_WIDTH = 5,
    parameter int COUNT_WIDTH = 10,
    parameter int SHARE_SHIFT = 5,  // log2 of the number of bins of the mean
    localparam int SUM_WIDTH = COUNT_WIDTH + BIN_WIDTH
) (
    input  logic                   clk_i,
    input  logic                   read_s2_i,
    input  logic                   first_s2_i,   // first bin of a pixel
    input  logic [  BIN_WIDTH-1:0] bin_s2_i,
    input  logic [COUNT_WIDTH-1:0] count_s2_i,
    output logic [  BIN_WIDTH-1:0] peak_o,
    output logic [COUNT_WIDTH-1:0] count_o,
    output logic [COUNT_WIDTH-1:0] confidence_o
);

  logic [BIN_WIDTH-1:0] peak_q;
  logic [COUNT_WIDTH-1:0] count_q;
  logic [SUM_WIDTH-1:0] sum_q, share;

  always_ff @(posedge clk_i) begin
    if (read_s2_i) begin
      if (first_s2_i || count_s2_i > count_q) begin
        peak_q <= bin_s2_i;
        count_q <= count_s2_i;
      end
      // first_s2_i comes late from the broadcast, so it selects after the adder.
      sum_q <= first_s2_i ? SUM_WIDTH'(count_s2_i) : sum_q + SUM_WIDTH'(count_s2_i);
    end
  end

  assign share = (sum_q - SUM_WIDTH'(count_q)) >> SHARE_SHIFT;
  assign peak_o = peak_q;
  assign count_o = count_q;
  assign confidence_o = (share >= SUM_WIDTH'(count_q)) ? '0 : count_q - COUNT_WIDTH'(share);

endmodule

`default_nettype wire
