// SPDX-License-Identifier: Apache-2.0
// Takes levels of another clock: two flip-flops a bit. Silicon may replace this module by a library's synchroniser cells; no other file
// changes.
//
// The bits may arrive in different clocks. Only bits that do not depend on each other, or a word of which one bit changes at a time, may share
// an instance.
// Latency: two clocks, or three where a bit changes at a clock edge. Cost: two flip-flops per bit.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_synchroniser #(
    parameter int WIDTH = 1,
    parameter logic [WIDTH-1:0] RESET_VALUE = '0
) (
    input  logic             clk_i,
    input  logic             rst_ni,
    input  logic [WIDTH-1:0] d_i,  // from flip-flops of any clock
    output logic [WIDTH-1:0] q_o
);

  (* ASYNC_REG = "TRUE" *) logic [WIDTH-1:0] meta_q, stable_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      meta_q <= RESET_VALUE;
      stable_q <= RESET_VALUE;
    end else begin
      meta_q <= d_i;
      stable_q <= meta_q;
    end
  end

  assign q_o = stable_q;

endmodule

`default_nettype wire
