// SPDX-License-Identifier: Apache-2.0
// poolPointer, AMPLITUDE = 1: the background of each pixel's group and the advantage of the pixel's leader, beside decide's chain and
// dtof_smoothing, up to the pixel's result.
//
// The advantage counts hits of the leader. If the rival wins, nothing is known about its light, and 0 takes the advantage's place.
//
// 1. Each advance_i moves the pixels on, as in dtof_label_chain: from the prepared pixel to the next pixel, to this pixel, to the pixel before.
// 2. take_position_i moves the pixel before to the row below, as in dtof_smoothing, and the row below to the row in the centre.
// 3. take_result_i registers the row in the centre for the result.
//
// Schedule: the table of dtof_pool_sequencer. Latency: 1 clock from take_result_i to light_o, which holds until the next take_result_i.
// Cost: six registers of both numbers, without the advantage of the first one, per engine.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_light #(
    parameter int BACKGROUND_WIDTH = 6,  // bits of a group's background that its word stores
    parameter int ADVANTAGE_WIDTH = 7,
    localparam int LIGHT_WIDTH = BACKGROUND_WIDTH + ADVANTAGE_WIDTH
) (
    input  logic                        clk_i,
    input  logic                        advance_i,
    input  logic [BACKGROUND_WIDTH-1:0] background_i,     // of the pixel that becomes the prepared pixel
    input  logic [ ADVANTAGE_WIDTH-1:0] advantage_i,      // of the prepared pixel
    input  logic                        take_position_i,
    input  logic                        rival_wins_i,     // with take_position_i: the rival of the pixel before wins
    input  logic                        take_result_i,
    output logic [     LIGHT_WIDTH-1:0] light_o           // {background, advantage}
);

  logic [BACKGROUND_WIDTH-1:0] prepared_q;
  logic [LIGHT_WIDTH-1:0] next_q, this_q, last_q, below_q, centre_q;

  always_ff @(posedge clk_i) begin
    if (advance_i) begin
      prepared_q <= background_i;
      next_q <= {prepared_q, advantage_i};
      this_q <= next_q;
      last_q <= this_q;
    end
    if (take_position_i) begin
      below_q <= {last_q[LIGHT_WIDTH-1:ADVANTAGE_WIDTH], last_q[ADVANTAGE_WIDTH-1:0] & {ADVANTAGE_WIDTH{!rival_wins_i}}};
      centre_q <= below_q;
    end
    if (take_result_i) begin
      light_o <= centre_q;
    end
  end

endmodule

`default_nettype wire
