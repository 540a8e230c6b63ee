// SPDX-License-Identifier: Apache-2.0
// One link of a chain along the columns, SRAMs or engines of an array: an event of this column, or of the column before in the chain, moves
// on by one column per clock. Nothing stops the chain. Two events that meet in a link become one event.
// Latency: 1 clock per column. Cost: with PRESENT = 1 a flip-flop with reset and an OR gate, with PRESENT = 0 nothing.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_event_link #(
    parameter int PRESENT = 1  // 0: no column has an event
) (
    input  logic clk_i,
    input  logic rst_ni,         // for the chain: without a reset the array could report an event after power-up that never happened
    input  logic event_i,        // this column's event
    input  logic next_column_i,  // the next column's link
    output logic event_o
);

  generate
    if (PRESENT != 0) begin : g_link
      logic event_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          event_q <= 1'b0;
        end else begin
          event_q <= event_i || next_column_i;
        end
      end
      assign event_o = event_q;
    end else begin : g_no_link
      logic unused;
      assign unused = ^{clk_i, rst_ni, event_i, next_column_i};
      assign event_o = 1'b0;
    end
  endgenerate

endmodule

`default_nettype wire
