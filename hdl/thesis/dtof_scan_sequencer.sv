// SPDX-License-Identifier: Apache-2.0
// Walks the histogram of every pixel, one address per clock, for clearing (RESET) and peak search (M1, M4),
// once per array. In M1 each address is cleared one clock after its read; in M4 it is not.
//
// With RAW_BINS > 0, raw_i changes M4: one address per start, bin by bin, of the pixels raw_first_i to raw_last_i only, so that a
// bin's count takes the place of a peak.
//
// Schedule of one address: S0 read, S1 data registered by the column and address cleared, S2 peak search,
// S3 (after a pixel's last bin) the peak is final.
// Latency: one clock per address and 3 more; RESET clears only. In M4 the scan stops after one pixel. It holds the pixel's last
// bin until the results of the row before have left the result chain (at least one clock).
// Cost: two counters and their copies per stage, per array.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_scan_sequencer #(
    parameter int PIXELS_PER_SRAM = 160,
    parameter int BIN_WIDTH = 5,   // log2 of the addresses of a pixel
    parameter int RESET_BINS = 32,  // addresses of a pixel to clear in RESET
    parameter int FINAL_BINS = 32,  // addresses of a pixel to read in M4
    parameter int SKIP_RESET = 0,   // 1: RESET clears without a walk (signalled clear)
    parameter int RAW_BINS = 0,     // addresses of a pixel to read in M4 with raw_i; 0: raw_i has no effect
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM)
) (
    input  logic                 clk_i,
    input  logic                 rst_ni,
    input  logic                 start_i,
    input  logic                 reset_state_i,  // with start_i: clear only, all pixels
    input  logic                 final_state_i,  // with start_i: one pixel, FINAL_BINS addresses
    input  logic                 hold_i,         // the result chain is in use
    input  logic                 raw_i,          // raw_i, raw_first_i and raw_last_i are stable during a frame
    input  logic [ROW_WIDTH-1:0] raw_first_i,
    input  logic [ROW_WIDTH-1:0] raw_last_i,
    output logic                 busy_o,
    output logic [ROW_WIDTH-1:0] row_o,          // pixel that was just scanned
    output logic                 last_row_o,     // that pixel was the last; with raw_i also its last bin
    output logic                 read_s0_o,
    output logic                 last_s0_o,
    output logic [ROW_WIDTH-1:0] pixel_s0_o,
    output logic [BIN_WIDTH-1:0] bin_s0_o,
    output logic                 clear_s1_o,
    output logic [ROW_WIDTH-1:0] pixel_s1_o,
    output logic [BIN_WIDTH-1:0] bin_s1_o,
    output logic                 read_s2_o,
    output logic                 first_s2_o,
    output logic [BIN_WIDTH-1:0] bin_s2_o,
    output logic                 last_s3_o,
    output logic [ROW_WIDTH-1:0] pixel_s3_o
);

  localparam logic [ROW_WIDTH-1:0] LAST_PIXEL = ROW_WIDTH'(PIXELS_PER_SRAM - 1);
  localparam logic [BIN_WIDTH-1:0] LAST_BIN_ALL = {BIN_WIDTH{1'b1}};
  localparam logic [BIN_WIDTH-1:0] LAST_BIN_RESET = BIN_WIDTH'(RESET_BINS - 1);
  localparam logic [BIN_WIDTH-1:0] LAST_BIN_FINAL = BIN_WIDTH'(FINAL_BINS - 1);

  localparam logic [BIN_WIDTH-1:0] BEFORE_LAST_FINAL = BIN_WIDTH'(FINAL_BINS - 2);
  localparam logic ONE_FINAL_BIN = (FINAL_BINS == 1);

  logic run_q, hold_q, reset_q, final_q, last_row_q;
  logic [ROW_WIDTH-1:0] pixel_q, row_q;
  logic [BIN_WIDTH-1:0] bin_q, last_bin;
  logic last, one_address;

  // Raw histogram: its present address, and whether it ends with this bin.
  logic raw, raw_start, raw_ends;
  logic [BIN_WIDTH-1:0] raw_bin;
  logic [ROW_WIDTH-1:0] pixel;

  generate
    if (RAW_BINS > 0) begin : g_raw
      localparam logic [BIN_WIDTH-1:0] LAST_RAW_BIN = BIN_WIDTH'(RAW_BINS - 1);
      logic raw_q, last_raw_bin;
      logic [BIN_WIDTH-1:0] raw_bin_q;
      logic [ROW_WIDTH-1:0] raw_pixel_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          raw_q <= 1'b0;
          raw_bin_q <= '0;
          raw_pixel_q <= '0;
        end else if (start_i) begin
          raw_q <= raw_start;
          if (raw_start && !raw_q) begin
            raw_pixel_q <= raw_first_i;
          end
        end else if (run_q && raw_q) begin
          raw_bin_q <= last_raw_bin ? '0 : raw_bin_q + 1'b1;
          if (last_raw_bin) begin
            raw_pixel_q <= raw_pixel_q + 1'b1;
          end
        end
      end
      assign raw = raw_q;
      assign raw_bin = raw_bin_q;
      assign raw_start = raw_i && final_state_i;
      assign last_raw_bin = (raw_bin_q == LAST_RAW_BIN);
      assign raw_ends = last_raw_bin && (raw_pixel_q == raw_last_i);
      assign pixel = raw_q ? raw_pixel_q : pixel_q;
    end else begin : g_no_raw
      logic unused_raw;
      assign unused_raw = ^{raw_i, raw_first_i, raw_last_i};
      assign raw = 1'b0;
      assign raw_bin = '0;
      assign raw_start = 1'b0;
      assign raw_ends = 1'b0;
      assign pixel = pixel_q;
    end
  endgenerate

  assign one_address = (ONE_FINAL_BIN && final_state_i) || raw_start;
  assign last_bin = reset_q ? LAST_BIN_RESET : (final_q ? LAST_BIN_FINAL : LAST_BIN_ALL);
  assign last = (bin_q == last_bin) || raw;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      run_q <= 1'b0;
      hold_q <= 1'b0;
      reset_q <= 1'b0;
      final_q <= 1'b0;
      last_row_q <= 1'b0;
      pixel_q <= '0;
      row_q <= '0;
      bin_q <= '0;
    end else if (start_i) begin
      run_q <= !(SKIP_RESET != 0 && reset_state_i) && !one_address;
      hold_q <= one_address;
      reset_q <= reset_state_i;
      final_q <= final_state_i;
      bin_q <= raw_start ? raw_bin : '0;
    end else if (hold_q) begin
      run_q <= !hold_i;
      hold_q <= hold_i;
    end else if (run_q) begin
      bin_q <= last ? '0 : bin_q + 1'b1;
      if (last) begin
        row_q <= pixel;
        last_row_q <= raw ? raw_ends : (pixel_q == LAST_PIXEL);
        pixel_q <= raw ? pixel_q : (pixel_q == LAST_PIXEL) ? '0 : pixel_q + 1'b1;
        run_q <= !final_q && (pixel_q != LAST_PIXEL);
      end else if (final_q && bin_q == BEFORE_LAST_FINAL) begin
        run_q <= 1'b0;
        hold_q <= 1'b1;
      end
    end
  end

  logic [3:1] read_sn_q;
  logic [3:1] last_sn_q;
  logic clear_s1_q, first_s1_q, first_s2_q;
  logic [ROW_WIDTH-1:0] pixel_s1_q, pixel_s2_q, pixel_s3_q;
  logic [BIN_WIDTH-1:0] bin_s1_q, bin_s2_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      read_sn_q <= '0;
      last_sn_q <= '0;
      clear_s1_q <= 1'b0;
    end else begin
      read_sn_q <= {read_sn_q[2:1], run_q && !reset_q};
      last_sn_q <= {last_sn_q[2:1], run_q && !reset_q && last};
      clear_s1_q <= run_q && !final_q;
    end
  end

  always_ff @(posedge clk_i) begin
    first_s1_q <= (bin_q == '0) || raw;
    first_s2_q <= first_s1_q;
    pixel_s1_q <= pixel;
    pixel_s2_q <= pixel_s1_q;
    pixel_s3_q <= pixel_s2_q;
    bin_s1_q <= bin_q;
    bin_s2_q <= bin_s1_q;
  end

  assign busy_o = run_q || hold_q || clear_s1_q || (read_sn_q != '0);
  assign row_o = row_q;
  assign last_row_o = last_row_q;
  assign read_s0_o = run_q && !reset_q;
  assign last_s0_o = run_q && !reset_q && last;
  assign pixel_s0_o = pixel;
  assign bin_s0_o = bin_q;
  assign clear_s1_o = clear_s1_q;
  assign pixel_s1_o = pixel_s1_q;
  assign bin_s1_o = bin_s1_q;
  assign read_s2_o = read_sn_q[2];
  assign first_s2_o = first_s2_q;
  assign bin_s2_o = bin_s2_q;
  assign last_s3_o = last_sn_q[3];
  assign pixel_s3_o = pixel_s3_q;

endmodule

`default_nettype wire
