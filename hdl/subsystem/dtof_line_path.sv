// SPDX-License-Identifier: Apache-2.0
// The way of the lines of timestamps from the source to the array, and the shots that make the source deliver them.
//
// 1. The source may deliver lines at any pace, before and during frames. With CLOCK_WAITS = 1 the array takes each line when it arrives, and
//    waits_o stops the array's clock while a line is late inside an acquisition. With CLOCK_WAITS = 0 the line buffer offers an acquisition to the
//    array when all its lines have arrived. (A smaller RELEASE offers it earlier, with the risk of an underrun.)
// 2. Timestamps of disabled columns, and timestamps outside the time gate, count as no detection (dtof_line_filter).
// 3. Missing lines count as no detection, a new acquisition begins after each s_axis_tlast_i, and a watchdog ends the wait for a dead source.
// 4. The acquisitions at a frame's start, in which a laser settles, are dropped (dtof_settle).
// 5. shot_o fires the laser and starts the TDCs, once for each acquisition that a frame needs (dtof_shot_dither).
// 6. In a self-test (test_frame_i) the array takes test_line_i. The source's lines wait, and no shot is fired.
//
// Latency: one clock from a line to the array, two if the line buffer is an SRAM.
// Cost: BUFFER_LINES lines, a flip-flop per column, dtof_line_filter, and the counters of the parts.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_line_path #(
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SRAM_NUM = 200,
    parameter int SLOTS = 2,
    parameter int PARITY = 0,
    parameter int TIME_GATE = 0,
    parameter int ACQ_WIDTH = 16,
    parameter int CLOCK_WAITS = 1,
    parameter int SOURCE_WAITS = 1,
    parameter int BUFFER_LINES = 2,
    parameter int MOST_RELEASE = 320,
    localparam int S_TDATA_WIDTH = 8 * ((SRAM_NUM * NP + 7) / 8)
) (
    input  logic                     clk_i,
    input  logic                     rst_ni,
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // frame
    input  logic                     begin_i,          // a frame begins, with the settings below
    input  logic                     running_i,
    input  logic                     done_i,           // last clock of the array's frame
    input  logic                     abort_i,
    input  logic                     flush_i,          // with abort_i, or while no frame is running
    input  logic                     resetting_i,      // the array is in reset
    // settings
    input  logic [     SRAM_NUM-1:0] enable_i,
    input  logic [           NP-1:0] gate_begin_i,
    input  logic [           NP-1:0] gate_end_i,
    input  logic [             15:0] release_i,
    input  logic [    ACQ_WIDTH-1:0] acquisitions_i,
    input  logic [             15:0] settle_i,
    input  logic [             23:0] watchdog_i,       // at any time, as those of the shots
    input  logic [              2:0] shot_bits_i,
    input  logic [              7:0] shot_unit_i,
    input  logic [             15:0] shot_seed_i,
    input  logic                     shot_reseed_i,
    // self-test
    input  logic                     test_chosen_i,    // the frame that begins is a self-test
    input  logic                     test_frame_i,     // the frame that began last is a self-test
    input  logic [  SRAM_NUM*NP-1:0] test_line_i,
    // source
    input  logic                     s_axis_tvalid_i,
    output logic                     s_axis_tready_o,
    input  logic [S_TDATA_WIDTH-1:0] s_axis_tdata_i,
    input  logic                     s_axis_tlast_i,
    output logic                     shot_o,
    // array
    output logic                     line_valid_o,
    input  logic                     line_ready_i,
    output logic [  SRAM_NUM*NP-1:0] line_o,
    output logic                     waits_o,          // a line is late inside an acquisition: the array's clock stops
    output logic [     SRAM_NUM-1:0] enable_o,         // enabled columns of the present frame
    // status and events
    output logic [             15:0] level_o,          // lines in the buffer
    output logic [             31:0] lost_lines_o,
    output logic [             31:0] lost_acquisitions_o,
    output logic [             15:0] shot_state_o,
    output logic                     underrun_o,
    output logic                     short_o,
    output logic                     long_o,
    output logic                     timeout_o,
    output logic                     dropped_o,        // a line found no room
    output logic                     parity_error_o
);

  localparam int ACQUISITION_LINES = PIXELS_PER_SRAM * SLOTS;
  localparam int MOST_REGISTERS = 8;  // lines; a longer buffer is an SRAM
  localparam int LEVEL_WIDTH = $clog2(BUFFER_LINES + 2);

  // Settings of the present frame.

  logic [SRAM_NUM-1:0] frame_enable_q;
  logic [NP-1:0] frame_gate_begin_q, frame_gate_end_q;
  logic [15:0] frame_release_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      frame_release_q <= 16'(MOST_RELEASE);
    end else if (begin_i) begin
      frame_release_q <= release_i;
    end
  end

  always_ff @(posedge clk_i) begin
    if (begin_i) begin
      frame_enable_q <= enable_i;
      frame_gate_begin_q <= gate_begin_i;
      frame_gate_end_q <= gate_end_i;
    end
  end

  assign enable_o = frame_enable_q;

  // Lines of the source.

  logic buffer_valid, buffer_ready, starved, kept, expired, queued, source_inside, source_early, arrives, rest_ends, taken, taken_last;
  logic line_waits;  // a line is late inside an acquisition
  logic drops;       // the acquisition that leaves the line buffer is dropped
  logic settle_takes;
  logic [1:0] lost_acquisition;
  logic [LEVEL_WIDTH-1:0] level;
  logic [LEVEL_WIDTH:0] lost;
  logic [SRAM_NUM*NP-1:0] line;

  assign level_o = 16'(level);
  assign buffer_ready = (line_ready_i || settle_takes) && !test_frame_i;
  assign waits_o = line_waits && !drops;
  assign line_valid_o = test_frame_i ? running_i : buffer_valid && !line_waits && !drops;

  dtof_line_buffer #(
      .ACQUISITION_LINES(ACQUISITION_LINES),
      .LINES            (BUFFER_LINES),
      .WIDTH            (SRAM_NUM * NP),
      .REGISTERS        ((BUFFER_LINES <= MOST_REGISTERS) ? 1 : 0),
      .CLOCK_WAITS      (CLOCK_WAITS),
      .SOURCE_WAITS     (SOURCE_WAITS),
      .ARRAY_WAIT       (SLOTS - 1),
      .PARITY           (PARITY)
  ) u_line_buffer (
      .clk_i              (clk_i),
      .rst_ni             (rst_ni),
      .sram_cfg_i         (sram_cfg_i),
      .sram_cfg_o         (sram_cfg_o),
      .flush_i            (flush_i),
      .abort_i            (abort_i),
      .expire_i           (expired && running_i),
      .done_i             (done_i),
      .release_i          (frame_release_q),
      .level_o            (level),
      .starved_o          (starved),
      .wait_o             (line_waits),
      .queued_o           (queued),
      .inside_o           (source_inside),
      .early_o            (source_early),
      .kept_o             (kept),
      .arrives_o          (arrives),
      .rest_ends_o        (rest_ends),
      .taken_o            (taken),
      .taken_last_o       (taken_last),
      .underrun_o         (underrun_o),
      .short_o            (short_o),
      .long_o             (long_o),
      .dropped_o          (dropped_o),
      .lost_lines_o       (lost),
      .parity_error_o     (parity_error_o),
      .lost_acquisitions_o(lost_acquisition),
      .s_tvalid_i         (s_axis_tvalid_i),
      .s_tready_o         (s_axis_tready_o),
      .s_tdata_i          (s_axis_tdata_i[SRAM_NUM*NP-1:0]),
      .s_tlast_i          (s_axis_tlast_i),
      .line_valid_o       (buffer_valid),
      .line_ready_i       (buffer_ready && !resetting_i),
      .line_o             (line)
  );

  generate
    if (S_TDATA_WIDTH > SRAM_NUM * NP) begin : g_padding
      logic unused_padding;
      assign unused_padding = ^s_axis_tdata_i[S_TDATA_WIDTH-1:SRAM_NUM*NP];
    end
  endgenerate

  dtof_watchdog #(
      .WIDTH(24)
  ) u_line_watchdog (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .limit_i  (watchdog_i),
      .waits_i  (starved && running_i && !kept && !test_frame_i),
      .expired_o(expired)
  );

  assign timeout_o = expired && running_i && starved && !abort_i;

  dtof_saturating_counter #(
      .STEP_WIDTH(LEVEL_WIDTH + 1)
  ) u_lost_lines (
      .clk_i  (clk_i),
      .rst_ni (rst_ni),
      .step_i (lost),
      .count_o(lost_lines_o)
  );

  dtof_saturating_counter #(
      .STEP_WIDTH(2)
  ) u_lost_acquisitions (
      .clk_i  (clk_i),
      .rst_ni (rst_ni),
      .step_i (lost_acquisition),
      .count_o(lost_acquisitions_o)
  );

  // Acquisitions that a frame drops, and all that it needs; a frame without acquisitions takes none.

  localparam int NEED_WIDTH = dtof_pkg::max_of(ACQ_WIDTH, 16) + 1;
  logic [15:0] frame_settle;
  logic [NEED_WIDTH-1:0] needed;

  assign frame_settle = (acquisitions_i == '0 || test_chosen_i) ? '0 : settle_i;
  assign needed = test_chosen_i ? '0 : NEED_WIDTH'(acquisitions_i) + NEED_WIDTH'(frame_settle);

  dtof_settle #(
      .WIDTH(16)
  ) u_settle (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .settle_i (frame_settle),
      .begin_i  (begin_i),
      .abort_i  (abort_i),
      .give_up_i(timeout_o),
      .first_i  (taken),
      .last_i   (taken_last),
      .drops_o  (drops),
      .takes_o  (settle_takes)
  );

  dtof_shot_dither #(
      .ACQ_WIDTH(NEED_WIDTH)
  ) u_shot_dither (
      .clk_i         (clk_i),
      .rst_ni        (rst_ni),
      .reseed_i      (shot_reseed_i),
      .seed_i        (shot_seed_i),
      .bits_i        (shot_bits_i),
      .unit_i        (shot_unit_i),
      .acquisitions_i(needed),
      .begin_i       (begin_i),
      .abort_i       (abort_i),
      .flush_i       (flush_i),
      .give_up_i     (timeout_o),
      .arrives_i     (arrives),
      .queued_i      (queued),
      .taken_i       (taken),
      .inside_i      (source_inside),
      .early_i       (source_early),
      .rest_ends_i   (rest_ends),
      .shot_o        (shot_o),
      .first_state_o (shot_state_o)
  );

  // Lines of the array.

  logic [SRAM_NUM*NP-1:0] array_line;

  assign array_line = test_frame_i ? test_line_i : line;

  `DTOF_ASSERT(a_source_rests, !test_frame_i || !running_i || (!line_waits && !drops), "lines of the source are inside a self-test")

  dtof_line_filter #(
      .NP       (NP),
      .SRAM_NUM (SRAM_NUM),
      .TIME_GATE(TIME_GATE)
  ) u_line_filter (
      .line_i      (array_line),
      .enable_i    (frame_enable_q),
      .gate_begin_i(frame_gate_begin_q),
      .gate_end_i  (frame_gate_end_q),
      .line_o      (line_o)
  );

endmodule

`default_nettype wire
