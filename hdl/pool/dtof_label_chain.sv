// SPDX-License-Identifier: Apache-2.0
// Max-product messages along a chain of pixels, each with a few labels: one engine's arithmetic.
//
// Equations (docs/reference/poolpointer.md, Chain): T(k) = evidence(k) - u(k), u >= 0 the message received; message to
// label l of the next pixel: min(penalty, min over its near k of max T - T(k)). belief(k) = T(k) - u'(k), u' the
// message from the other side. Near: positions at most REACH apart.
//
// 1. Two pixels are held, this one and the next. When a step begins, this pixel's T are added up, and the largest is
//    found in two clocks.
// 2. The differences to the largest say what each label is behind.
// 3. The labels of the next pixel pass, one a clock: each gets its message, and in the same clock this pixel's label of
//    the same number its belief, which is ranked a clock later.
// 4. The chain advances: the next pixel becomes this one, the one at the port the next.
//
// Schedule: the table of dtof_pool_sequencer, with this module's POOL_CHAIN_*_CLOCKS (dtof_pkg).
// Cost: LABELS comparators of positions and of differences.

`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_label_chain `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int LABELS = 8,           // of a pixel
    parameter int POSITION_WIDTH = 8,   // bits of a label's position, signed
    parameter int REACH = 4,            // labels at most so far apart are near
    parameter int EVIDENCE_WIDTH = 6,   // bits of a label's evidence, signed
    parameter int PENALTY_WIDTH = 5,    // bits of the penalty and of messages, unsigned
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int BELIEF_WIDTH = EVIDENCE_WIDTH + 2
) (
    input  logic                             clk_i,
    input  logic                             active_i,   // in all of the operation; otherwise nothing moves
    input  `DTOF_TYPE(dtof_pool_pkg, chain_command_t) command_i,
    // the pixel prepared, taken with advance
    input  logic [LABELS*EVIDENCE_WIDTH-1:0] evidence_i,
    input  logic [LABELS*POSITION_WIDTH-1:0] position_i,
    input  logic [        PENALTY_WIDTH-1:0] penalty_i,
    // messages to this pixel: of the pass in work, complete from the last label on until the next step's first one;
    // from the other side, taken with advance
    output logic [ LABELS*PENALTY_WIDTH-1:0] message_o,
    input  logic [ LABELS*PENALTY_WIDTH-1:0] other_message_i,
    // the best two beliefs, valid from POOL_CHAIN_BELIEF_CLOCKS after the last label until the next labels pass
    output logic [          LABEL_WIDTH-1:0] best_label_o,
    output logic [          LABEL_WIDTH-1:0] second_label_o,
    output logic [       POSITION_WIDTH-1:0] best_position_o,
    output logic [       POSITION_WIDTH-1:0] second_position_o,
    output logic [         BELIEF_WIDTH-1:0] margin_o          // unsigned
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

  // T, its largest, and how far each stays behind, the penalty at most.

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

  // The largest sum is what is left of the smallest complement; complements of sums with the top bit inverted are
  // in the opposite order of the signed sums.
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

  // The message to one label of the next pixel. Its position is fetched two clocks ahead, and which labels are near
  // it found one clock ahead.

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

  // The two best beliefs, the lower label on a tie.

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
