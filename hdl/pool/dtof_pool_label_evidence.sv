// SPDX-License-Identifier: Apache-2.0
// poolPointer, decide: what the group's word says about the winner of a pixel, for its confidence: the significance near the winner, whether
// the background is tilted, and the background.
//
// Equation (docs/reference/poolpointer.md, Confidence): Z, tilted and B >> 2 of the pixel.
//
// 1. advance_i takes the captured pixel's group; in the next clocks dtof_near_significance has the significances near its leader and its rival.
// 2. Each advance_i moves these facts on with the pixel, as in dtof_label_chain: from the prepared pixel to the next pixel, to this pixel,
//    to the pixel before, whose winner is known.
//
// Latency: three advance_i after the one that takes the group; none from rival_wins_i. Cost: two dtof_near_significance; a register of the
// prepared pixel's 5 bits and three of 5 + 2 KEPT_WIDTH bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_label_evidence #(
    parameter int LABELS = 5,
    parameter int KEPT_WIDTH = 3,  // bits of a significance
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH,
    localparam int SKY_WIDTH = dtof_pkg::POOL_SKY_WIDTH
) (
    input  logic                         clk_i,
    input  logic                         advance_i,
    // with advance_i: the captured pixel, which is then prepared
    input  logic [LABELS*CELL_WIDTH-1:0] cells_i,          // of its group
    input  logic [LABELS*KEPT_WIDTH-1:0] significances_i,
    input  logic                         tilted_i,
    input  logic [        SKY_WIDTH-1:0] sky_i,            // background / 4
    input  logic [       CELL_WIDTH-1:0] leader_cell_i,    // cells of its pointers
    input  logic [       CELL_WIDTH-1:0] rival_cell_i,
    // the pixel before
    input  logic                         rival_wins_i,
    output logic [       KEPT_WIDTH-1:0] significance_o,
    output logic                         tilted_o,
    output logic [        SKY_WIDTH-1:0] sky_o
);

  localparam int FACTS_WIDTH = 2 * KEPT_WIDTH + 1 + SKY_WIDTH;  // {significance of the rival, of the leader, tilted, sky}
  logic [KEPT_WIDTH-1:0] leader_significance, rival_significance;
  logic [SKY_WIDTH:0] prepared_sky_q;  // {tilted, sky}
  logic [FACTS_WIDTH-1:0] next_facts_q, facts_q, last_facts_q;

  dtof_near_significance #(
      .LABELS    (LABELS),
      .KEPT_WIDTH(KEPT_WIDTH)
  ) u_leader (
      .clk_i          (clk_i),
      .take_i         (advance_i),
      .cells_i        (cells_i),
      .significances_i(significances_i),
      .cell_i         (leader_cell_i),
      .significance_o (leader_significance)
  );

  dtof_near_significance #(
      .LABELS    (LABELS),
      .KEPT_WIDTH(KEPT_WIDTH)
  ) u_rival (
      .clk_i          (clk_i),
      .take_i         (advance_i),
      .cells_i        (cells_i),
      .significances_i(significances_i),
      .cell_i         (rival_cell_i),
      .significance_o (rival_significance)
  );

  always_ff @(posedge clk_i) begin
    if (advance_i) begin
      prepared_sky_q <= {tilted_i, sky_i};
      {last_facts_q, facts_q, next_facts_q} <= {facts_q, next_facts_q, rival_significance, leader_significance,
                                                prepared_sky_q};
    end
  end

  assign significance_o = rival_wins_i ? last_facts_q[FACTS_WIDTH-1-:KEPT_WIDTH] : last_facts_q[SKY_WIDTH+1+:KEPT_WIDTH];
  assign tilted_o = last_facts_q[SKY_WIDTH];
  assign sky_o = last_facts_q[SKY_WIDTH-1:0];

endmodule

`default_nettype wire
