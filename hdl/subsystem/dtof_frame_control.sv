// SPDX-License-Identifier: Apache-2.0
// Starts an array's frames, singly or continuously, and counts the frames and their clocks.
//
// 1. start_i begins a frame if no frame is in progress and the settings are legal.
// 2. With continuous_i the next frame begins in the clock after the array's done_i.
// 3. With illegal settings no frame begins, and continuous frames end (illegal_schedule_o). start_i while busy_o is high has no
//    effect (start_ignored_o).
// 4. abort_i ends the present frame at once. The next frame begins with a start_i after the array's reset (resetting_i). aborted_o says
//    that abort_i came before the array's last clock of a frame, or cut off words of a frame.
//
// Equation: the settings are legal if coarse_end <= track_end <= acquisitions (HAS_SCHEDULE = 1), 1 <= release <= MOST_RELEASE, and,
// with raw_i (RAW_HISTOGRAM = 1), raw_first <= raw_last < PIXELS_PER_SRAM.
// Latency: none from start_i to begin_o; 1 clock from done_i to begin_o of the next frame.
// Cost: a counter and a register of 32 bits for the cycles, a frame counter of 32 bits, comparators of the settings.
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
    input  logic                 resetting_i,         // the array's reset, or a self-test's comparison, is not over yet
    input  logic                 continuous_i,
    input  logic [ACQ_WIDTH-1:0] acquisitions_i,
    input  logic [ACQ_WIDTH-1:0] coarse_end_i,
    input  logic [ACQ_WIDTH-1:0] track_end_i,
    input  logic [         15:0] release_i,
    input  logic                 raw_i,               // raw_i, raw_first_i and raw_last_i are 0 without RAW_HISTOGRAM
    input  logic [         11:0] raw_first_i,
    input  logic [         11:0] raw_last_i,
    output logic                 begin_o,             // start of the array, which samples its settings
    input  logic                 done_i,              // last clock of the array's frame
    input  logic                 frame_i,             // the sink has taken the frame's last result
    input  logic                 unfinished_i,        // the array's frame is over, and abort_i cuts off words of the frame
    output logic                 running_o,           // a frame is in progress, or a continuous frame is about to begin
    output logic                 busy_o,              // running_o or resetting_i
    output logic                 start_ignored_o,     // these three outputs are high for one clock
    output logic                 illegal_schedule_o,
    output logic                 aborted_o,
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
  assign aborted_o = abort_i && ((running_q && !done_i) || unfinished_i);

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
