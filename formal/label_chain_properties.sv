// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_label_chain, with two labels and three pixels, driven by dtof_pool_sequencer and with the messages in an SRAM as in
// dtof_pool_engine: best label and margin of every pixel are those of a search over all eight assignments. A pair of neighbours that disagree
// costs the penalty of the pixel that is farther from the pixel of the result (docs/reference/poolpointer.md, Chain: the sender's lambda).
`include "dtof_macros.svh"
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module label_chain_properties `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int EVIDENCE_WIDTH = 3,
    parameter int POSITION_WIDTH = 3,
    parameter int PENALTY_WIDTH = 2,
    parameter int REACH = 1,
    localparam int PIXELS = 3,
    localparam int LABELS = 2,
    localparam int BELIEF_WIDTH = EVIDENCE_WIDTH + 2
) (
    input logic clk_i
);

  logic checking = 1'b0;
  logic begun_q;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
    begun_q <= checking;
  end

  (* anyconst *) logic [PIXELS*LABELS*EVIDENCE_WIDTH-1:0] evidence;
  (* anyconst *) logic [PIXELS*LABELS*POSITION_WIDTH-1:0] position;
  (* anyconst *) logic [PIXELS*PENALTY_WIDTH-1:0] penalty;

  `DTOF_TYPE(dtof_pool_pkg, pool_engine_command_t) command;
  logic [1:0] scratch_row;
  logic unused_done, unused_select, unused_read, unused_write, unused_upper, unused_neighbour, unused_column, unused_send,
      unused_send_column, unused_last;
  logic [1:0] unused_row;
  logic [1:0] unused_address;

  dtof_pool_sequencer #(
      .PIXELS_PER_SRAM(PIXELS),
      .GROUP_SIZE     (4),
      .LABELS         (LABELS),
      .LINE_HALVES    (1),
      .ENGINE_COLUMNS (1)
  ) u_sequencer (
      .clk_i        (clk_i),
      .rst_ni       (checking),
      .decode_i     (1'b0),
      .choose_i     (1'b0),
      .decide_i     (checking && !begun_q),
      .prior_i      (1'b0),
      .done_o       (unused_done),
      .read_d_o     (unused_read),
      .write_d_o    (unused_write),
      .address_d_o  (unused_address),
      .select_o     (unused_select),
      .upper_o      (unused_upper),
      .neighbour_o  (unused_neighbour),
      .command_o    (command),
      .scratch_row_o(scratch_row),
      .column_o     (unused_column),
      .send_o       (unused_send),
      .send_column_o(unused_send_column),
      .send_row_o   (unused_row),
      .send_last_o  (unused_last),
      .send_waits_i (1'b0),
      .send_busy_i  (1'b0)
  );

  // The prepared pixel, fetched a step before: from the last to the first, then back. In the first step there is none.
  localparam int STEPS = PIXELS + 4;  // steps of the first pass
  logic [3:0] steps_q;
  logic [1:0] results_q;
  logic [1:0] prepared;
  logic [LABELS*PENALTY_WIDTH-1:0] message, other_message;
  logic best_label, second_label, found;
  logic [POSITION_WIDTH-1:0] best_position, second_position;
  logic [BELIEF_WIDTH-1:0] margin;

  assign found = command.take_position && command.has_position;
  assign prepared = (32'(steps_q) < STEPS) ? 2'(PIXELS - 32'(steps_q)) : 2'(32'(steps_q) - STEPS - 1);

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      steps_q <= '0;
      results_q <= '0;
    end else begin
      if (command.decide.advance) steps_q <= steps_q + 1'b1;
      if (found) results_q <= results_q + 1'b1;
    end
  end

  dtof_sram #(
      .PORTS(1),
      .DEPTH(PIXELS),
      .WIDTH(LABELS * PENALTY_WIDTH)
  ) u_scratch_sram (
      .clk_i       (clk_i),
      .rst_ni      (checking),
      .read_en_i   (command.read_scratch),
      .read_addr_i (scratch_row),
      .read_data_o (other_message),
      .write_en_i  (command.write_scratch),
      .write_addr_i(scratch_row),
      .write_parts_i(1'b1),
      .write_data_i(message)
  );

  dtof_label_chain #(
      .LABELS        (LABELS),
      .POSITION_WIDTH(POSITION_WIDTH),
      .REACH         (REACH),
      .EVIDENCE_WIDTH(EVIDENCE_WIDTH),
      .PENALTY_WIDTH (PENALTY_WIDTH)
  ) u_dut (
      .clk_i            (clk_i),
      .active_i         (command.deciding),
      .command_i        (command.decide),
      .evidence_i       ((LABELS*EVIDENCE_WIDTH)'(evidence >> (prepared * LABELS * EVIDENCE_WIDTH))),
      .position_i       ((LABELS*POSITION_WIDTH)'(position >> (prepared * LABELS * POSITION_WIDTH))),
      .penalty_i        (PENALTY_WIDTH'(penalty >> (prepared * PENALTY_WIDTH))),
      .message_o        (message),
      .other_message_i  (other_message),
      .best_label_o     (best_label),
      .second_label_o   (second_label),
      .best_position_o  (best_position),
      .second_position_o(second_position),
      .margin_o         (margin)
  );

  // Sum of an assignment, for the result of one pixel.
  integer assignment, sum, best0, best1;
  integer e0, e1, e2, q0, q1, q2, cost01, cost12;
  always_comb begin
    best0 = -1000;
    best1 = -1000;
    e0 = 0;
    e1 = 0;
    e2 = 0;
    q0 = 0;
    q1 = 0;
    q2 = 0;
    cost01 = 0;
    cost12 = 0;
    sum = 0;
    for (assignment = 0; assignment < 8; assignment = assignment + 1) begin
      e0 = $signed(evidence[(0+(assignment&1))*EVIDENCE_WIDTH+:EVIDENCE_WIDTH]);
      e1 = $signed(evidence[(2+((assignment>>1)&1))*EVIDENCE_WIDTH+:EVIDENCE_WIDTH]);
      e2 = $signed(evidence[(4+((assignment>>2)&1))*EVIDENCE_WIDTH+:EVIDENCE_WIDTH]);
      q0 = $signed(position[(0+(assignment&1))*POSITION_WIDTH+:POSITION_WIDTH]);
      q1 = $signed(position[(2+((assignment>>1)&1))*POSITION_WIDTH+:POSITION_WIDTH]);
      q2 = $signed(position[(4+((assignment>>2)&1))*POSITION_WIDTH+:POSITION_WIDTH]);
      // Between pixels 0 and 1 the sender is 0 for the results of 1 and 2; between 1 and 2 the sender is 2 for those of 0 and 1.
      cost01 = (results_q == 2'd0) ? 32'(penalty[PENALTY_WIDTH+:PENALTY_WIDTH]) : 32'(penalty[0+:PENALTY_WIDTH]);
      cost12 = (results_q == 2'd2) ? 32'(penalty[PENALTY_WIDTH+:PENALTY_WIDTH])
          : 32'(penalty[2*PENALTY_WIDTH+:PENALTY_WIDTH]);
      if (q0 - q1 <= REACH && q1 - q0 <= REACH) cost01 = 0;
      if (q1 - q2 <= REACH && q2 - q1 <= REACH) cost12 = 0;
      sum = e0 + e1 + e2 - cost01 - cost12;
      if (((assignment >> results_q) & 1) == 0) begin
        if (sum > best0) best0 = sum;
      end else begin
        if (sum > best1) best1 = sum;
      end
    end
  end

  logic expected_label;
  assign expected_label = (best1 > best0);

  `PROVE(a_label, !found || best_label == expected_label)
  `PROVE(a_other_label, !found || second_label == !expected_label)
  `PROVE(a_margin, !found || 32'(margin) == (expected_label ? best1 - best0 : best0 - best1))
  `PROVE(a_position, !found || best_position
         == POSITION_WIDTH'(position >> ((32'(results_q) * LABELS + 32'(best_label)) * POSITION_WIDTH)))
  `GOAL(found && results_q == 2'd2 && margin != '0 && best_label)

endmodule

`default_nettype wire
