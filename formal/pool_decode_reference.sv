// SPDX-License-Identifier: Apache-2.0
// Reference of poolPointer's decode (docs/reference/poolpointer.md, "Decode", "Significance", "Prior from the last frame") for an array of
// one group, whose four neighbours are missing, and without a template. In 32-bit integers.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_decode_reference #(
    parameter int LABELS = 5,
    parameter int COUNT_WIDTH = 7,
    parameter int ACQUISITIONS = 3,
    parameter int STORED_BITS = 2  // bits of the significance that the group's word stores, 2 or 3
) (
    input  logic [32*8-1:0]      counts_i,       // H
    input  logic [LABELS-1:0]    used_i,         // candidates of the last frame that were used; 0 without a prior
    input  logic [LABELS*32-1:0] used_cells_i,
    output logic [LABELS*32-1:0] cells_o,
    output logic [LABELS*32-1:0] significance_o,  // as stored
    output logic [31:0]          background_o,    // B
    output logic                 tilted_o
);

  localparam int PAIRS = 31;

  logic [31:0] octet, first_octet, emptiest;
  integer o, n;

  always_comb begin
    emptiest = 32'hffff;
    first_octet = 32'd0;
    for (o = 0; o < 4; o = o + 1) begin
      octet = 32'd0;
      for (n = 0; n < 8; n = n + 1) octet = octet + 32'(counts_i[8*(8*o+n)+:8]);
      if (octet < emptiest) emptiest = octet;
      if (o == 0) first_octet = octet;
    end
    background_o = ((emptiest << 2) + emptiest) >> COUNT_WIDTH;
    tilted_o = (first_octet << 1) > ((emptiest << 1) + emptiest + 32'd32);
  end

  logic [PAIRS*32-1:0] w;
  logic [PAIRS-1:0] raised;
  logic [31:0] lowest, both;
  logic signed [31:0] from;
  integer i, u;

  always_comb begin
    lowest = 32'hffff;
    for (i = 0; i < PAIRS; i = i + 1) begin
      raised[i] = 1'b0;
      for (u = 0; u < LABELS; u = u + 1) begin
        from = used_cells_i[32*u+:32] - 32'(4 * (i + 1));
        if (used_i[u] && from >= -2 && from <= 2) raised[i] = 1'b1;
      end
      // Seven times: OWN_WEIGHT and the four neighbours, each of which is the group itself.
      both = 32'(counts_i[8*i+:8]) + 32'(counts_i[8*(i+1)+:8]);
      w[32*i+:32] = (both << 3) - both + (raised[i] ? 32'd28 : 32'd0);
      if (w[32*i+:32] < lowest) lowest = w[32*i+:32];
    end
  end

  // Sums and taken pairs when a candidate is chosen; sums one candidate earlier.
  logic [(LABELS+1)*PAIRS*32-1:0] sums;
  logic [(LABELS+1)*PAIRS-1:0] taken;
  assign sums[0+:PAIRS*32] = w;
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
          .w_i           (sums[k*PAIRS*32+:PAIRS*32]),
          .w_before_i    (sums[EARLIER*PAIRS*32+:PAIRS*32]),
          .taken_i       (taken[k*PAIRS+:PAIRS]),
          .raised_i      (raised),
          .lowest_i      (lowest),
          .w_o           (sums[(k+1)*PAIRS*32+:PAIRS*32]),
          .taken_o       (taken[(k+1)*PAIRS+:PAIRS]),
          .cell_o        (cells_o[32*k+:32]),
          .significance_o(significance_o[32*k+:32])
      );
    end
  endgenerate

endmodule

`default_nettype wire
