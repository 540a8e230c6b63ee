// SPDX-License-Identifier: Apache-2.0
// Max-product messages along a chain of pixels, each with a few labels: the arithmetic of one engine.
//
// Equations (docs/reference/poolpointer.md, Chain): T(k) = evidence(k) - u(k), where u >= 0 is the message to this pixel from the
// pixel before. Message to label l of the next pixel: min(penalty, min of (max T - T(k)) over all k near l). Labels are near each
// other if their positions are at most REACH apart. belief(k) = T(k) - u'(k), where u' is the message from the other direction.
//
// 1. The registers hold two pixels: this pixel and the next pixel. begin_step registers T of this pixel; the largest T follows in
//    two more clocks.
// 2. spread registers by how much each label's T is below the largest T, limited to the penalty.
// 3. pass_label handles one label number per clock: the next pixel's label gets its message, and this pixel's label gets its
//    belief. One clock later the belief is compared with the best two beliefs so far.
// 4. advance moves the chain: the next pixel becomes this pixel, and the pixel at the ports becomes the next pixel.
//
// Schedule: the table of dtof_pool_sequencer.
// Latency (dtof_pkg): POOL_CHAIN_SPREAD_CLOCKS from begin_step to spread, POOL_CHAIN_TARGET_CLOCKS from a label's target to its
//   pass_label, POOL_CHAIN_BELIEF_CLOCKS from the last pass_label to the best two beliefs.
// Cost: LABELS comparators of positions and LABELS subtractors of sums.

