// SPDX-License-Identifier: Apache-2.0
// Drops the acquisitions at a frame's start, in which a laser settles. The array receives the acquisitions after them.
//
// 1. Each frame drops its first settle_i acquisitions. A dropped acquisition begins to leave the line buffer in a clock in which the array is
//    ready to begin an acquisition, and leaves at a line per clock (takes_o). drops_o hides its lines from the array. A late line inside a
//    dropped acquisition does not stop the array's clock.
// 2. abort_i ends the dropping at once; give_up_i (the source is dead) ends it after the last line of an acquisition that has begun.
//
// Latency: none; drops_o comes from a flip-flop, takes_o from two flip-flops and a gate.
// Cost: 19 flip-flops, a decrementer and a comparator of 16 bits.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_settle #(
    parameter int WIDTH = 16
) (
    input  logic             clk_i,
    input  logic             rst_ni,
    input  logic [WIDTH-1:0] settle_i,  // acquisitions, sampled with begin_i
    input  logic             begin_i,   // a frame begins
    input  logic             abort_i,   // the frame ends now
    input  logic             give_up_i, // the frame takes no more lines of the source
    // from an acquisition that leaves the line buffer
    input  logic             first_i,   // its first line is taken
    input  logic             last_i,    // its last line is taken
    output logic             drops_o,   // the acquisition that leaves the line buffer now or next is dropped
    output logic             takes_o    // a dropped acquisition is leaving: its lines are taken, whether the array is ready or not
);

  logic [WIDTH-1:0] left_q;  // acquisitions still to drop, including the one that is leaving, and the one that ended in the last clock
  logic ended_q;             // left_q is one too many: last_i comes late in its clock, so the counter follows a clock later
  logic drops_q;             // acquisitions are left
  logic only;                // one acquisition is left
  logic inside_q;            // an acquisition is leaving

  assign only = (left_q == (ended_q ? WIDTH'(2) : WIDTH'(1)));
  assign drops_o = drops_q;
  assign takes_o = drops_q && inside_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      left_q <= '0;
      ended_q <= 1'b0;
      drops_q <= 1'b0;
      inside_q <= 1'b0;
    end else begin
      inside_q <= (first_i || inside_q) && !last_i && !abort_i;
      ended_q <= drops_q && last_i && !abort_i && !begin_i && !give_up_i;
      if (abort_i) begin
        left_q <= '0;
        drops_q <= 1'b0;
      end else if (begin_i) begin
        left_q <= settle_i;
        drops_q <= (settle_i != '0);
      end else if (give_up_i) begin
        left_q <= WIDTH'(takes_o);
        drops_q <= takes_o;
      end else begin
        if (ended_q) begin
          left_q <= left_q - 1'b1;
        end
        if (last_i && only) begin
          drops_q <= 1'b0;
        end
      end
    end
  end

  `DTOF_ASSERT(a_begin_between, !begin_i || !inside_q, "a frame begins inside an acquisition")
  `DTOF_ASSERT(a_drops_what_is_left, drops_q == (left_q != WIDTH'(ended_q)), "drops_o differs from the number of acquisitions that are left")
  `DTOF_ASSERT(a_give_up_waits, !give_up_i || !(first_i || last_i), "a line is taken in the clock in which the source is given up")

endmodule

`default_nettype wire
