// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_data_filter: the timestamps that each read-out counts, and their bins, follow docs/reference/readouts.md, computed in
// 32-bit integers.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module data_filter_properties #(
    parameter int READOUT = 3,
    parameter int NP = 10,
    parameter int NB = 6,
    parameter int WINDOW_CENTRED = 0,
    localparam int COARSE_PASSES = dtof_pkg::coarse_passes(READOUT, NP, NB),
    localparam int BIN_WIDTH = dtof_pkg::bin_width(READOUT, NP, NB),
    localparam int PEAK_WIDTH = dtof_pkg::peak_width(READOUT, NP, NB),
    localparam int PASS_WIDTH = dtof_pkg::index_width(COARSE_PASSES + 1)
) (
    input logic                  clk_i,
    input logic [        NP-1:0] timestamp_i,
    input logic [PEAK_WIDTH-1:0] peak_i,
    input logic [PASS_WIDTH-1:0] pass_i
);

  logic checking;
  assign checking = 1'b1;

  logic final_pass, keep;
  logic [BIN_WIDTH-1:0] bin;
  logic signed [NP+1:0] start;

  assign final_pass = (32'(pass_i) == COARSE_PASSES);

  dtof_data_filter #(
      .READOUT       (READOUT),
      .NP            (NP),
      .NB            (NB),
      .WINDOW_CENTRED(WINDOW_CENTRED)
  ) u_dut (
      .timestamp_i (timestamp_i),
      .peak_i      (peak_i),
      .pass_i      (pass_i),
      .final_pass_i(final_pass),
      .keep_o      (keep),
      .bin_o       (bin),
      .start_o     (start)
  );

  // s(-1) and s(k) of three steps.
  localparam int S_BEFORE = NP;
  localparam int S0 = (NP > 3) ? NP - 3 : 0;
  localparam int S1 = (NP > 6) ? NP - 6 : 0;
  localparam int S2 = (NP > 9) ? NP - 9 : 0;

  integer x, peak, pass, before, after, prefix, lowest, expected_bin, expected_start;
  logic expected_keep, has_start;

  always_comb begin
    x = 32'(timestamp_i);
    peak = 32'(peak_i);
    pass = 32'(pass_i);
    before = 0;
    after = 0;
    prefix = 0;
    lowest = 0;
    expected_keep = 1'b1;
    expected_bin = x >>> (NP - BIN_WIDTH);
    expected_start = 0;
    has_start = 1'b0;
    case (READOUT)
      dtof_pkg::READOUT_SIFH:
      if (final_pass) begin  // lowest is TH- of Eq. 2.4
        lowest = peak * (1 << (NP - NB)) - (1 << (NB - 1));
        if (WINDOW_CENTRED != 0 && NP > NB) lowest = lowest + (1 << (NP - NB - 1)) - 1;
        expected_keep = (lowest < x) && (x <= lowest + (1 << NB));
        expected_bin = x - lowest - 1;
        expected_start = lowest + 1;
        has_start = 1'b1;
      end else begin
        expected_bin = x >>> (NP - NB);
      end
      dtof_pkg::READOUT_FIFH:
      if (final_pass) begin
        expected_keep = (x >>> (NP - NB)) == peak;
        expected_bin = x & ((1 << (NP - NB)) - 1);
        expected_start = peak * (1 << (NP - NB));
        has_start = 1'b1;
      end else begin
        expected_bin = x >>> (NP - NB);
      end
      dtof_pkg::READOUT_THREESTEPS:
      if (final_pass) begin
        lowest = peak * (1 << S2) + (1 << S2) / 2 - 8;
        expected_keep = (lowest <= x) && (x < lowest + 16);
        expected_bin = x - lowest;
        expected_start = lowest;
        has_start = 1'b1;
      end else begin
        before = (pass == 0) ? S_BEFORE : (pass == 1) ? S0 : S1;
        after = (pass == 0) ? S0 : (pass == 1) ? S1 : S2;
        prefix = (pass == 0) ? 0 : peak;  // the first step has no prefix yet
        expected_keep = (x >>> before) == prefix;
        expected_bin = (x >>> after) - (prefix << (before - after));
      end
      dtof_pkg::READOUT_PIFH: begin
        expected_keep = (x >>> NB) == pass;
        expected_bin = x & ((1 << NB) - 1);
      end
      dtof_pkg::READOUT_HISTOGRAM: expected_bin = x;
      default: expected_bin = x >>> (NP - NB);  // measurement 1 of hisPointer
    endcase
  end

  `ASSUME(m_pass, 32'(pass_i) <= COARSE_PASSES)
  `PROVE(a_keep, keep == expected_keep)
  `PROVE(a_bin, !keep || 32'(bin) == expected_bin)
  `PROVE(a_start, !has_start || 32'(start) == expected_start)
  `GOAL(keep && final_pass)

endmodule

`default_nettype wire
