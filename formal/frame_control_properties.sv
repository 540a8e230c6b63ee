// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_frame_control: a frame begins if and only if the conditions are met, and ends with done_i or abort_i. Each refusal
// raises its output. Legality, continuous mode and the counters follow docs/user/integration.md. start_i and abort_i may come at any time.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module frame_control_properties #(
    parameter int HAS_SCHEDULE = 1,
    parameter int ACQ_WIDTH = 3,
    parameter int MOST_RELEASE = 5,
    parameter int RAW_HISTOGRAM = 0,
    parameter int PIXELS_PER_SRAM = 4
) (
    input logic                 clk_i,
    input logic                 reset_i,
    input logic                 start_i,
    input logic                 abort_i,
    input logic                 resetting_i,
    input logic                 continuous_i,
    input logic [ACQ_WIDTH-1:0] acquisitions_i,
    input logic [ACQ_WIDTH-1:0] coarse_end_i,
    input logic [ACQ_WIDTH-1:0] track_end_i,
    input logic [         15:0] release_i,
    input logic                 raw_i,
    input logic [         11:0] raw_first_i,
    input logic [         11:0] raw_last_i,
    input logic                 done_i,
    input logic                 frame_i,
    input logic                 unfinished_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic begins, running, busy, start_ignored, illegal_schedule, aborted;
  logic [31:0] frame_count, frame_cycles;

  dtof_frame_control #(
      .HAS_SCHEDULE   (HAS_SCHEDULE),
      .ACQ_WIDTH      (ACQ_WIDTH),
      .MOST_RELEASE   (MOST_RELEASE),
      .RAW_HISTOGRAM  (RAW_HISTOGRAM),
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM)
  ) u_dut (
      .clk_i             (clk_i),
      .rst_ni            (rst_n),
      .start_i           (start_i),
      .abort_i           (abort_i),
      .resetting_i       (resetting_i),
      .continuous_i      (continuous_i),
      .acquisitions_i    (acquisitions_i),
      .coarse_end_i      (coarse_end_i),
      .track_end_i       (track_end_i),
      .release_i         (release_i),
      .raw_i             (raw_i),
      .raw_first_i       (raw_first_i),
      .raw_last_i        (raw_last_i),
      .begin_o           (begins),
      .done_i            (done_i),
      .frame_i           (frame_i),
      .unfinished_i      (unfinished_i),
      .running_o         (running),
      .busy_o            (busy),
      .start_ignored_o   (start_ignored),
      .illegal_schedule_o(illegal_schedule),
      .aborted_o         (aborted),
      .frame_count_o     (frame_count),
      .frame_cycles_o    (frame_cycles)
  );

  // under_way_q: a frame is in progress; follows_q: the last clock ended a frame and a continuous frame follows.
  logic under_way_q, follows_q, legal, may;
  logic [3:0] frames_q;  // number of frames, modulo 16

  assign legal = (HAS_SCHEDULE == 0 || (coarse_end_i <= track_end_i && track_end_i <= acquisitions_i))
      && 32'(release_i) >= 1 && 32'(release_i) <= MOST_RELEASE
      && (RAW_HISTOGRAM == 0 || !raw_i || (raw_first_i <= raw_last_i && 32'(raw_last_i) < PIXELS_PER_SRAM));
  assign may = !abort_i && (follows_q || (start_i && !under_way_q && !resetting_i));

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      under_way_q <= 1'b0;
      follows_q <= 1'b0;
      frames_q <= '0;
    end else begin
      if (done_i || abort_i) under_way_q <= 1'b0;
      if (begins) under_way_q <= 1'b1;
      follows_q <= under_way_q && done_i && continuous_i && !abort_i;
      frames_q <= frames_q + 4'(frame_i);
    end
  end

  `ASSUME(m_done, !done_i || under_way_q)
  `ASSUME(m_resetting, !resetting_i || (!under_way_q && !follows_q))
  `PROVE(a_begins, !rst_n || begins == (may && legal))
  `PROVE(a_illegal, !rst_n || illegal_schedule == (may && !legal))
  `PROVE(a_never_two, !rst_n || !(begins && under_way_q))
  `PROVE(a_running, !rst_n || running == (under_way_q || follows_q))
  `PROVE(a_busy, !rst_n || busy == (under_way_q || follows_q || resetting_i))
  `PROVE(a_ignored, !rst_n || start_ignored == (start_i && (busy || abort_i)))
  `PROVE(a_aborted, !rst_n || aborted == (abort_i && ((under_way_q && !done_i) || unfinished_i)))
  `PROVE(a_count, !rst_n || frame_count[3:0] == frames_q)
  `GOAL(rst_n && begins && follows_q)

  logic unused;
  assign unused = ^frame_cycles ^ ^frame_count;

endmodule

`default_nettype wire
