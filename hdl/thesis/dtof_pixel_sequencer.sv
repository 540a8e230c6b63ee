// SPDX-License-Identifier: Apache-2.0
// Counts the timestamps of an acquisition, handshakes with the TDC stream and gives every pipeline stage of the
// columns its pixel, once per array.
//
// The slot counter runs freely during a pass, so acquisitions start on a raster of SLOTS clocks. Therefore a
// single-port pointer SRAM always reads in the clock of the first slot and writes in that of the second slot.
//
// Schedule (T0 = a timestamp's clock at the port):
//   fetch    the next pixel's word is read in the clock of a pixel's first slot (FETCH_ON_FIRST_SLOT = 1) or of its
//            last slot (0); pixel 0's word is read in the clock before the first acquisition may start
//   T0       first_slot_t0_o, registered in the columns like the timestamp
//   T1       beat_t1_o, visit_t1_o, first_acq_t1_o
//   T2       last_slot_t2_o, pixel_t2_o: histogram read, pointer write
//   T3       same_pixel_t3_o[d]: the timestamp d clocks ahead (1 to 3) is of the same pixel
//   T5       beat_t5_o, pixel_t5_o: histogram write
// Latency: the stage of an output is in its name. Cost: counters and copies of the pixel number per stage, per array.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pixel_sequencer #(
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SLOTS = 2,
    parameter int FETCH_ON_FIRST_SLOT = 0,
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int SLOT_WIDTH = dtof_pkg::index_width(SLOTS)
) (
    input  logic                 clk_i,
    input  logic                 rst_ni,
    input  logic                 stream_i,        // a pass is in progress (M0 or M3)
    input  logic                 more_i,          // another acquisition belongs to the pass
    input  logic                 tdc_valid_i,
    output logic                 tdc_ready_o,
    output logic                 acq_done_o,      // last timestamp of an acquisition in this clock
    output logic                 idle_o,          // no timestamp in the pipeline, and the pass has no more acquisitions
    output logic                 underrun_o,      // tdc_valid_i is low inside an acquisition
    output logic                 fetch_o,
    output logic [ROW_WIDTH-1:0] fetch_pixel_o,
    output logic                 beat_t1_o,
    output logic                 first_slot_t0_o,  // also while no acquisition is in progress
    output logic                 visit_t1_o,       // first slot of a pixel's visit
    output logic                 first_acq_t1_o,  // first acquisition of the pass
    output logic                 last_slot_t2_o,
    output logic [ROW_WIDTH-1:0] pixel_t2_o,
    output logic [          3:1] same_pixel_t3_o,
    output logic                 beat_t5_o,
    output logic [ROW_WIDTH-1:0] pixel_t5_o
);

  localparam logic [ROW_WIDTH-1:0] LAST_PIXEL = ROW_WIDTH'(PIXELS_PER_SRAM - 1);
  localparam logic [SLOT_WIDTH-1:0] LAST_SLOT = SLOT_WIDTH'(SLOTS - 1);
  // A pass ends after its last timestamp is written: stream_i falls one clock after drain_q = 0.
  localparam int DRAIN_CLOCKS = dtof_pkg::HISTOGRAM_WRITE_STAGE - 1;

  logic primed_q, active_q, first_acq_q;
  logic [dtof_pkg::HISTOGRAM_WRITE_STAGE:1] beat_tn_q;  // a timestamp is in stage Tn
  logic [SLOT_WIDTH-1:0] slot_q;
  logic [ROW_WIDTH-1:0] pixel_q;
  logic [2:0] drain_q;

  logic prime, at_start, beat, first_slot, last_slot, last_pixel;
  logic [ROW_WIDTH-1:0] next_pixel;

  assign prime = stream_i && !primed_q;
  assign first_slot = (slot_q == '0);
  assign last_slot = (slot_q == LAST_SLOT);
  assign last_pixel = (pixel_q == LAST_PIXEL);
  assign at_start = stream_i && primed_q && first_slot && !active_q && more_i;
  assign tdc_ready_o = active_q || at_start;
  assign beat = active_q || (at_start && tdc_valid_i);
  assign acq_done_o = beat && last_slot && last_pixel;
  assign next_pixel = last_pixel ? '0 : pixel_q + 1'b1;
  assign idle_o = (drain_q == '0);

  assign fetch_o = prime || (beat && ((FETCH_ON_FIRST_SLOT != 0) ? first_slot : last_slot));
  assign fetch_pixel_o = prime ? '0 : next_pixel;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      primed_q <= 1'b0;
      active_q <= 1'b0;
      first_acq_q <= 1'b0;
      slot_q <= '0;
      pixel_q <= '0;
      drain_q <= '0;
    end else begin
      primed_q <= stream_i;
      if (!stream_i) begin
        slot_q <= '0;
        first_acq_q <= 1'b1;
        drain_q <= 3'(DRAIN_CLOCKS);
      end else begin
        slot_q <= last_slot ? '0 : slot_q + 1'b1;
        if (acq_done_o) begin
          first_acq_q <= 1'b0;
        end
        if (more_i || beat) begin
          drain_q <= 3'(DRAIN_CLOCKS);
        end else if (drain_q != '0) begin
          drain_q <= drain_q - 1'b1;
        end
      end
      if (beat) begin
        active_q <= !acq_done_o;
        if (last_slot) begin
          pixel_q <= next_pixel;
        end
      end
    end
  end

  // Inside an acquisition, a clock without tdc_valid_i counts as "no detection".
  assign underrun_o = active_q && !tdc_valid_i;
  `DTOF_ASSERT(a_contiguous_acquisition, !underrun_o,
               "tdc_valid_i fell inside an acquisition")

  `DTOF_ASSERT(a_pass_complete, stream_i || (beat_tn_q == '0), "a pass ended with timestamps in the pipeline")

  // Copies of valid flag, pixel and slot for the stages T1 to T5.
  logic [2:1] last_slot_tn_q;
  logic visit_t1_q, first_acq_t1_q;
  logic [ROW_WIDTH-1:0] pixel_t1_q, pixel_t2_q, pixel_t3_q, pixel_t4_q, pixel_t5_q;
  logic [3:1] same_pixel_t3_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      beat_tn_q <= '0;
      visit_t1_q <= 1'b0;
      last_slot_tn_q <= '0;
    end else begin
      beat_tn_q <= {beat_tn_q[4:1], beat && tdc_valid_i};
      visit_t1_q <= beat && first_slot;
      last_slot_tn_q <= {last_slot_tn_q[1], beat && last_slot};
    end
  end

  always_ff @(posedge clk_i) begin
    first_acq_t1_q <= first_acq_q;
    pixel_t1_q <= pixel_q;
    pixel_t2_q <= pixel_t1_q;
    pixel_t3_q <= pixel_t2_q;
    pixel_t4_q <= pixel_t3_q;
    pixel_t5_q <= pixel_t4_q;
    same_pixel_t3_q[1] <= beat_tn_q[3] && (pixel_t3_q == pixel_t2_q);
    same_pixel_t3_q[2] <= beat_tn_q[4] && (pixel_t4_q == pixel_t2_q);
    same_pixel_t3_q[3] <= beat_tn_q[5] && (pixel_t5_q == pixel_t2_q);
  end

  assign beat_t1_o = beat_tn_q[1];
  assign first_slot_t0_o = first_slot;
  assign visit_t1_o = visit_t1_q;
  assign first_acq_t1_o = first_acq_t1_q;
  assign last_slot_t2_o = last_slot_tn_q[2];
  assign pixel_t2_o = pixel_t2_q;
  assign same_pixel_t3_o = same_pixel_t3_q;
  assign beat_t5_o = beat_tn_q[5];
  assign pixel_t5_o = pixel_t5_q;

endmodule

`default_nettype wire