`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_label_chain `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int LABELS = 8,           // labels of a pixel
    parameter int POSITION_WIDTH = 8,   // bits of a label's position, signed
    parameter int REACH = 4,            // labels whose positions are at most this far apart are near
    parameter int EVIDENCE_WIDTH = 6,   // bits of a label's evidence, signed
    parameter int PENALTY_WIDTH = 5,    // bits of the penalty and of messages, unsigned
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int BELIEF_WIDTH = EVIDENCE_WIDTH + 2
) (
    input  logic                             clk_i,
    input  logic                             active_i,   // high during the whole operation; while low, registers hold
    input  `DTOF_TYPE(dtof_pool_pkg, chain_command_t) command_i,
    // pixel to prepare, loaded with advance
    input  logic [LABELS*EVIDENCE_WIDTH-1:0] evidence_i,
    input  logic [LABELS*POSITION_WIDTH-1:0] position_i,
    input  logic [        PENALTY_WIDTH-1:0] penalty_i,
    // messages to this pixel. message_o: from the pass in work, complete from the last label until the first label of the next step.
    // other_message_i: from the opposite pass, loaded with advance
    output logic [ LABELS*PENALTY_WIDTH-1:0] message_o,
    input  logic [ LABELS*PENALTY_WIDTH-1:0] other_message_i,
    // best two labels, valid POOL_CHAIN_BELIEF_CLOCKS after the last label, until the next labels pass
    output logic [          LABEL_WIDTH-1:0] best_label_o,
    output logic [          LABEL_WIDTH-1:0] second_label_o,
    output logic [       POSITION_WIDTH-1:0] best_position_o,
    output logic [       POSITION_WIDTH-1:0] second_position_o,
    output logic [         BELIEF_WIDTH-1:0] margin_o          // best belief minus second belief, unsigned
);

  localparam logic signed [POSITION_WIDTH:0] FAR = (POSITION_WIDTH + 1)'(REACH);

  logic [LABELS*EVIDENCE_WIDTH-1:0] evidence_q, next_evidence_q;
  logic [LABELS*POSITION_WIDTH-1:0] position_q, next_position_q;
  logic [PENALTY_WIDTH-1:0] penalty_q, next_penalty_q;
  logic [LABELS*PENALTY_WIDTH-1:0] message_q, other_q;

  always_ff @(posedge clk_i) begin
    if (command_i.advance) begin
      evidence_q <= next_evidence_q;
      position_q <= next_position_q;
      penalty_q <= next_penalty_q;
      next_evidence_q <= evidence_i;
      next_position_q <= position_i;
      next_penalty_q <= penalty_i;
      other_q <= other_message_i;
    end
  end

  // T, the largest T, and each label's distance below the largest T, limited to the penalty.

  logic [LABELS*BELIEF_WIDTH-1:0] sum, sum_q;
  logic [BELIEF_WIDTH-1:0] largest_q;
  logic [LABELS*PENALTY_WIDTH-1:0] behind, behind_q;

  genvar k;
  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_label
      logic signed [BELIEF_WIDTH-1:0] evidence, received;
      logic [BELIEF_WIDTH-1:0] difference;
      assign evidence = $signed({{2{evidence_q[(k+1)*EVIDENCE_WIDTH-1]}}, evidence_q[k*EVIDENCE_WIDTH+:EVIDENCE_WIDTH]});
      assign received = $signed(BELIEF_WIDTH'(message_q[k*PENALTY_WIDTH+:PENALTY_WIDTH]));
      assign sum[k*BELIEF_WIDTH+:BELIEF_WIDTH] = evidence - received;
      assign difference = largest_q - sum_q[k*BELIEF_WIDTH+:BELIEF_WIDTH];
      assign behind[k*PENALTY_WIDTH+:PENALTY_WIDTH] =
          (difference < BELIEF_WIDTH'(penalty_q)) ? difference[PENALTY_WIDTH-1:0] : penalty_q;
    end
  endgenerate

  // The largest T is the complement of the smallest complement. Complementing all bits but the sign bit reverses the order of the
  // signed sums and makes them unsigned.
  logic [LABELS*BELIEF_WIDTH-1:0] complement;
  logic [BELIEF_WIDTH-1:0] smallest_complement;

  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_complement
      logic [BELIEF_WIDTH-1:0] term;
      assign term = sum_q[k*BELIEF_WIDTH+:BELIEF_WIDTH];
      assign complement[k*BELIEF_WIDTH+:BELIEF_WIDTH] = {term[BELIEF_WIDTH-1], ~term[BELIEF_WIDTH-2:0]};
    end
  endgenerate

  localparam int LOWER = (LABELS + 1) / 2;
  logic [BELIEF_WIDTH-1:0] smallest_lower, smallest_upper, smallest_lower_q, smallest_upper_q;

  dtof_minimum #(
      .NUMBER(LOWER),
      .WIDTH (BELIEF_WIDTH)
  ) u_largest_of_lower (
      .values_i  (complement[LOWER*BELIEF_WIDTH-1:0]),
      .smallest_o(smallest_lower)
  );

  dtof_minimum #(
      .NUMBER(LABELS - LOWER),
      .WIDTH (BELIEF_WIDTH)
  ) u_largest_of_upper (
      .values_i  (complement[LABELS*BELIEF_WIDTH-1:LOWER*BELIEF_WIDTH]),
      .smallest_o(smallest_upper)
  );

  assign smallest_complement = (smallest_lower_q < smallest_upper_q) ? smallest_lower_q : smallest_upper_q;

  always_ff @(posedge clk_i) begin
    if (command_i.begin_step) begin
      sum_q <= sum;
    end
    if (active_i) begin
      smallest_lower_q <= smallest_lower;
      smallest_upper_q <= smallest_upper;
      largest_q <= {smallest_complement[BELIEF_WIDTH-1], ~smallest_complement[BELIEF_WIDTH-2:0]};
    end
    if (command_i.spread) begin
      behind_q <= behind;
    end
  end

  // Message to one label of the next pixel. The label's position is registered two clocks before, and the set of labels near it one
  // clock before.

  logic [LABELS-1:0] near, near_q;
  logic [LABEL_WIDTH-1:0] target;
  logic [POSITION_WIDTH-1:0] target_q;
  logic [PENALTY_WIDTH-1:0] cheapest;

  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_near
      logic signed [POSITION_WIDTH:0] distance;
      assign distance = $signed({position_q[(k+1)*POSITION_WIDTH-1], position_q[k*POSITION_WIDTH+:POSITION_WIDTH]})
          - $signed({target_q[POSITION_WIDTH-1], target_q});
      assign near[k] = (distance <= FAR) && (distance >= -FAR);
    end
  endgenerate

  assign target = LABEL_WIDTH'(command_i.target);

  logic [LABELS*PENALTY_WIDTH-1:0] reachable;
  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_reachable
      assign reachable[k*PENALTY_WIDTH+:PENALTY_WIDTH] = near_q[k] ? behind_q[k*PENALTY_WIDTH+:PENALTY_WIDTH] : penalty_q;
    end
  endgenerate

  dtof_minimum #(
      .NUMBER(LABELS),
      .WIDTH (PENALTY_WIDTH)
  ) u_nearest (
      .values_i  (reachable),
      .smallest_o(cheapest)
  );

  always_ff @(posedge clk_i) begin
    if (active_i) begin
      target_q <= next_position_q[target*POSITION_WIDTH+:POSITION_WIDTH];
      near_q <= near;
    end
    if (command_i.advance && command_i.clear_message) begin
      message_q <= '0;
    end else if (command_i.pass_label) begin
      message_q <= {cheapest, message_q[LABELS*PENALTY_WIDTH-1:PENALTY_WIDTH]};
    end
  end

  assign message_o = message_q;

  // Best two beliefs; on a tie the label with the lower number.

  logic signed [BELIEF_WIDTH-1:0] belief_q, best_q, second_q;
  logic [LABEL_WIDTH-1:0] passing_q, label_q, best_label_q, second_label_q;
  logic [POSITION_WIDTH-1:0] passed_position_q, best_position_q, second_position_q;
  logic passed_q, better, runner_up;

  assign better = (label_q == '0) || (belief_q > best_q);
  assign runner_up = (label_q == LABEL_WIDTH'(1)) || (belief_q > second_q);

  always_ff @(posedge clk_i) begin
    if (active_i) begin
      passing_q <= command_i.spread ? '0 : passing_q + 1'b1;
      passed_q <= command_i.pass_label;
      label_q <= passing_q;
      passed_position_q <= position_q[passing_q*POSITION_WIDTH+:POSITION_WIDTH];
      belief_q <= $signed(sum_q[passing_q*BELIEF_WIDTH+:BELIEF_WIDTH])
          - $signed(BELIEF_WIDTH'(other_q[passing_q*PENALTY_WIDTH+:PENALTY_WIDTH]));
      if (passed_q) begin
        if (better) begin
          best_q <= belief_q;
          best_label_q <= label_q;
          best_position_q <= passed_position_q;
          second_q <= best_q;
          second_label_q <= best_label_q;
          second_position_q <= best_position_q;
        end else if (runner_up) begin
          second_q <= belief_q;
          second_label_q <= label_q;
          second_position_q <= passed_position_q;
        end
      end
    end
  end

  assign best_label_o = best_label_q;
  assign second_label_o = second_label_q;
  assign best_position_o = best_position_q;
  assign second_position_o = second_position_q;
  assign margin_o = best_q - second_q;

endmodule

`default_nettype wire
