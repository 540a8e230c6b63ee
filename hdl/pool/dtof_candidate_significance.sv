// SPDX-License-Identifier: Apache-2.0
// poolPointer, decode: significance of a candidate, 0 to 7: how far its pair sum stands out from the pair sums around it.
//
// Equation (docs/reference/poolpointer.md, Significance): S is the sum of the pair sums three and four pairs below and above
// the candidate's pair sum w. D = 4 w - S, V = S + S / 8 + 64, Z = (2 lg(D) - lg(V) - 36 - offset - 4 missing) / 4, limited to 0 to 7.
// Near an end of the range the two sums of the other side replace those that do not exist; near the lower end they are increased by
// an eighth, because the background is higher there in strong light.
//
// 1. While the decoder's ring turns, registers hold the two sums around the pair that reaches the head next.
// 2. When a pair is larger than all pairs before it in the turn, the sums around it are kept.
// 3. The first four clocks of the next turn compute S, then D and V, then the logarithms, then Z.
//
// Schedule: ahead_i and behind_i are valid in every clock, better_i in the clock of its pair at the head, new_peak_i in the first
// clock of a turn, together with pair_i and peak_i of the turn before. Latency: significance_o is valid for one clock, three clocks
// after new_peak_i.
// Cost: 11 adders, about 120 flip-flops, per engine.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_candidate_significance #(
    parameter int SUM_WIDTH = 11,  // bits of a pair sum
    parameter int KEPT_WIDTH = 3,  // bits of the significance that the group's word stores, 2 or 3
    localparam int OFFSET_WIDTH = dtof_pkg::POOL_SIGNIFICANCE_OFFSET_WIDTH
) (
    input  logic                    clk_i,
    input  logic                    active_i,
    input  logic [ 2*SUM_WIDTH-1:0] ahead_i,    // pair sums four and five pairs after the head
    input  logic [ 2*SUM_WIDTH-1:0] behind_i,   // pair sums two and three pairs before the head
    input  logic                    better_i,   // the pair at the head is the largest of the turn so far
    input  logic                    new_peak_i,
    input  logic [             4:0] pair_i,     // pair of the peak, + 1
    input  logic [   SUM_WIDTH-1:0] peak_i,     // pair sum of the peak
    input  logic [   SUM_WIDTH-1:0] raised_i,   // part of peak_i that comes from the last frame (PRIOR)
    input  logic [             2:0] missing_i,  // number of neighbours that the group lacks
    input  logic [OFFSET_WIDTH-1:0] offset_i,   // correction for long frames (dtof_significance_offset)
    output logic [  KEPT_WIDTH-1:0] significance_o
);

  localparam int TWO_WIDTH = SUM_WIDTH + 1;
  localparam int AROUND_WIDTH = SUM_WIDTH + 3;
  localparam int HEIGHT_WIDTH = SUM_WIDTH + 2;
  localparam int VARIANCE_WIDTH = AROUND_WIDTH + 1;
  localparam int HEIGHT_LOGARITHM_WIDTH = 3 + dtof_pkg::index_width(HEIGHT_WIDTH);
  localparam int VARIANCE_LOGARITHM_WIDTH = 3 + dtof_pkg::index_width(VARIANCE_WIDTH);
  localparam int SQUARE_WIDTH = 8;  // the subtracted terms are at most 127 + 36 + 31 + 16
  localparam logic [4:0] FIRST_WITH_LOW = 5'd5;
  localparam logic [4:0] LAST_WITH_HIGH = 5'd27;
  localparam int LEAST_VARIANCE = 64;
  localparam int SCALE = 36;  // D is four times the height, V twice its variance, and level 1 begins at 1.7 standard deviations

  logic [TWO_WIDTH-1:0] low_q, high_q, peak_low_q, peak_high_q;

  always_ff @(posedge clk_i) begin
    if (active_i) begin
      low_q <= TWO_WIDTH'(behind_i[SUM_WIDTH-1:0]) + TWO_WIDTH'(behind_i[SUM_WIDTH+:SUM_WIDTH]);
      high_q <= TWO_WIDTH'(ahead_i[SUM_WIDTH-1:0]) + TWO_WIDTH'(ahead_i[SUM_WIDTH+:SUM_WIDTH]);
      if (better_i) begin
        {peak_low_q, peak_high_q} <= {low_q, high_q};
      end
    end
  end

  // First clock of a turn: the sums around the peak.

  logic has_low, has_high;
  logic [AROUND_WIDTH-1:0] one, other, around_q;
  logic signed [HEIGHT_WIDTH:0] four_peaks_q;
  logic known_q, height_known_q;

  assign has_low = (pair_i >= FIRST_WITH_LOW);
  assign has_high = (pair_i <= LAST_WITH_HIGH);
  assign one = has_low ? AROUND_WIDTH'(peak_low_q) : {1'b0, peak_high_q, 1'b0};
  assign other = !has_low ? AROUND_WIDTH'(peak_high_q[TWO_WIDTH-1:2]) : !has_high ? AROUND_WIDTH'(peak_low_q) : AROUND_WIDTH'(peak_high_q);

  always_ff @(posedge clk_i) begin
    if (active_i) begin
      known_q <= new_peak_i;
      height_known_q <= known_q;
    end
    if (active_i && new_peak_i) begin
      around_q <= one + other;
      four_peaks_q <= ($signed({3'b000, peak_i}) - $signed({3'b000, raised_i})) <<< 2;
    end
  end

  // Second clock: D and V.

  logic signed [HEIGHT_WIDTH+1:0] height;
  logic [HEIGHT_WIDTH-1:0] height_q;
  logic [VARIANCE_WIDTH-1:0] variance_q;

  assign height = $signed({four_peaks_q[HEIGHT_WIDTH], four_peaks_q}) - $signed({1'b0, around_q});

  always_ff @(posedge clk_i) begin
    if (known_q) begin
      height_q <= (height < 0) ? '0 : height[HEIGHT_WIDTH-1:0];
      variance_q <= VARIANCE_WIDTH'(around_q) + VARIANCE_WIDTH'(around_q[AROUND_WIDTH-1:3]) + VARIANCE_WIDTH'(LEAST_VARIANCE);
    end
  end

  // Third clock: logarithms of D and V.

  logic [HEIGHT_LOGARITHM_WIDTH-1:0] height_logarithm, height_logarithm_q;
  logic [VARIANCE_LOGARITHM_WIDTH-1:0] variance_logarithm;
  logic [SQUARE_WIDTH-1:0] costs_q;
  logic above_q;

  dtof_eighth_octaves #(
      .WIDTH(HEIGHT_WIDTH)
  ) u_height (
      .x_i        (height_q),
      .logarithm_o(height_logarithm)
  );

  dtof_eighth_octaves #(
      .WIDTH(VARIANCE_WIDTH)
  ) u_variance (
      .x_i        (variance_q),
      .logarithm_o(variance_logarithm)
  );

  always_ff @(posedge clk_i) begin
    if (height_known_q) begin
      height_logarithm_q <= height_logarithm;
      costs_q <= SQUARE_WIDTH'(variance_logarithm) + SQUARE_WIDTH'(SCALE) + SQUARE_WIDTH'(offset_i)
          + SQUARE_WIDTH'({missing_i, 2'b00});
      above_q <= (height_q != '0);
    end
  end

  // Fourth clock: Z.

  logic signed [SQUARE_WIDTH:0] square;
  logic [2:0] significance;

  assign square = $signed({{(SQUARE_WIDTH - HEIGHT_LOGARITHM_WIDTH) {1'b0}}, height_logarithm_q, 1'b0})
      - $signed({1'b0, costs_q});
  assign significance = (!above_q || square < 0) ? 3'd0 : (square > 31) ? 3'd7 : square[4:2];

  // Two bits store pairs of levels: 0 to 2 become 0, 3 and 4 become 1, 5 and 6 become 2, 7 becomes 3.
  assign significance_o = (KEPT_WIDTH == 3) ? KEPT_WIDTH'(significance)
      : (significance == 3'd0) ? '0 : KEPT_WIDTH'((significance - 3'd1) >> 1);

  logic unused;
  assign unused = ^{height[HEIGHT_WIDTH+1:HEIGHT_WIDTH], square};

endmodule

`default_nettype wire
