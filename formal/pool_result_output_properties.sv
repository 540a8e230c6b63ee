// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pool_result_output: the rules of AXI4-Stream, and every engine's result leaves once and in order, under any back-pressure
// and from reset at any time. The harness stores the results in a queue of three entries and watches one arbitrary engine.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_result_output_properties #(
    parameter int ENGINES = 3,
    parameter int ENGINE_COLUMNS = 2,
    parameter int SRAM_NUM = 5,
    parameter int ROW_WIDTH = 2,
    parameter int RESULT_WIDTH = 2,
    parameter int LATENCY = 1,
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int STEP_WIDTH = dtof_pkg::index_width(ENGINE_COLUMNS),
    localparam int TDATA_WIDTH = COLUMN_WIDTH + ROW_WIDTH + RESULT_WIDTH
) (
    input logic                            clk_i,
    input logic                            reset_i,
    input logic                            send_i,
    input logic [          STEP_WIDTH-1:0] column_i,
    input logic [           ROW_WIDTH-1:0] row_i,
    input logic                            last_i,
    input logic [ENGINES*RESULT_WIDTH-1:0] results_i,
    input logic                            tready_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic waits, busy, tvalid, tlast;
  logic [TDATA_WIDTH-1:0] tdata;

  dtof_pool_result_output #(
      .ENGINES       (ENGINES),
      .ENGINE_COLUMNS(ENGINE_COLUMNS),
      .SRAM_NUM      (SRAM_NUM),
      .ROW_WIDTH     (ROW_WIDTH),
      .RESULT_WIDTH  (RESULT_WIDTH),
      .LATENCY       (LATENCY)
  ) u_dut (
      .clk_i    (clk_i),
      .rst_ni   (rst_n),
      .send_i   (send_i),
      .column_i (column_i),
      .row_i    (row_i),
      .last_i   (last_i),
      .results_i(results_i),
      .waits_o  (waits),
      .busy_o   (busy),
      .tvalid_o (tvalid),
      .tready_i (tready_i),
      .tdata_o  (tdata),
      .tlast_o  (tlast)
  );

  // Entry of the queue: {last, row, column, result of the watched engine}. It enters when the results arrive.
  localparam int PLACE_WIDTH = 1 + ROW_WIDTH + STEP_WIDTH;
  localparam int ENTRY_WIDTH = PLACE_WIDTH + RESULT_WIDTH;
  (* anyconst *) logic [7:0] watched;
  logic [LATENCY*(1+PLACE_WIDTH)-1:0] way_q;  // {sent, place} of the last LATENCY clocks, the oldest highest
  logic arrives;
  logic [PLACE_WIDTH-1:0] place;
  logic [ENTRY_WIDTH-1:0] given;
  logic [3*ENTRY_WIDTH-1:0] queue_q, shifted;  // the oldest entry lowest
  logic [1:0] entries_q, asked_q, left;
  logic [7:0] beats_q, beats_of_front;
  logic [1:0] pause_q;
  logic tvalid_q, tready_q, tlast_q, accepted, last_beat;
  logic [TDATA_WIDTH-1:0] tdata_q;
  logic front_last;
  logic [ROW_WIDTH-1:0] front_row;
  logic [STEP_WIDTH-1:0] front_column;
  logic [RESULT_WIDTH-1:0] front_result;

  assign {arrives, place} = way_q[LATENCY*(1+PLACE_WIDTH)-1-:1+PLACE_WIDTH];
  assign given = {place, RESULT_WIDTH'(results_i >> (watched * RESULT_WIDTH))};
  assign {front_last, front_row, front_column, front_result} = queue_q[ENTRY_WIDTH-1:0];
  // The last engine may lack this column.
  assign beats_of_front = ((ENGINES - 1) * ENGINE_COLUMNS + 32'(front_column) < SRAM_NUM) ? 8'(ENGINES)
      : 8'(ENGINES - 1);
  assign accepted = tvalid && tready_i;
  assign last_beat = accepted && (beats_q == beats_of_front - 8'd1);
  assign shifted = last_beat ? queue_q >> ENTRY_WIDTH : queue_q;
  assign left = entries_q - 2'(last_beat);

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      way_q <= '0;
      entries_q <= '0;
      asked_q <= '0;
      beats_q <= '0;
      pause_q <= '0;
      tvalid_q <= 1'b0;
      tready_q <= 1'b0;
    end else begin
      way_q <= (LATENCY * (1 + PLACE_WIDTH))'({way_q, send_i, last_i, row_i, column_i});
      entries_q <= left + 2'(arrives);
      asked_q <= asked_q + 2'(send_i) - 2'(last_beat);
      beats_q <= last_beat ? '0 : beats_q + 8'(accepted);
      pause_q <= (tvalid || entries_q == '0) ? '0 : pause_q + 2'd1;
      tvalid_q <= tvalid;
      tready_q <= tready_i;
    end
    queue_q <= shifted;
    if (arrives) begin
      queue_q[left*ENTRY_WIDTH+:ENTRY_WIDTH] <= given;
    end
    tdata_q <= tdata;
    tlast_q <= tlast;
  end

  logic running;
  assign running = rst_n;
  logic [31:0] expected_column;
  assign expected_column = 32'(front_column) + 32'(beats_q) * ENGINE_COLUMNS;

  `ASSUME(m_watched, 32'(watched) < ENGINES)
  `ASSUME(m_column, 32'(column_i) < ENGINE_COLUMNS && (ENGINES > 1 || 32'(column_i) < SRAM_NUM))
  `ASSUME(m_room, !(send_i && asked_q == 2'd3))
  `PROVE(a_tvalid_holds, !(running && tvalid_q && !tready_q) || tvalid)
  `PROVE(a_tdata_stable, !(running && tvalid_q && !tready_q) || (tdata == tdata_q && tlast == tlast_q))
  `PROVE(a_nothing_unasked, !(running && tvalid) || entries_q != '0)
  `PROVE(a_column, !(running && tvalid) || 32'(tdata[TDATA_WIDTH-1-:COLUMN_WIDTH]) == expected_column)
  `PROVE(a_row, !(running && tvalid) || tdata[RESULT_WIDTH+:ROW_WIDTH] == front_row)
  `PROVE(a_result, !(running && tvalid && beats_q == watched) || tdata[RESULT_WIDTH-1:0] == front_result)
  `PROVE(a_tlast, !(running && tvalid) || tlast == (front_last && beats_q == beats_of_front - 8'd1))
  `PROVE(a_waits, !running || waits == (32'(asked_q) + 32'(send_i) >= 3))
  `PROVE(a_busy, !running || busy == (asked_q != '0))
  `PROVE(a_goes_on, !running || pause_q < 2'd2)
  `GOAL(running && last_beat && entries_q == 2'd3 && front_last)

endmodule

`default_nettype wire
