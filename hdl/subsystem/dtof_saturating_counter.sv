// SPDX-License-Identifier: Apache-2.0
// Counts events since reset, several per clock, and stays at its largest value.
//
// Equation: count' = min(count + step, 2^WIDTH - 1).
// Schedule: clock 0 the step arrives, clock 1 the step is registered, clock 2 the count is registered. Latency: 2 clocks.
// Cost: WIDTH + STEP_WIDTH flip-flops, an adder of WIDTH bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_saturating_counter #(
    parameter int WIDTH = 32,
    parameter int STEP_WIDTH = 1  // at most WIDTH
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    input  logic [STEP_WIDTH-1:0] step_i,
    output logic [     WIDTH-1:0] count_o
);

  logic [STEP_WIDTH-1:0] step_q;
  logic [WIDTH-1:0] count_q;
  logic [WIDTH:0] sum;

  assign sum = {1'b0, count_q} + (WIDTH + 1)'(step_q);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      step_q <= '0;
      count_q <= '0;
    end else begin
      step_q <= step_i;
      count_q <= sum[WIDTH] ? {WIDTH{1'b1}} : sum[WIDTH-1:0];
    end
  end

  assign count_o = count_q;

endmodule

`default_nettype wire
