// SPDX-License-Identifier: Apache-2.0
// One link of the chain that tells of full counters: what happens in this column or any behind it moves one column on in
// a clock. Nothing stops the chain, and two columns whose counters get full in clocks that meet in a link give one event.
module dtof_full_counter_link (
    input  logic clk_i,
    input  logic rst_ni,         // an event that never happened must not leave the array behind power-up
    input  logic full_i,         // a counter of this column gets full
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
