// SPDX-License-Identifier: Apache-2.0
// A reset of one side of dtof_async_line_fifo lasts at least CLOCKS clocks of the other side, as an assertion for simulators. Synthesis does
// not read this folder.
//
// Assertion: when the reset ends, at least CLOCKS edges of the other side's clock have come during the reset.
// Source: docs/user/integration.md, obligations.
// Latency: none. Cost: none in silicon.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_reset_length #(
    parameter int CLOCKS = 4,
    parameter string WHOSE = "one side"  // whose reset this is
) (
    input logic clk_other_i,
    input logic rst_ni
);

  localparam int WIDTH = $clog2(CLOCKS + 1);

  logic [WIDTH-1:0] clocks_q;  // edges of the other clock during this reset; the counter saturates at CLOCKS

  always_ff @(posedge clk_other_i or posedge rst_ni) begin
    if (rst_ni) begin
      clocks_q <= '0;
    end else if (clocks_q != WIDTH'(CLOCKS)) begin
      clocks_q <= clocks_q + 1'b1;
    end
  end

  always @(posedge rst_ni) begin
    a_reset_lasts :
    assert (clocks_q == WIDTH'(CLOCKS))
    else $error("%m: the reset of %s lasted fewer than %0d clocks of the other side", WHOSE, CLOCKS);
  end

endmodule

`default_nettype wire
