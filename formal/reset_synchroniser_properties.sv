// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_reset_synchroniser: rst_no falls with rst_ni in the same moment, with or without a clock; it rises only with an edge of the
// clock, with the second one after the release; it falls at no other time; scan_mode_i connects the reset to the pin. A step of this
// proof is a moment, not a clock: clk_i, rst_ni and scan_mode_i change in any steps.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module reset_synchroniser_properties (
    input logic clk_i,
    input logic rst_ni,
    input logic scan_mode_i
);

  logic released;

  dtof_reset_synchroniser u_dut (
      .clk_i      (clk_i),
      .rst_ni     (rst_ni),
      .scan_mode_i(scan_mode_i),
      .rst_no     (released)
  );

  // The moment before; checking is high from the first reset on.
  logic checking, seen_q = 1'b0;
  logic clk_q, rst_nq, scan_mode_q, released_q;
  logic rises;                                 // an edge of the clock in this moment
  logic [1:0] least, least_q, most, most_q;    // edges since the release, at most 2; one in the moment of the release may count or not
  logic pulse_q;                               // the last reset came after a release, and without an edge of the clock

  assign checking = seen_q || !rst_ni;
  assign rises = clk_i && !clk_q;
  assign least = !rst_ni ? '0 : (least_q == 2'd2) ? 2'd2 : least_q + 2'(rises && rst_nq);
  assign most = !rst_ni ? '0 : (most_q == 2'd2) ? 2'd2 : most_q + 2'(rises);

  always @($global_clock) begin
    seen_q <= checking;
    clk_q <= clk_i;
    rst_nq <= rst_ni;
    scan_mode_q <= scan_mode_i;
    released_q <= released;
    least_q <= least;
    most_q <= most;
    if (released) pulse_q <= 1'b1;
    else if (!rst_ni && rises) pulse_q <= 1'b0;
  end

  `ASSUME(m_scan_mode, !seen_q || scan_mode_i == scan_mode_q || !(rst_ni || rst_nq))
  `PROVE(a_falls_at_once, rst_ni || !released)
  `PROVE(a_falls_with_the_reset, !(released_q && !released) || !rst_ni)
  `PROVE(a_rises_with_the_clock, !(released && !released_q) || scan_mode_i || rises)
  `PROVE(a_not_before_the_second_edge, scan_mode_i || !released || most == 2'd2)
  `PROVE(a_with_the_second_edge, !rst_ni || least != 2'd2 || released)
  `PROVE(a_scan_mode, !scan_mode_i || released == rst_ni)
  `GOAL(seen_q && rst_ni && released && !released_q && !scan_mode_i && pulse_q)

endmodule

`default_nettype wire
