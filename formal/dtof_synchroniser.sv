// SPDX-License-Identifier: Apache-2.0
// Synchroniser for proofs: a bit that changes in the step of a clock edge is captured before or after its change, each bit on its own.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_synchroniser #(
    parameter int WIDTH = 1,
    parameter logic [WIDTH-1:0] RESET_VALUE = '0
) (
    input  logic             clk_i,
    input  logic             rst_ni,
    input  logic [WIDTH-1:0] d_i,
    output logic [WIDTH-1:0] q_o
);

  logic clk_q;
  logic [WIDTH-1:0] before_q, meta_q, stable_q, changed;

  arbitrary_value #(.WIDTH(WIDTH)) u_changed (.value_o(changed));

  always @($global_clock) begin
    clk_q <= clk_i;
    before_q <= d_i;
    if (!rst_ni) begin
      meta_q <= RESET_VALUE;
    end else if (clk_i && !clk_q) begin
      meta_q <= (changed & d_i) | (~changed & before_q);
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      stable_q <= RESET_VALUE;
    end else begin
      stable_q <= meta_q;
    end
  end

  assign q_o = stable_q;

endmodule

`default_nettype wire
