// SPDX-License-Identifier: Apache-2.0
// Reference of poolPointer's decode (docs/reference/poolpointer.md, "Decode", "Significance", "Prior from the last frame") for an array of
// one group, whose four neighbours are missing, and without a template. In signed integers of W bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_decode_reference #(
    parameter int W = 18,
    parameter int LABELS = 5,
    parameter int COUNT_WIDTH = 7,
    parameter int ACQUISITIONS = 3,
    parameter int STORED_BITS = 2  // bits of the significance that the group's word stores, 2 or 3
) (
    input  logic [32*8-1:0]      counts_i,       // H
    input  logic [LABELS-1:0]    used_i,         // candidates of the last frame that were used; 0 without a prior
    input  logic [LABELS*W-1:0] used_cells_i,
    output logic [LABELS*W-1:0] cells_o,
    output logic [LABELS*W-1:0] significance_o,  // as stored
    output logic [W-1:0]          background_o,    // B
    output logic                 tilted_o
);

  localparam int PAIRS = 31;

  logic [W-1:0] octet, first_octet, emptiest;
  integer o, n;

  always_comb begin
    emptiest = 32'hffff;
    first_octet = 32'd0;
    for (o = 0; o < 4; o = o + 1) begin
      octet = 32'd0;
      for (n = 0; n < 8; n = n + 1) octet = octet + W'(counts_i[8*(8*o+n)+:8]);
      if (octet < emptiest) emptiest = octet;
      if (o == 0) first_octet = octet;
    end
    background_o = ((emptiest << 2) + emptiest) >> COUNT_WIDTH;
    tilted_o = (first_octet << 1) > ((emptiest << 1) + emptiest + 32'd32);
  end

  logic [PAIRS*W-1:0] w;
  logic [PAIRS-1:0] raised;
  logic [W-1:0] lowest, both;
  logic signed [W-1:0] from;
  integer i, u;

  always_comb begin
    lowest = 32'hffff;
    for (i = 0; i < PAIRS; i = i + 1) begin
      raised[i] = 1'b0;
      for (u = 0; u < LABELS; u = u + 1) begin
        from = used_cells_i[W*u+:W] - 32'(4 * (i + 1));
        if (used_i[u] && from >= -2 && from <= 2) raised[i] = 1'b1;
      end
      // Seven times: OWN_WEIGHT and the four neighbours, each of which is the group itself.
      both = W'(counts_i[8*i+:8]) + W'(counts_i[8*(i+1)+:8]);
      w[W*i+:W] = (both << 3) - both + (raised[i] ? 32'd28 : 32'd0);
      if (w[W*i+:W] < lowest) lowest = w[W*i+:W];
    end
  end

  // Sums and taken pairs when a candidate is chosen; sums one candidate earlier.
  logic [(LABELS+1)*PAIRS*W-1:0] sums;
  logic [(LABELS+1)*PAIRS-1:0] taken;
  assign sums[0+:PAIRS*W] = w;
  assign taken[0+:PAIRS] = '0;

  genvar k;
  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_candidate
      localparam int EARLIER = (k == 0) ? 0 : k - 1;
      pool_candidate_reference #(
          .ACQUISITIONS(ACQUISITIONS),
          .MISSING     (4),
          .STORED_BITS (STORED_BITS)
      ) u_candidate (
          .w_i           (sums[k*PAIRS*W+:PAIRS*W]),
          .w_before_i    (sums[EARLIER*PAIRS*W+:PAIRS*W]),
          .taken_i       (taken[k*PAIRS+:PAIRS]),
          .raised_i      (raised),
          .lowest_i      (lowest),
          .w_o           (sums[(k+1)*PAIRS*W+:PAIRS*W]),
          .taken_o       (taken[(k+1)*PAIRS+:PAIRS]),
          .cell_o        (cells_o[W*k+:W]),
          .significance_o(significance_o[W*k+:W])
      );
    end
  endgenerate

endmodule

`default_nettype wire
