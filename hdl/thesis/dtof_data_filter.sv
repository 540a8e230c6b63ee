// SPDX-License-Identifier: Apache-2.0
// Selects the timestamps that a histogram counts, and their bins (thesis Fig. 4.7, "data filter"). Combinational.
//
// Equations, with the timestamp x and the coarse peak P of its pixel:
// Coarse pass (all read-outs but three steps and PiFH): bin = x >> (NP-NB).
// SiFH, final pass (Eq. 2.4 to 2.7): start = (P << (NP-NB)) - 2^(NB-1) + 1 (+ 2^(NP-NB-1) - 1 if WINDOW_CENTRED), signed;
//   x is kept if 0 <= x - start < 2^NB, bin = x - start.
// FiFH, final pass: x is kept if x >> (NP-NB) = P, bin = the low NP-NB bits.
// Three steps: a coarse pass keeps x if its high bits are the peaks so far, bin = the next three bits. The final pass keeps 16
//   codes from start = (P << s) + (2^s >> 1) - 8, s = the number of undecided low bits.
// PiFH: x is kept if x >> NB = pass, bin = the low NB bits. Histogram: bin = x.
// Latency: none. Cost: one subtractor or comparator.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_data_filter #(
    parameter int READOUT = dtof_pkg::READOUT_SIFH,
    parameter int NP = 10,
    parameter int NB = 6,
    parameter int WINDOW_CENTRED = 0,
    localparam int BIN_WIDTH = dtof_pkg::bin_width(READOUT, NP, NB),
    localparam int PEAK_WIDTH = dtof_pkg::peak_width(READOUT, NP, NB),
    localparam int PASS_WIDTH = dtof_pkg::index_width(dtof_pkg::coarse_passes(READOUT, NP, NB) + 1)
) (
    input  logic [        NP-1:0] timestamp_i,   // a detection
    input  logic [PEAK_WIDTH-1:0] peak_i,        // the pixel's coarse peak so far
    input  logic [PASS_WIDTH-1:0] pass_i,
    input  logic                  final_pass_i,
    output logic                  keep_o,
    output logic [ BIN_WIDTH-1:0] bin_o,
    output logic signed [NP+1:0]  start_o        // code of bin 0 in the final pass
);

  localparam int COARSE_SHIFT = NP - NB;
  localparam int SIDE_BAND = 1 << (NB - 1);
  localparam int CENTRE = (WINDOW_CENTRED != 0 && NP > NB) ? (1 << (NP - NB - 1)) - 1 : 0;

  generate
    if (READOUT == dtof_pkg::READOUT_SIFH) begin : g_sifh
      logic signed [NP+1:0] offset;
      assign start_o = $signed((NP + 2)'(peak_i) << COARSE_SHIFT) + $signed((NP + 2)'(CENTRE + 1 - SIDE_BAND));
      assign offset = $signed({2'b00, timestamp_i}) - start_o;
      assign keep_o = !final_pass_i || (offset[NP+1:NB] == '0);
      assign bin_o = final_pass_i ? offset[NB-1:0] : timestamp_i[NP-1-:NB];
    end else if (READOUT == dtof_pkg::READOUT_FIFH) begin : g_fifh
      assign start_o = $signed((NP + 2)'(peak_i) << COARSE_SHIFT);
      assign keep_o = !final_pass_i || (timestamp_i[NP-1-:NB] == peak_i);
      assign bin_o = final_pass_i ? BIN_WIDTH'(timestamp_i & NP'((1 << COARSE_SHIFT) - 1))
          : BIN_WIDTH'(timestamp_i >> COARSE_SHIFT);
    end else if (READOUT == dtof_pkg::READOUT_THREESTEPS) begin : g_threesteps
      localparam int S0 = dtof_pkg::step_shift(NP, 0);
      localparam int S1 = dtof_pkg::step_shift(NP, 1);
      localparam int S2 = dtof_pkg::step_shift(NP, 2);
      logic signed [NP+1:0] offset;
      localparam int WIDE = dtof_pkg::max_of(NP, 4);  // a bin index has 4 bits, even for NP = 3
      logic [WIDE-1:0] code, peak;
      assign code = WIDE'(timestamp_i);
      assign peak = WIDE'(peak_i);
      assign start_o = $signed((NP + 2)'(peak_i) << S2) + $signed((NP + 2)'(((1 << S2) >> 1) - 8));
      assign offset = $signed({2'b00, timestamp_i}) - start_o;
      always_comb begin
        case (pass_i)
          2'd0: begin
            keep_o = 1'b1;
            bin_o = BIN_WIDTH'(code >> S0);
          end
          2'd1: begin
            keep_o = ((code >> S0) == peak);
            bin_o = BIN_WIDTH'((code >> S1) & WIDE'((1 << (S0 - S1)) - 1));
          end
          2'd2: begin
            keep_o = ((code >> S1) == peak);
            bin_o = BIN_WIDTH'((code >> S2) & WIDE'((1 << (S1 - S2)) - 1));
          end
          default: begin
            keep_o = ((offset >>> 4) == '0);
            bin_o = BIN_WIDTH'(offset);
          end
        endcase
      end
    end else if (READOUT == dtof_pkg::READOUT_PIFH && NP > NB) begin : g_pifh
      assign keep_o = (timestamp_i[NP-1:NB] == pass_i);
      assign bin_o = timestamp_i[NB-1:0];
      assign start_o = '0;
    end else begin : g_coarse
      logic unused_low_bits;
      assign unused_low_bits = ^timestamp_i;
      assign keep_o = 1'b1;
      assign bin_o = timestamp_i[NP-1-:BIN_WIDTH];
      assign start_o = '0;
    end
  endgenerate

endmodule

`default_nettype wire
