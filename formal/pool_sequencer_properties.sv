// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pool_sequencer with dtof_pool_result_output: one selected pair and one access per clock; addresses, labels and scratch rows
// in range; an operation ends in time, not counting clocks in which the sink is not ready; results leave in order.
`include "dtof_macros.svh"
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_sequencer_properties `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int PIXELS = 3,
    parameter int GROUP_SIZE = 4,
    parameter int LABELS = 2,
    parameter int LINE_HALVES = 1,
    parameter int ENGINE_COLUMNS = 2,
    parameter int SMOOTH_STARTS = 1,
    parameter int PRIOR = 0,
    localparam int GROUPS = (PIXELS + GROUP_SIZE - 1) / GROUP_SIZE,
    localparam int WORDS = GROUPS * (GROUP_SIZE / 2) + (GROUPS + 1) / 2,
    localparam int ADDR_WIDTH = dtof_pkg::index_width(WORDS),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS),
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(ENGINE_COLUMNS),
    localparam int PAIRS = (ENGINE_COLUMNS + 1) / 2
) (
    input logic clk_i,
    input logic decode_i,
    input logic choose_i,
    input logic decide_i,
    input logic prior_i,
    input logic tready_i
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  `DTOF_TYPE(dtof_pool_pkg, pool_engine_command_t) command;
  logic done, read, write, upper, neighbour, send, send_last, waits, busy;
  logic [PAIRS-1:0] select;
  logic [ADDR_WIDTH-1:0] address;
  logic [ROW_WIDTH-1:0] scratch_row, send_row;
  logic [COLUMN_WIDTH-1:0] column, send_column;
  logic tvalid, tlast;
  logic [COLUMN_WIDTH+ROW_WIDTH:0] tdata;

  dtof_pool_sequencer #(
      .PIXELS_PER_SRAM(PIXELS),
      .GROUP_SIZE     (GROUP_SIZE),
      .LABELS         (LABELS),
      .LINE_HALVES    (LINE_HALVES),
      .ENGINE_COLUMNS (ENGINE_COLUMNS),
      .SMOOTH_STARTS  (SMOOTH_STARTS),
      .PRIOR          (PRIOR)
  ) u_dut (
      .clk_i        (clk_i),
      .rst_ni       (checking),
      .decode_i     (decode_i),
      .choose_i     (choose_i),
      .decide_i     (decide_i),
      .prior_i      (prior_i),
      .done_o       (done),
      .read_d_o     (read),
      .write_d_o    (write),
      .address_d_o  (address),
      .select_o     (select),
      .upper_o      (upper),
      .neighbour_o  (neighbour),
      .command_o    (command),
      .scratch_row_o(scratch_row),
      .column_o     (column),
      .send_o       (send),
      .send_column_o(send_column),
      .send_row_o   (send_row),
      .send_last_o  (send_last),
      .send_waits_i (waits),
      .send_busy_i  (busy)
  );

  dtof_pool_result_output #(
      .ENGINES       (1),
      .ENGINE_COLUMNS(ENGINE_COLUMNS),
      .SRAM_NUM      (ENGINE_COLUMNS),
      .ROW_WIDTH     (ROW_WIDTH),
      .RESULT_WIDTH  (1)
  ) u_result_output (
      .clk_i    (clk_i),
      .rst_ni   (checking),
      .send_i   (send),
      .column_i (send_column),
      .row_i    (send_row),
      .last_i   (send_last),
      .results_i(1'b0),
      .waits_o  (waits),
      .busy_o   (busy),
      .tvalid_o (tvalid),
      .tready_i (tready_i),
      .tdata_o  (tdata),
      .tlast_o  (tlast)
  );

  // Latencies that the module states, and the last commands and results.
  localparam int PERIOD = (LABELS + 4 > 9) ? LABELS + 4 : 9;
  localparam int DECODE_CLOCKS = PAIRS * GROUPS * (32 * LABELS + 45) + 6;
  localparam int PRIOR_STEPS = (PRIOR != 0) ? 1 + PIXELS % 2 : 0;
  localparam int CHOOSE_CLOCKS = ENGINE_COLUMNS * (2 * (PIXELS + 4) + SMOOTH_STARTS + PRIOR_STEPS) * PERIOD + 6;
  localparam int DECIDE_CLOCKS = ENGINE_COLUMNS * (2 * PIXELS + 9) * 6 + 6 + 2;  // the last 2: results on their way

  logic working_q, sending_q;
  logic choosing_q, decoding_q;
  logic [15:0] clocks_q, sent_q, passed_q, most_clocks;
  logic [2:0] target_q, target_before_q;
  logic pass_label;
  logic start;
  assign pass_label = command.choose.pass_label || command.decide.pass_label;
  assign start = decode_i || choose_i || decide_i;

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      working_q <= 1'b0;
      sending_q <= 1'b0;
      choosing_q <= 1'b0;
      decoding_q <= 1'b0;
      clocks_q <= '0;
      sent_q <= '0;
      passed_q <= '0;
    end else begin
      working_q <= start || (working_q && !done);
      clocks_q <= working_q ? clocks_q + 16'(!(tvalid && !tready_i)) : '0;
      if (start) begin
        sending_q <= decide_i;
        choosing_q <= choose_i;
        decoding_q <= decode_i;
        sent_q <= '0;
      end else if (send) begin
        sent_q <= sent_q + 1'b1;
      end
      passed_q <= pass_label ? passed_q + 1'b1 : '0;
    end
    target_q <= command.choose.target | command.decide.target;  // only one operation is active at a time
    target_before_q <= target_q;
  end

  assign most_clocks = decoding_q ? 16'(DECODE_CLOCKS) : choosing_q ? 16'(CHOOSE_CLOCKS) : 16'(DECIDE_CLOCKS);

  `ASSUME(m_start_when_idle, !start || (!working_q && !busy))
  `ASSUME(m_one_start, 32'(decode_i) + 32'(choose_i) + 32'(decide_i) <= 1)
  `PROVE(a_one_pair_at_most, (select & (select - 1'b1)) == '0)
  `PROVE(a_one_access, !(read && write))
  `PROVE(a_address, !(read || write) || 32'(address) < WORDS)
  `PROVE(a_scratch_one_access, !(command.read_scratch && command.write_scratch))
  `PROVE(a_scratch_row, !(command.read_scratch || command.write_scratch) || 32'(scratch_row) < PIXELS)
  `PROVE(a_label, !pass_label || 16'(target_before_q) == passed_q)
  `PROVE(a_labels, 32'(passed_q) <= LABELS)
  `PROVE(a_results_in_order, !send || (32'(sent_q) == 32'(send_column) * PIXELS + 32'(send_row)))
  `PROVE(a_last_result, !send || send_last == (32'(sent_q) == PIXELS * ENGINE_COLUMNS - 1))
  `PROVE(a_all_results, !(done && sending_q) || 32'(sent_q) == PIXELS * ENGINE_COLUMNS)
  `PROVE(a_done_in_time, !working_q || clocks_q <= most_clocks)
  `PROVE(a_done_once, !done || working_q)
  `GOAL(done && sending_q)

endmodule

`default_nettype wire
