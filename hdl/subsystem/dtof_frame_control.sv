// SPDX-License-Identifier: Apache-2.0
// Starts an array's frames, singly or continuously, and counts the frames and their clocks.
//
// 1. start_i begins a frame, if no frame is under way and the settings are legal.
// 2. With continuous_i the next frame begins in the clock after the array's done_i.
// 3. With illegal settings no frame begins, and continuous frames end. start_i while busy_o is ignored. An output is high for one
//    clock in either case.
// 4. abort_i ends the present frame at once. The next frame begins with a start_i when the array is ready again.
//
// Legal is a schedule in order (HAS_SCHEDULE = 1), coarse_end <= track_end <= acquisitions;
// 1 <= release <= MOST_RELEASE; and with raw_i (RAW_HISTOGRAM = 1) raw_first <= raw_last < PIXELS_PER_SRAM.
// Cost: a cycle counter and the last frame's cycles, a frame counter, two comparators of ACQ_WIDTH bits.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_frame_control #(
    parameter int HAS_SCHEDULE = 0,
    parameter int ACQ_WIDTH = 16,
    parameter int MOST_RELEASE = 320,
    parameter int RAW_HISTOGRAM = 0,
    parameter int PIXELS_PER_SRAM = 160
) (
    input  logic                 clk_i,
    input  logic                 rst_ni,
    input  logic                 start_i,
    input  logic                 abort_i,
    input  logic                 resetting_i,         // the array is not ready yet behind abort_i
    input  logic                 continuous_i,
    input  logic [ACQ_WIDTH-1:0] acquisitions_i,
    input  logic [ACQ_WIDTH-1:0] coarse_end_i,
    input  logic [ACQ_WIDTH-1:0] track_end_i,
    input  logic [         15:0] release_i,
    input  logic                 raw_i,               // these three are 0 without RAW_HISTOGRAM
    input  logic [         11:0] raw_first_i,
    input  logic [         11:0] raw_last_i,
    output logic                 begin_o,             // the array's start: its settings are sampled
    input  logic                 done_i,              // the array's last clock
    input  logic                 frame_i,             // the frame's last result was taken
    output logic                 running_o,           // a frame is under way or about to begin by itself
    output logic                 busy_o,              // the same, or the array is not ready yet behind abort_i
    output logic                 start_ignored_o,     // these three for one clock
    output logic                 illegal_schedule_o,
    output logic                 aborted_o,           // a frame was under way when abort_i came
    output logic [         31:0] frame_count_o,
    output logic [         31:0] frame_cycles_o       // from begin_o to done_i, both included
);

  logic legal, legal_schedule, legal_raw;

  generate
    if (HAS_SCHEDULE != 0) begin : g_schedule
      assign legal_schedule = (coarse_end_i <= track_end_i) && (track_end_i <= acquisitions_i);
    end else begin : g_no_schedule
      logic unused_schedule;
      assign unused_schedule = ^{coarse_end_i, track_end_i, acquisitions_i};
      assign legal_schedule = 1'b1;
    end

    if (RAW_HISTOGRAM != 0) begin : g_raw_histogram
      assign legal_raw = !raw_i || (raw_first_i <= raw_last_i && 32'(raw_last_i) < PIXELS_PER_SRAM);
    end else begin : g_no_raw_histogram
      logic unused_raw;
      assign unused_raw = ^{raw_i, raw_first_i, raw_last_i};
      assign legal_raw = 1'b1;
    end
  endgenerate

  assign legal = legal_schedule && legal_raw && (release_i != '0) && (32'(release_i) <= MOST_RELEASE);

  logic running_q, again_q, begins;
  logic [31:0] cycles_q, frame_cycles_q, frame_count_q;

  assign running_o = running_q || again_q;
  assign busy_o = running_o || resetting_i;
  assign begins = !abort_i && ((start_i && !busy_o) || again_q);
  assign begin_o = begins && legal;
  assign illegal_schedule_o = begins && !legal;
  assign start_ignored_o = start_i && (busy_o || abort_i);
  assign aborted_o = abort_i && running_q && !done_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      running_q <= 1'b0;
      again_q <= 1'b0;
      cycles_q <= '0;
      frame_cycles_q <= '0;
      frame_count_q <= '0;
    end else begin
      running_q <= begin_o || (running_q && !done_i && !abort_i);
      again_q <= running_q && done_i && continuous_i && !abort_i;
      if (begin_o) begin
        cycles_q <= 32'd2;
      end else if (running_q && (cycles_q != {32{1'b1}})) begin
        cycles_q <= cycles_q + 1'b1;
      end
      if (running_q && done_i) begin
        frame_cycles_q <= cycles_q;
      end
      if (frame_i) begin
        frame_count_q <= frame_count_q + 1'b1;
      end
    end
  end

  assign frame_count_o = frame_count_q;
  assign frame_cycles_o = frame_cycles_q;

endmodule

`default_nettype wire
