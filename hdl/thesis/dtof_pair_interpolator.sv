// SPDX-License-Identifier: Apache-2.0
// Position of a pulse between two bins, from the highest pair of bins: the pulse's lean to one side over its height, in units of two
// thirds of a bin.
//
// Equation (docs/reference/readouts.md, coarsehistogram): height = count - ((sum - count) >> (BIN_WIDTH - 1)), the pair minus the
// mean of the other pairs. The mean is less than the highest pair, so height is 0 for an empty histogram only.
// offset = floor(2^PLACE_WIDTH 2 min(|lean|, height) / (3 height)), 0 if height is 0. If lean is not negative, place_o is offset;
// otherwise lower_o is high and place_o is the complement of offset, because the pulse is in the bin below the edge. So
// {bin, place} is the position edge + offset, or edge - 1 - offset.
// Why two thirds: for a Gaussian pulse with a width (FWHM) of 1.4 bins, lean over height is 3/2 of the distance from the
// pair's middle, accurate to a hundredth of a bin, within half a bin on either side.
// Schedule: settle_i, when the pair is known: height and |lean|. begin_i: the dividend. divide_i in PLACE_WIDTH clocks: one bit
// per clock, the highest bit first. The clocks need not be consecutive.
// Latency: the outputs are valid one clock after the last divide_i.
// Cost: 2 COUNT_WIDTH + PLACE_WIDTH + 5 flip-flops, six adders or comparators.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pair_interpolator #(
    parameter int BIN_WIDTH = 5,
    parameter int COUNT_WIDTH = 10,
    parameter int PLACE_WIDTH = 7,  // bits of a place within a bin; 0: the position is the bin
    localparam int SUM_WIDTH = COUNT_WIDTH + BIN_WIDTH,
    localparam int PLACE_BITS = dtof_pkg::max_of(PLACE_WIDTH, 1)
) (
    input  logic                          clk_i,
    input  logic                          settle_i,
    input  logic                          begin_i,
    input  logic                          divide_i,
    input  logic        [  COUNT_WIDTH:0] count_i,
    input  logic signed [COUNT_WIDTH+1:0] lean_i,
    input  logic        [  SUM_WIDTH-1:0] sum_i,
    output logic                          lower_o,
    output logic        [ PLACE_BITS-1:0] place_o,
    output logic        [COUNT_WIDTH-1:0] confidence_o  // height, limited to COUNT_WIDTH bits
);

  localparam int DIVISOR_WIDTH = COUNT_WIDTH + 3;

  logic [COUNT_WIDTH:0] mean_of_rest, height_q;
  logic lower_q;

  assign mean_of_rest = (COUNT_WIDTH + 1)'((sum_i - SUM_WIDTH'(count_i)) >> (BIN_WIDTH - 1));

  always_ff @(posedge clk_i) begin
    if (settle_i) begin
      height_q <= count_i - mean_of_rest;
      lower_q <= lean_i[COUNT_WIDTH+1];
    end
  end

  assign lower_o = lower_q;
  assign confidence_o = height_q[COUNT_WIDTH] ? '1 : height_q[COUNT_WIDTH-1:0];

  generate
    if (PLACE_WIDTH > 0) begin : g_divide
      logic [COUNT_WIDTH:0] lean;
      logic [DIVISOR_WIDTH-1:0] divisor, remainder_q;
      logic [DIVISOR_WIDTH:0] doubled, difference;
      logic fits;
      logic [PLACE_WIDTH-1:0] place_q;

      assign lean = lean_i[COUNT_WIDTH+1] ? (COUNT_WIDTH + 1)'(-lean_i) : (COUNT_WIDTH + 1)'(lean_i);
      assign divisor = DIVISOR_WIDTH'(height_q) + DIVISOR_WIDTH'({height_q, 1'b0});
      assign doubled = {remainder_q, 1'b0};
      assign difference = doubled - {1'b0, divisor};
      assign fits = !difference[DIVISOR_WIDTH] && (height_q != '0);

      // The bits of the place follow each other into place_q, as they are or complemented.
      always_ff @(posedge clk_i) begin
        if (settle_i) begin
          remainder_q <= DIVISOR_WIDTH'({lean, 1'b0});
        end else if (begin_i) begin
          if (remainder_q > DIVISOR_WIDTH'({height_q, 1'b0})) begin
            remainder_q <= DIVISOR_WIDTH'({height_q, 1'b0});
          end
        end else if (divide_i) begin
          remainder_q <= fits ? DIVISOR_WIDTH'(difference) : DIVISOR_WIDTH'(doubled);
        end
        if (divide_i) begin
          place_q <= PLACE_WIDTH'({place_q, fits ^ lower_q});
        end
      end

      assign place_o = place_q;
    end else begin : g_bin_is_place
      logic unused_steps;
      assign unused_steps = ^{begin_i, divide_i, lean_i};
      assign place_o = '0;
    end
  endgenerate

endmodule

`default_nettype wire
