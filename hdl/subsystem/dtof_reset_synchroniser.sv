// SPDX-License-Identifier: Apache-2.0
// Synchronises the release of a reset to a clock. Place one in front of rst_ni of dtof_subsystem or of an array, one per clock.
//
// rst_no falls with rst_ni at once, even without a clock, and rises at the second clock edge after rst_ni has risen. With scan_mode_i
// rst_no is rst_ni itself, so that a tester controls the reset from a pin; scan_mode_i changes only while rst_ni is low.
// Latency: two clocks to release.
// Cost: two flip-flops, a multiplexer.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_reset_synchroniser (
    input  logic clk_i,
    input  logic rst_ni,       // asynchronous to clk_i
    input  logic scan_mode_i,
    output logic rst_no        // released synchronously to clk_i
);

  logic [1:0] released_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      released_q <= '0;
    end else begin
      released_q <= {released_q[0], 1'b1};
    end
  end

  assign rst_no = scan_mode_i ? rst_ni : released_q[1];

endmodule

`default_nettype wire
