// SPDX-License-Identifier: Apache-2.0
// Finds the highest pair of neighbouring bins while a histogram is scanned, one bin per clock, and the difference between the pair
// above and the pair below it, each of which has a bin in common with the highest pair.
//
// Equation (docs/reference/readouts.md, coarsehistogram): P[k] = C[k-1] + C[k] with the counts C, which are 0 outside the
// histogram; peak = lowest k from 1 to the last bin with the largest P[k]; count = P[peak]; lean = P[peak+1] - P[peak-1]; sum =
// sum of all counts.
// Schedule: counts arrive at S2, bin by bin. After the last bin come at least two more addresses with past_s2_i, whose counts are
// ignored. A pair is registered before it enters the lean, so that no two adders are in series.
// If the next address has first_s2_i, too, the bin is a separate scan: peak_o then has its index and last_o its count in the next clock.
// Latency: the outputs are valid one clock after the second address with past_s2_i, until the next pixel's first bin.
// Cost: 5 COUNT_WIDTH + 2 BIN_WIDTH + 7 flip-flops, three adders, a comparator.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pair_detector #(
    parameter int BIN_WIDTH = 5,
    parameter int COUNT_WIDTH = 10,
    localparam int SUM_WIDTH = COUNT_WIDTH + BIN_WIDTH
) (
    input  logic                   clk_i,
    input  logic                   read_s2_i,
    input  logic                   first_s2_i,  // first bin of a pixel
    input  logic                   past_s2_i,   // the address is beyond the last bin
    input  logic [  BIN_WIDTH-1:0] bin_s2_i,
    input  logic [COUNT_WIDTH-1:0] count_s2_i,
    output logic [  BIN_WIDTH-1:0] peak_o,      // upper bin of the highest pair
    output logic [  COUNT_WIDTH:0] count_o,
    output logic signed [COUNT_WIDTH+1:0] lean_o,
    output logic [  SUM_WIDTH-1:0] sum_o,
    output logic                   first_o,     // the last address was a pixel's first bin
    output logic [COUNT_WIDTH-1:0] last_o       // count of the last address
);

  logic first_q, open_q, add_q, higher, take;
  logic [BIN_WIDTH-1:0] peak_q;
  logic [COUNT_WIDTH-1:0] last_q;
  logic [COUNT_WIDTH:0] pair, pair_q, highest_q;
  logic signed [COUNT_WIDTH+1:0] lean_q;
  logic [SUM_WIDTH-1:0] sum_q;

  // first_s2_i and past_s2_i come late from the broadcast, so they select after adder and comparator.
  assign pair = (COUNT_WIDTH + 1)'(last_q) + (COUNT_WIDTH + 1)'(count_s2_i);
  assign higher = first_q || (pair > highest_q);
  assign take = !first_s2_i && !past_s2_i && higher;

  always_ff @(posedge clk_i) begin
    if (read_s2_i) begin
      first_q <= first_s2_i;
      last_q <= count_s2_i;
      pair_q <= past_s2_i ? (COUNT_WIDTH + 1)'(last_q) : first_s2_i ? (COUNT_WIDTH + 1)'(count_s2_i) : pair;
      open_q <= take;
      add_q <= open_q && !take;
      if (!past_s2_i) begin
        sum_q <= first_s2_i ? SUM_WIDTH'(count_s2_i) : sum_q + SUM_WIDTH'(count_s2_i);
      end
      if (first_s2_i || take) begin
        peak_q <= bin_s2_i;
      end
      if (take) begin
        highest_q <= pair;
        lean_q <= -$signed({1'b0, pair_q});
      end else if (add_q) begin
        lean_q <= lean_q + $signed({1'b0, pair_q});
      end
    end
  end

  assign peak_o = peak_q;
  assign count_o = highest_q;
  assign lean_o = lean_q;
  assign sum_o = sum_q;
  assign first_o = first_q;
  assign last_o = last_q;

endmodule

`default_nettype wire
