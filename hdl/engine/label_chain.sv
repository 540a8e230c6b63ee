// SPDX-License-Identifier: Apache-2.0
// Max-product messages along a chain of pixels, each with a few labels: one engine's arithmetic.
//
// Equations (docs/reference/poolpointer.md, Chain): T(k) = evidence(k) - u(k), u >= 0 the message received; message to
// label l of the next pixel: min(penalty, min over its near k of max T - T(k)). belief(k) = T(k) - u'(k), u' the
// message from the other side. Near: positions at most REACH apart.
//
// Schedule: engine_sequencer. begin_i: T; its largest, in two clocks; spread_i: differences to it; then a label l of
//   the next pixel a clock with pass_label_i, which also computes the belief of this pixel's label l, ranked one clock later;
//   advance_i: the next pixel becomes this one and the prepared one the next. The two best beliefs are valid from the
//   second clock after the last label until the next pixel's labels pass.
// Cost: LABELS comparators of positions and of differences.
module label_chain #(
    parameter int LABELS = 8,
    parameter int POSITION_WIDTH = 8,   // signed
    parameter int REACH = 4,
    parameter int EVIDENCE_WIDTH = 6,   // signed
    parameter int PENALTY_WIDTH = 5,
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int BELIEF_WIDTH = EVIDENCE_WIDTH + 2
) (
    input  logic                             clk_i,
    input  logic                             begin_i,
    input  logic                             spread_i,
    input  logic                             pass_label_i,
    input  logic [          LABEL_WIDTH-1:0] target_label_i,   // the label two clocks later
    input  logic                             advance_i,
    input  logic                             clear_message_i,  // with advance_i: this pixel begins the chain
    // a pixel prepared
    input  logic [               LABELS-1:0] in_use_i,
    input  logic [LABELS*EVIDENCE_WIDTH-1:0] evidence_i,
    input  logic [LABELS*POSITION_WIDTH-1:0] position_i,
    input  logic [        PENALTY_WIDTH-1:0] penalty_i,
    // messages: received, and of the other side
    output logic [ LABELS*PENALTY_WIDTH-1:0] message_o,
    input  logic [ LABELS*PENALTY_WIDTH-1:0] other_message_i,  // with advance_i
    // result
    output logic [          LABEL_WIDTH-1:0] best_label_o,
    output logic [          LABEL_WIDTH-1:0] second_label_o,
    output logic [       POSITION_WIDTH-1:0] best_position_o,
    output logic [       POSITION_WIDTH-1:0] second_position_o,
    output logic [         BELIEF_WIDTH-1:0] margin_o          // unsigned
);

  localparam logic signed [POSITION_WIDTH:0] FAR = (POSITION_WIDTH + 1)'(REACH);

  logic [LABELS-1:0] in_use_q, next_in_use_q;
  logic [LABELS*EVIDENCE_WIDTH-1:0] evidence_q, next_evidence_q;
  logic [LABELS*POSITION_WIDTH-1:0] position_q, next_position_q;
  logic [PENALTY_WIDTH-1:0] penalty_q, next_penalty_q;
  logic [LABELS*PENALTY_WIDTH-1:0] message_q, other_q;

  always_ff @(posedge clk_i) begin
    if (advance_i) begin
      in_use_q <= next_in_use_q;
      evidence_q <= next_evidence_q;
      position_q <= next_position_q;
      penalty_q <= next_penalty_q;
      next_in_use_q <= in_use_i;
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
          (in_use_q[k] && difference < BELIEF_WIDTH'(penalty_q)) ? difference[PENALTY_WIDTH-1:0] : penalty_q;
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
      assign complement[k*BELIEF_WIDTH+:BELIEF_WIDTH] =
          in_use_q[k] ? {term[BELIEF_WIDTH-1], ~term[BELIEF_WIDTH-2:0]} : '1;
    end
  endgenerate

  localparam int LOWER = (LABELS + 1) / 2;
  logic [BELIEF_WIDTH-1:0] smallest_lower, smallest_upper, smallest_lower_q, smallest_upper_q;

  minimum #(
      .NUMBER(LOWER),
      .WIDTH (BELIEF_WIDTH)
  ) u_largest_of_lower (
      .values_i  (complement[LOWER*BELIEF_WIDTH-1:0]),
      .smallest_o(smallest_lower)
  );

  minimum #(
      .NUMBER(LABELS - LOWER),
      .WIDTH (BELIEF_WIDTH)
  ) u_largest_of_upper (
      .values_i  (complement[LABELS*BELIEF_WIDTH-1:LOWER*BELIEF_WIDTH]),
      .smallest_o(smallest_upper)
  );

  assign smallest_complement = (smallest_lower_q < smallest_upper_q) ? smallest_lower_q : smallest_upper_q;

  always_ff @(posedge clk_i) begin
    if (begin_i) begin
      sum_q <= sum;
    end
    smallest_lower_q <= smallest_lower;
    smallest_upper_q <= smallest_upper;
    largest_q <= {smallest_complement[BELIEF_WIDTH-1], ~smallest_complement[BELIEF_WIDTH-2:0]};
    if (spread_i) begin
      behind_q <= behind;
    end
  end

  // The message to one label of the next pixel. Its position is fetched two clocks ahead, and which labels are near
  // it found one clock ahead.

  logic [LABELS-1:0] near, near_q;
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

  logic [LABELS*PENALTY_WIDTH-1:0] reachable;
  generate
    for (k = 0; k < LABELS; k = k + 1) begin : g_reachable
      assign reachable[k*PENALTY_WIDTH+:PENALTY_WIDTH] = near_q[k] ? behind_q[k*PENALTY_WIDTH+:PENALTY_WIDTH] : penalty_q;
    end
  endgenerate

  minimum #(
      .NUMBER(LABELS),
      .WIDTH (PENALTY_WIDTH)
  ) u_nearest (
      .values_i  (reachable),
      .smallest_o(cheapest)
  );

  always_ff @(posedge clk_i) begin
    target_q <= next_position_q[target_label_i*POSITION_WIDTH+:POSITION_WIDTH];
    near_q <= near;
    if (advance_i && clear_message_i) begin
      message_q <= '0;
    end else if (pass_label_i) begin
      message_q <= {cheapest, message_q[LABELS*PENALTY_WIDTH-1:PENALTY_WIDTH]};
    end
  end

  assign message_o = message_q;

  // The two best beliefs, the lower label on a tie.

  logic signed [BELIEF_WIDTH-1:0] belief_q, best_q, second_q;
  logic [LABEL_WIDTH-1:0] passing_q, label_q, best_label_q, second_label_q;
  logic [POSITION_WIDTH-1:0] passed_position_q, best_position_q, second_position_q;
  logic passed_q, passed_in_use_q, better, runner_up;

  assign better = (label_q == '0) || (passed_in_use_q && belief_q > best_q);
  assign runner_up = (label_q == LABEL_WIDTH'(1)) || (passed_in_use_q && belief_q > second_q);

  always_ff @(posedge clk_i) begin
    passing_q <= spread_i ? '0 : passing_q + 1'b1;
    passed_q <= pass_label_i;
    label_q <= passing_q;
    passed_in_use_q <= in_use_q[passing_q];
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

  assign best_label_o = best_label_q;
  assign second_label_o = second_label_q;
  assign best_position_o = best_position_q;
  assign second_position_o = second_position_q;
  assign margin_o = best_q - second_q;

endmodule
