// SPDX-License-Identifier: Apache-2.0
// One link of the chain of full counters: an event of this column, or of the column before in the chain, moves on by one column per
// clock. Nothing stops the chain. Two events that meet in a link become one event.
// Latency: 1 clock per column. Cost: a flip-flop with reset and an OR gate.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_full_counter_link (
    input  logic clk_i,
    input  logic rst_ni,         // for the chain: without a reset the array could report an event after power-up that never happened
    input  logic full_i,         // a counter of this column is full now
    input  logic next_column_i,  // the next column's link
    output logic full_o
);

  logic full_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      full_q <= 1'b0;
    end else begin
      full_q <= full_i || next_column_i;
    end
  end

  assign full_o = full_q;

endmodule

`default_nettype wire
