// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_saturating_counter: the count is the sum of all steps since reset, or the largest value.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module saturating_counter_properties #(
    parameter int WIDTH = 4,
    parameter int STEP_WIDTH = 2
) (
    input logic                  clk_i,
    input logic                  reset_i,
    input logic [STEP_WIDTH-1:0] step_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic [WIDTH-1:0] count;

  dtof_saturating_counter #(
      .WIDTH     (WIDTH),
      .STEP_WIDTH(STEP_WIDTH)
  ) u_dut (
      .clk_i  (clk_i),
      .rst_ni (rst_n),
      .step_i (step_i),
      .count_o(count)
  );

  logic [STEP_WIDTH-1:0] step_q;
  logic [15:0] sum_q;
  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      step_q <= '0;
      sum_q <= '0;
    end else begin
      step_q <= step_i;
      if (sum_q < 16'd1000) begin
        sum_q <= sum_q + 16'(step_q);
      end
    end
  end

  localparam logic [15:0] LARGEST = 16'((32'd1 << WIDTH) - 1);
  `PROVE(a_count, !rst_n || 16'(count) == ((sum_q > LARGEST) ? LARGEST : sum_q))
  `GOAL(rst_n && sum_q > LARGEST)

endmodule

`default_nettype wire
