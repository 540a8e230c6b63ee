// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pool_light: the harness moves pixels as the chain and dtof_smoothing do, and follows those with one arbitrary background
// and one arbitrary advantage. Both come with the pixel's result; of the advantage nothing is left if its rival wins.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_light_properties #(
    parameter int BACKGROUND_WIDTH = 3,
    parameter int ADVANTAGE_WIDTH = 4,
    localparam int LIGHT_WIDTH = BACKGROUND_WIDTH + ADVANTAGE_WIDTH
) (
    input logic                        clk_i,
    input logic                        advance_i,
    input logic [BACKGROUND_WIDTH-1:0] background_i,
    input logic [ ADVANTAGE_WIDTH-1:0] advantage_i,
    input logic                        take_position_i,
    input logic                        rival_wins_i,
    input logic                        take_result_i
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  (* anyconst *) logic [BACKGROUND_WIDTH-1:0] background;
  (* anyconst *) logic [ADVANTAGE_WIDTH-1:0] advantage;
  logic [LIGHT_WIDTH-1:0] light;

  dtof_pool_light #(
      .BACKGROUND_WIDTH(BACKGROUND_WIDTH),
      .ADVANTAGE_WIDTH (ADVANTAGE_WIDTH)
  ) u_dut (
      .clk_i          (clk_i),
      .advance_i      (advance_i),
      .background_i   (background_i),
      .advantage_i    (advantage_i),
      .take_position_i(take_position_i),
      .rival_wins_i   (rival_wins_i),
      .take_result_i  (take_result_i),
      .light_o        (light)
  );

  // Places of the followed pixels: prepared, next, this and last pixel, row below, centre, result. And whose rival wins.
  logic prepared_q = 1'b0;
  logic next_q = 1'b0;
  logic this_q = 1'b0;
  logic last_q = 1'b0;
  logic below_q = 1'b0;
  logic centre_q = 1'b0;
  logic result_q = 1'b0;
  logic below_wins_q, centre_wins_q, result_wins_q;

  always_ff @(posedge clk_i) begin
    if (advance_i) begin
      prepared_q <= (background_i == background);
      next_q <= prepared_q && (advantage_i == advantage);
      this_q <= next_q;
      last_q <= this_q;
    end
    if (take_position_i) begin
      below_q <= last_q;
      below_wins_q <= rival_wins_i;
      centre_q <= below_q;
      centre_wins_q <= below_wins_q;
    end
    if (take_result_i) begin
      result_q <= centre_q;
      result_wins_q <= centre_wins_q;
    end
  end

  `PROVE(a_background, !result_q || light[LIGHT_WIDTH-1:ADVANTAGE_WIDTH] == background)
  `PROVE(a_advantage, !result_q || light[ADVANTAGE_WIDTH-1:0] == (result_wins_q ? '0 : advantage))
  `GOAL(result_q && result_wins_q && background != '0 && advantage != '0)

endmodule

`default_nettype wire
