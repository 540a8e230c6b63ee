// SPDX-License-Identifier: Apache-2.0
// State machine of a frame (thesis Fig. 4.3 and 4.8) for any number of coarse passes, once per array.
//
// IDLE -> RESET -> (M0 -> M1 -> M2) x COARSE_PASSES -> M3 -> (M4 -> M5) x PIXELS_PER_SRAM -> IDLE
//
// The scan of a pixel begins with M5 of the pixel before, and ends in its M4.
// start_i is taken in IDLE only; start_i while busy is ignored. done_o is high in the frame's last clock.
// Both are registered, so that no port drives the state's logic.
// Latency: busy_o rises one clock after start_i, RESET begins two clocks after start_i.
// Cost: 3 state bits, a pass counter and the run-time acquisition number, per array.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_controller `DTOF_TYPES_OF(dtof_pkg) #(
    parameter int COARSE_PASSES = 1,
    parameter int ACQ_WIDTH = 16,
    localparam int PASS_WIDTH = dtof_pkg::index_width(COARSE_PASSES + 1)
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    input  logic                  start_i,         // ignored while busy_o is high, also in the clock of done_o
    input  logic [ ACQ_WIDTH-1:0] acq_num_i,
    output logic                  busy_o,
    output logic                  done_o,
    output logic [           2:0] state_o,
    // dtof_pass_sequencer
    output logic                  load_o,          // acq_num_o is new
    output logic [ ACQ_WIDTH-1:0] acq_num_o,
    output logic                  next_pass_o,
    output logic                  final_o,         // the pass that next_pass_o starts is the final one
    output logic [PASS_WIDTH-1:0] pass_o,
    output logic                  first_pass_o,
    output logic                  final_pass_o,
    // dtof_pixel_sequencer
    output logic                  stream_o,
    input  logic                  stream_idle_i,
    // columns
    output logic                  clear_all_o,     // signalled clear
    output logic                  coarse_scan_o,   // the scan finds the peaks of a coarse pass
    output logic                  final_scan_o,    // the scan finds a pixel's result
    // dtof_scan_sequencer
    output logic                  scan_start_o,
    output logic                  scan_reset_o,
    output logic                  scan_final_o,
    input  logic                  scan_busy_i,
    input  logic                  scan_last_row_i,
    // dtof_result_output
    output logic                  result_start_o,
    input  logic                  result_done_i
);

  localparam logic [PASS_WIDTH-1:0] FINAL_PASS = PASS_WIDTH'(COARSE_PASSES);

  `DTOF_TYPE(dtof_pkg, state_t) state_d, state_q;
  logic [PASS_WIDTH-1:0] pass_q;
  logic [ACQ_WIDTH-1:0] acq_num_q;
  logic stream_q, first_pass_q, final_pass_q, start_q, done_q, accept;

  always_comb begin
    state_d = state_q;
    case (state_q)
      // Wait for a frame.
      dtof_pkg::STATE_IDLE:
      if (start_q) begin
        state_d = dtof_pkg::STATE_RESET;
      end
      // Clear the memories.
      dtof_pkg::STATE_RESET:
      if (!scan_busy_i) begin
        if (COARSE_PASSES == 0) begin
          state_d = dtof_pkg::STATE_M3;
        end else begin
          state_d = dtof_pkg::STATE_M0;
        end
      end
      // Build a coarse histogram.
      dtof_pkg::STATE_M0:
      if (stream_idle_i) begin
        state_d = dtof_pkg::STATE_M1;
      end
      // Find its peaks, clear it.
      dtof_pkg::STATE_M1:
      if (!scan_busy_i) begin
        state_d = dtof_pkg::STATE_M2;
      end
      // The peaks are stored: the filter of the next pass is known.
      dtof_pkg::STATE_M2:
      if (final_o) begin
        state_d = dtof_pkg::STATE_M3;
      end else begin
        state_d = dtof_pkg::STATE_M0;
      end
      // Build the fine histogram or move the pointers.
      dtof_pkg::STATE_M3:
      if (stream_idle_i) begin
        state_d = dtof_pkg::STATE_M4;
      end
      // Find one pixel's result in every column, to the end.
      dtof_pkg::STATE_M4:
      if (!scan_busy_i) begin
        state_d = dtof_pkg::STATE_M5;
      end
      // Send these results; begin the next pixel.
      dtof_pkg::STATE_M5:
      if (result_done_i) begin
        if (scan_last_row_i) begin
          state_d = dtof_pkg::STATE_IDLE;
        end else begin
          state_d = dtof_pkg::STATE_M4;
        end
      end
      default: state_d = dtof_pkg::STATE_IDLE;
    endcase
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q <= dtof_pkg::STATE_IDLE;
      stream_q <= 1'b0;
      pass_q <= '0;
      first_pass_q <= 1'b1;
      final_pass_q <= 1'b0;
      acq_num_q <= '0;
      start_q <= 1'b0;
      done_q <= 1'b0;
    end else begin
      state_q <= state_d;
      // A registered copy of the state, because tdc_ready_o depends on it.
      stream_q <= (state_d == dtof_pkg::STATE_M0) || (state_d == dtof_pkg::STATE_M3);
      start_q <= accept;
      done_q <= (state_q == dtof_pkg::STATE_M5) && (state_d == dtof_pkg::STATE_IDLE);
      if (accept) begin
        acq_num_q <= acq_num_i;
        pass_q <= '0;
        first_pass_q <= 1'b1;
        final_pass_q <= (COARSE_PASSES == 0);
      end else if (next_pass_o) begin
        pass_q <= pass_q + 1'b1;
        first_pass_q <= 1'b0;
        final_pass_q <= final_o;
      end
    end
  end

  `DTOF_ASSERT(a_scan_or_stream, !(stream_o && scan_busy_i), "a pass began before the scan ended")

  logic entering;
  assign entering = (state_d != state_q);

  assign busy_o = start_q || (state_q != dtof_pkg::STATE_IDLE) || done_q;
  assign done_o = done_q;
  assign state_o = state_q;
  assign accept = start_i && !busy_o;
  assign clear_all_o = (state_q == dtof_pkg::STATE_RESET) || (state_q == dtof_pkg::STATE_M2);
  assign coarse_scan_o = (state_q == dtof_pkg::STATE_M1);
  assign final_scan_o = (state_q == dtof_pkg::STATE_M4);
  assign load_o = (state_q == dtof_pkg::STATE_RESET);
  assign acq_num_o = acq_num_q;
  assign next_pass_o = (state_q == dtof_pkg::STATE_M2);
  assign final_o = (pass_q + 1'b1 == FINAL_PASS);
  assign pass_o = pass_q;
  assign first_pass_o = first_pass_q;
  assign final_pass_o = final_pass_q;
  assign stream_o = stream_q;
  assign scan_reset_o = entering && (state_d == dtof_pkg::STATE_RESET);
  assign scan_final_o = entering && ((state_q == dtof_pkg::STATE_M3) || (result_start_o && !scan_last_row_i));
  assign scan_start_o = scan_reset_o || scan_final_o || (entering && state_d == dtof_pkg::STATE_M1);
  assign result_start_o = entering && (state_d == dtof_pkg::STATE_M5);

endmodule

`default_nettype wire
