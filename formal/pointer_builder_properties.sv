// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pointer_builder, driven by dtof_pixel_sequencer: each pixel's timestamps change its word one after the other. The
// harness follows one arbitrary pixel. The proof of dtof_pointer_update covers a single move.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pointer_builder_properties #(
    parameter int PIXELS = 2,
    parameter int SLOTS = 2,
    parameter int PORTS = 2,
    parameter int FRACTION_BITS = 0,
    parameter int TAG_WIDTH = 1,
    parameter int NP = 3,
    parameter int CONFIDENCE_WIDTH = 1,
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS),
    localparam int POINTER_WIDTH = NP + FRACTION_BITS,
    localparam int TAG_BITS = dtof_pkg::max_of(TAG_WIDTH, 1),
    localparam int STEP_WIDTH = dtof_pkg::step_width(1, FRACTION_BITS),
    localparam int SLOT_WIDTH = dtof_pkg::index_width(SLOTS)
) (
    input logic                     clk_i,
    input logic                     begin_i,
    input logic                     more_i,
    input logic                     tdc_valid_i,
    input logic                     may_hit_i,     // at T0: timestamps that the window at T1 may keep
    input logic                     keep_i,
    input logic [           NP-1:0] timestamp_i,   // at T1
    input logic [   STEP_WIDTH-1:0] step_i,        // changes after an acquisition and before a pass
    input logic                     read_i,
    input logic [    ROW_WIDTH-1:0] read_pixel_i,
    input logic                     start_i,
    input logic [    ROW_WIDTH-1:0] start_pixel_i,
    input logic [POINTER_WIDTH-1:0] start_pointer_i,
    input logic [     TAG_BITS-1:0] start_tag_i
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic stream_q, more_q, ready, acq_done, idle, accepted;
  logic [2:0] quiet_q;
  logic [STEP_WIDTH-1:0] step_q, step_t1_q;
  logic may_hit_q, keep;
  logic fetch, beat_t1, first_slot, visit, first_acq, last_slot, beat_t5, read_done_q, read;
  logic [ROW_WIDTH-1:0] fetch_pixel, pixel_t2, pixel_t5;
  logic [3:1] same_pixel;
  logic [POINTER_WIDTH-1:0] pointer;
  logic [CONFIDENCE_WIDTH-1:0] confidence;
  logic [TAG_BITS-1:0] tag_t1;

  assign read = fetch || read_i;

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      stream_q <= 1'b0;
      more_q <= 1'b0;
      quiet_q <= '0;
      read_done_q <= 1'b0;
    end else begin
      stream_q <= stream_q ? !idle : begin_i && (&quiet_q) && !read_i && !start_i;
      quiet_q <= {quiet_q[1:0], !read_i && !start_i};
      read_done_q <= read;
      if (!stream_q || acq_done) begin
        more_q <= more_i;
      end
    end
    if (!stream_q || acq_done) begin
      step_q <= (FRACTION_BITS == 0) ? STEP_WIDTH'(1) : step_i;
    end
    step_t1_q <= step_q;
    may_hit_q <= may_hit_i;
  end

  assign keep = may_hit_q && keep_i;

  dtof_pixel_sequencer #(
      .PIXELS_PER_SRAM    (PIXELS),
      .SLOTS              (SLOTS),
      .FETCH_ON_FIRST_SLOT(1)
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

  dtof_pointer_builder #(
      .NP              (NP),
      .PIXELS_PER_SRAM (PIXELS),
      .SLOTS           (SLOTS),
      .POINTER_STEP    (1),
      .FRACTION_BITS   (FRACTION_BITS),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .TAG_WIDTH       (TAG_WIDTH),
      .PORTS           (PORTS)
  ) u_dut (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .read_i         (read),
      .read_pixel_i   (read_i ? read_pixel_i : fetch_pixel),
      .read_done_i    (read_done_q),
      .first_slot_t0_i(first_slot),
      .visit_t1_i     (visit),
      .first_acq_t1_i (first_acq),
      .write_i        (last_slot),
      .write_pixel_i  (pixel_t2),
      .step_t0_i      (step_q),
      .may_hit_t0_i   (may_hit_i),
      .hit_t1_i       (beat_t1 && keep),
      .timestamp_t1_i (timestamp_i),
      .tag_t1_o       (tag_t1),
      .start_write_i  (start_i),
      .start_pixel_i  (start_pixel_i),
      .start_pointer_i(start_pointer_i),
      .start_tag_i    (start_tag_i),
      .pointer_o      (pointer),
      .confidence_o   (confidence)
  );

  // Reference: the word of one pixel.
  (* anyconst *) logic [ROW_WIDTH-1:0] watched_pixel;
  logic [ROW_WIDTH-1:0] pixel_q;  // pixel of the next timestamp
  logic [SLOT_WIDTH-1:0] slot_q;
  logic watched_t1_q, known_q, check_s1_q, check_s2_q, started;
  logic [POINTER_WIDTH-1:0] pointer_q, moved_pointer;
  logic [CONFIDENCE_WIDTH-1:0] confidence_q, moved_confidence;
  logic [TAG_BITS-1:0] tag_q;

  dtof_pointer_update #(
      .NP              (NP),
      .POINTER_STEP    (1),
      .FRACTION_BITS   (FRACTION_BITS),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH)
  ) u_reference_move (
      .hit_i       (keep),
      .timestamp_i (timestamp_i),
      .step_i      (step_t1_q),
      .pointer_i   (pointer_q),
      .confidence_i(confidence_q),
      .pointer_o   (moved_pointer),
      .confidence_o(moved_confidence)
  );

  assign accepted = checking && ready && tdc_valid_i;
  assign started = start_i && start_pixel_i == watched_pixel;

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      pixel_q <= '0;
      slot_q <= '0;
      watched_t1_q <= 1'b0;
      known_q <= 1'b0;
      check_s1_q <= 1'b0;
      check_s2_q <= 1'b0;
    end else begin
      if (accepted) begin
        slot_q <= (slot_q == SLOT_WIDTH'(SLOTS - 1)) ? '0 : slot_q + 1'b1;
        if (slot_q == SLOT_WIDTH'(SLOTS - 1)) begin
          pixel_q <= (pixel_q == ROW_WIDTH'(PIXELS - 1)) ? '0 : pixel_q + 1'b1;
        end
      end
      watched_t1_q <= accepted && (pixel_q == watched_pixel);
      known_q <= known_q || started;
      check_s1_q <= read_i && read_pixel_i == watched_pixel && known_q;
      check_s2_q <= check_s1_q && !started;
    end
    if (started) begin
      pointer_q <= start_pointer_i;
      confidence_q <= '0;
      tag_q <= start_tag_i;
    end else if (watched_t1_q) begin
      pointer_q <= moved_pointer;
      confidence_q <= moved_confidence;
    end
  end

  `ASSUME(m_contiguous, (pixel_q == '0 && slot_q == '0) || tdc_valid_i)
  `ASSUME(m_read_and_start_between_passes, !stream_q || (!read_i && !start_i))
  `ASSUME(m_one_access, !(read_i && start_i))
  `ASSUME(m_in_range, 32'(read_pixel_i) < PIXELS && 32'(start_pixel_i) < PIXELS && 32'(watched_pixel) < PIXELS)
  `PROVE(a_tag, TAG_WIDTH == 0 || !(watched_t1_q && known_q && may_hit_q) || tag_t1 == tag_q)
  `PROVE(a_pointer, !(check_s2_q && !started) || pointer == pointer_q)
  `PROVE(a_confidence, !(check_s2_q && !started) || confidence == confidence_q)
  `GOAL(check_s2_q && confidence == '1 && pointer != '0)

endmodule

`default_nettype wire
