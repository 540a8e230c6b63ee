// SPDX-License-Identifier: Apache-2.0
// histogram_builder, driven by pixel_sequencer, is a memory of saturating counters: one arbitrary pixel and bin is
// followed through passes, scans and clears. Pixels and timestamps are counted here from the handshake alone.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module histogram_builder_properties #(
    parameter int PIXELS = 2,
    parameter int SLOTS = 2,
    parameter int SIGNALLED_CLEAR = 0,
    parameter int BIN_WIDTH = 1,
    parameter int COUNT_WIDTH = 2,
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS),
    localparam int SLOT_WIDTH = dtof_pkg::index_width(SLOTS)
) (
    input logic                 clk_i,
    input logic                 begin_i,       // a pass begins
    input logic                 more_i,        // after an acquisition, and as a pass begins: another one follows
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

  // A pass ends as soon as it is idle, as in controller; scans and clears come between passes.
  logic stream_q, more_q, ready, acq_done, idle, accepted;
  logic [2:0] quiet_q;
  logic fetch, beat_t1, first_slot, visit, first_acq, last_slot, beat_t5;
  logic [ROW_WIDTH-1:0] fetch_pixel, pixel_t2, pixel_t5;
  logic [3:1] same_pixel;
  logic [COUNT_WIDTH-1:0] count;

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      stream_q <= 1'b0;
      more_q <= 1'b0;
      quiet_q <= '0;
    end else begin
      stream_q <= stream_q ? !idle : begin_i && (&quiet_q) && !scan_i && !clear_i;
      quiet_q <= {quiet_q[1:0], !scan_i && !clear_i && !clear_all_i};
      if (!stream_q || acq_done) begin
        more_q <= more_i;
      end
    end
  end

  pixel_sequencer #(
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

  histogram_builder #(
      .PIXELS_PER_SRAM(PIXELS),
      .BIN_WIDTH      (BIN_WIDTH),
      .SLOTS          (SLOTS),
      .COUNT_WIDTH    (COUNT_WIDTH),
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
      .count_s2_o     (count)
  );

  // The reference: one counter.
  (* anyconst *) logic [ROW_WIDTH-1:0] watched_pixel;
  (* anyconst *) logic [BIN_WIDTH-1:0] watched_bin;
  logic [ROW_WIDTH-1:0] pixel_q;  // of the next timestamp
  logic [SLOT_WIDTH-1:0] slot_q;
  logic accepted_q, watched_t1_q, known_q, scanned_q, scanned_known_q, check_q;
  logic [COUNT_WIDTH-1:0] count_q, scanned_count_q, expected_q;
  logic cleared, scans_watched;

  assign accepted = checking && ready && tdc_valid_i;
  assign cleared = (SIGNALLED_CLEAR != 0) ? clear_all_i
      : clear_i && clear_pixel_i == watched_pixel && clear_bin_i == watched_bin;
  assign scans_watched = scan_i && scan_pixel_i == watched_pixel && scan_bin_i == watched_bin;

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      pixel_q <= '0;
      slot_q <= '0;
      accepted_q <= 1'b0;
      watched_t1_q <= 1'b0;
      known_q <= 1'b0;
      scanned_q <= 1'b0;
      check_q <= 1'b0;
    end else begin
      if (accepted) begin
        slot_q <= (slot_q == SLOT_WIDTH'(SLOTS - 1)) ? '0 : slot_q + 1'b1;
        if (slot_q == SLOT_WIDTH'(SLOTS - 1)) begin
          pixel_q <= (pixel_q == ROW_WIDTH'(PIXELS - 1)) ? '0 : pixel_q + 1'b1;
        end
      end
      accepted_q <= accepted;
      watched_t1_q <= accepted && (pixel_q == watched_pixel);
      if (cleared) begin
        known_q <= 1'b1;
        count_q <= '0;
      end else if (watched_t1_q && keep_i && bin_i == watched_bin && count_q != '1) begin
        count_q <= count_q + 1'b1;
      end
      scanned_q <= scans_watched && known_q;
      scanned_count_q <= count_q;
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
  `GOAL(check_q && count == '1)

endmodule

`default_nettype wire
