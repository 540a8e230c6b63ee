// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_histogram_builder, driven by dtof_pixel_sequencer: it is a memory of counters. With FREEZE = 1 the first full counter of
// a pixel ends the pixel's counting, with FREEZE = 0 full counters stay full. The harness follows all bins of one arbitrary pixel
// through passes, scans and clears, and counts pixels and timestamps from the handshake alone.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module histogram_builder_properties #(
    parameter int PIXELS = 2,
    parameter int SLOTS = 2,
    parameter int SIGNALLED_CLEAR = 0,
    parameter int BIN_WIDTH = 1,
    parameter int COUNT_WIDTH = 2,
    parameter int FREEZE = 1,
    localparam int BINS = 1 << BIN_WIDTH,
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS),
    localparam int SLOT_WIDTH = dtof_pkg::index_width(SLOTS)
) (
    input logic                 clk_i,
    input logic                 begin_i,       // a pass begins
    input logic                 more_i,        // at the end of an acquisition and at the begin of a pass: another acquisition follows
    input logic                 tdc_valid_i,
    input logic                 keep_i,        // the data filter keeps the timestamp
    input logic [BIN_WIDTH-1:0] bin_i,
    input logic                 scan_i,
    input logic [ROW_WIDTH-1:0] scan_pixel_i,
    input logic [BIN_WIDTH-1:0] scan_bin_i,
    input logic                 clear_i,
    input logic [ROW_WIDTH-1:0] clear_pixel_i,
    input logic [BIN_WIDTH-1:0] clear_bin_i,
    input logic                 clear_all_i
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  // A pass ends as soon as it is idle, as in dtof_controller; scans and clears come between passes. A pass begins with known counts. If
  // one of them is full, its pixel is frozen, because clear_all_i comes with the clear of all bins.
  logic stream_q, more_q, ready, acq_done, idle, accepted, prepared;
  logic [2:0] quiet_q;
  logic fetch, beat_t1, first_slot, visit, first_acq, last_slot, beat_t5;
  logic [ROW_WIDTH-1:0] fetch_pixel, pixel_t2, pixel_t5;
  logic [3:1] same_pixel;
  logic [COUNT_WIDTH-1:0] count;
  logic full_t5;

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      stream_q <= 1'b0;
      more_q <= 1'b0;
      quiet_q <= '0;
    end else begin
      stream_q <= stream_q ? !idle : begin_i && prepared && (&quiet_q) && !scan_i && !clear_i;
      quiet_q <= {quiet_q[1:0], !scan_i && !clear_i && !clear_all_i};
      if (!stream_q || acq_done) begin
        more_q <= more_i;
      end
    end
  end

  dtof_pixel_sequencer #(
      .PIXELS_PER_SRAM(PIXELS),
      .SLOTS          (SLOTS)
  ) u_pixel_sequencer (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .stream_i       (stream_q),
      .more_i         (more_q),
      .tdc_valid_i    (tdc_valid_i),
      .tdc_ready_o    (ready),
      .acq_done_o     (acq_done),
      .idle_o         (idle),
      .fetch_o        (fetch),
      .fetch_pixel_o  (fetch_pixel),
      .beat_t1_o      (beat_t1),
      .first_slot_t0_o(first_slot),
      .visit_t1_o     (visit),
      .first_acq_t1_o (first_acq),
      .last_slot_t2_o (last_slot),
      .pixel_t2_o     (pixel_t2),
      .same_pixel_t3_o(same_pixel),
      .beat_t5_o      (beat_t5),
      .pixel_t5_o     (pixel_t5)
  );

  dtof_histogram_builder #(
      .PIXELS_PER_SRAM(PIXELS),
      .BIN_WIDTH      (BIN_WIDTH),
      .SLOTS          (SLOTS),
      .COUNT_WIDTH    (COUNT_WIDTH),
      .FREEZE         (FREEZE),
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR)
  ) u_dut (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .hit_t1_i       (beat_t1 && keep_i),
      .bin_t1_i       (bin_i),
      .same_pixel_t3_i(same_pixel),
      .beat_t5_i      (beat_t5),
      .scan_s0_i      (scan_i),
      .scan_bin_s0_i  (scan_bin_i),
      .read_pixel_i   (scan_i ? scan_pixel_i : pixel_t2),
      .clear_s1_i     (clear_i),
      .clear_bin_s1_i (clear_bin_i),
      .write_pixel_i  (clear_i ? clear_pixel_i : pixel_t5),
      .clear_all_i    (clear_all_i),
      .count_s2_o     (count),
      .full_t5_o      (full_t5)
  );

  // Reference: the counters of one pixel. They count a timestamp at T5, when the module writes its count.
  (* anyconst *) logic [ROW_WIDTH-1:0] watched_pixel;
  (* anyconst *) logic [BIN_WIDTH-1:0] watched_bin;
  logic [ROW_WIDTH-1:0] pixel_q;  // pixel of the next timestamp
  logic [SLOT_WIDTH-1:0] slot_q;
  logic accepted_q, watched_t1_q, scanned_q, check_q;
  logic [COUNT_WIDTH-1:0] scanned_count_q, expected_q, hit_count;
  logic [BINS*COUNT_WIDTH-1:0] counts_q;
  logic [BINS-1:0] known_q, full;
  logic frozen_q, frozen_known_q, hit, fills, scans_watched;
  logic hit_t2_q, hit_t3_q, hit_t4_q, hit_t5_q;
  logic [BIN_WIDTH-1:0] bin_t2_q, bin_t3_q, bin_t4_q, bin_t5_q;

  assign accepted = checking && ready && tdc_valid_i;
  assign scans_watched = scan_i && scan_pixel_i == watched_pixel && scan_bin_i == watched_bin;
  assign hit = hit_t5_q && !frozen_q;
  assign hit_count = counts_q[bin_t5_q*COUNT_WIDTH+:COUNT_WIDTH];
  assign fills = hit && (32'(hit_count) + 1 >= (1 << COUNT_WIDTH) - 1);
  assign prepared = (FREEZE == 0) || ((&known_q) && (frozen_known_q || clear_all_i)
      && (full == '0 || (frozen_q && !clear_all_i) || (clear_all_i && SIGNALLED_CLEAR != 0)));

  genvar b;
  generate
    for (b = 0; b < BINS; b = b + 1) begin : g_bin
      logic cleared;
      assign cleared = (SIGNALLED_CLEAR != 0) ? clear_all_i
          : clear_i && clear_pixel_i == watched_pixel && 32'(clear_bin_i) == b;
      assign full[b] = &counts_q[b*COUNT_WIDTH+:COUNT_WIDTH];
      always_ff @(posedge clk_i) begin
        if (!checking) begin
          known_q[b] <= 1'b0;
        end else if (cleared) begin
          known_q[b] <= 1'b1;
          counts_q[b*COUNT_WIDTH+:COUNT_WIDTH] <= '0;
        end else if (hit && 32'(bin_t5_q) == b && !full[b]) begin
          counts_q[b*COUNT_WIDTH+:COUNT_WIDTH] <= hit_count + 1'b1;
        end
      end
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      pixel_q <= '0;
      slot_q <= '0;
      accepted_q <= 1'b0;
      watched_t1_q <= 1'b0;
      frozen_q <= 1'b0;
      frozen_known_q <= 1'b0;
      scanned_q <= 1'b0;
      check_q <= 1'b0;
      hit_t2_q <= 1'b0;
      hit_t3_q <= 1'b0;
      hit_t4_q <= 1'b0;
      hit_t5_q <= 1'b0;
    end else begin
      if (accepted) begin
        slot_q <= (slot_q == SLOT_WIDTH'(SLOTS - 1)) ? '0 : slot_q + 1'b1;
        if (slot_q == SLOT_WIDTH'(SLOTS - 1)) begin
          pixel_q <= (pixel_q == ROW_WIDTH'(PIXELS - 1)) ? '0 : pixel_q + 1'b1;
        end
      end
      accepted_q <= accepted;
      watched_t1_q <= accepted && (pixel_q == watched_pixel);
      if (clear_all_i) begin
        frozen_q <= 1'b0;
        frozen_known_q <= 1'b1;
      end else if (fills && FREEZE != 0) begin
        frozen_q <= 1'b1;
      end
      hit_t2_q <= watched_t1_q && keep_i;
      hit_t3_q <= hit_t2_q;
      hit_t4_q <= hit_t3_q;
      hit_t5_q <= hit_t4_q;
      bin_t2_q <= bin_i;
      bin_t3_q <= bin_t2_q;
      bin_t4_q <= bin_t3_q;
      bin_t5_q <= bin_t4_q;
      scanned_q <= scans_watched && known_q[watched_bin];
      scanned_count_q <= counts_q[watched_bin*COUNT_WIDTH+:COUNT_WIDTH];
      check_q <= scanned_q;
      expected_q <= scanned_count_q;
    end
  end

  `ASSUME(m_contiguous, (pixel_q == '0 && slot_q == '0) || tdc_valid_i)
  `ASSUME(m_scan_between_passes, !stream_q || (!scan_i && !clear_i && !clear_all_i))
  `ASSUME(m_in_range, 32'(scan_pixel_i) < PIXELS && 32'(clear_pixel_i) < PIXELS && 32'(watched_pixel) < PIXELS)
  `ASSUME(m_scan_then_clear, !(scan_i && clear_i && scan_pixel_i == clear_pixel_i && scan_bin_i == clear_bin_i))
  `ASSUME(m_clear_all_alone, !(clear_all_i && scan_i))
  `PROVE(a_every_timestamp_passes, beat_t1 == accepted_q)
  `PROVE(a_count, !check_q || count == expected_q)
  `PROVE(a_full, !(&known_q) || (full_t5 && pixel_t5 == watched_pixel) == fills)
  `GOAL(check_q && count == '1)

endmodule

`default_nettype wire
