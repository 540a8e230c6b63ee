// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_result_output, with the columns' result registers and the registers to and from the columns: the rules of AXI4-Stream, and
// every column's result leaves once and in order, under any back-pressure and from reset at any time. The harness watches one arbitrary column.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module result_output_properties #(
    parameter int SRAM_NUM = 3,
    parameter int ROW_WIDTH = 2,
    parameter int RESULT_WIDTH = 2,
    parameter int STAGES = 1,  // registers to the columns
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int TDATA_WIDTH = COLUMN_WIDTH + ROW_WIDTH + RESULT_WIDTH
) (
    input logic                             clk_i,
    input logic                             reset_i,
    input logic                             load_i,
    input logic [SRAM_NUM*RESULT_WIDTH-1:0] results_i,
    input logic                             start_i,
    input logic                             last_row_i,
    input logic [            ROW_WIDTH-1:0] row_i,
    input logic                             tready_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic shift, done, busy, tvalid, tlast;
  logic [TDATA_WIDTH-1:0] tdata;
  logic [(SRAM_NUM+1)*RESULT_WIDTH-1:0] chain;
  assign chain[SRAM_NUM*RESULT_WIDTH+:RESULT_WIDTH] = '0;

  // Registers to the columns, and the register at the chain's head.
  logic column_load, column_shift;
  logic [SRAM_NUM*RESULT_WIDTH-1:0] column_results;
  logic [RESULT_WIDTH-1:0] head_q;

  dtof_broadcast #(
      .WIDTH (2 + SRAM_NUM * RESULT_WIDTH),
      .STAGES(STAGES)
  ) u_broadcast (
      .clk_i (clk_i),
      .rst_ni(rst_n),
      .from_i({load_i, shift, results_i}),
      .to_o  ({column_load, column_shift, column_results})
  );

  always_ff @(posedge clk_i) begin
    head_q <= chain[RESULT_WIDTH-1:0];
  end

  genvar c;
  generate
    for (c = 0; c < SRAM_NUM; c = c + 1) begin : g_column
      dtof_result_register #(.WIDTH(RESULT_WIDTH)) u_result_register (
          .clk_i        (clk_i),
          .rst_ni       (rst_n),
          .load_i       (column_load),
          .shift_i      (column_shift),
          .result_i     (column_results[c*RESULT_WIDTH+:RESULT_WIDTH]),
          .next_column_i(chain[(c+1)*RESULT_WIDTH+:RESULT_WIDTH]),
          .result_o     (chain[c*RESULT_WIDTH+:RESULT_WIDTH])
      );
    end
  endgenerate

  dtof_result_output #(
      .SRAM_NUM    (SRAM_NUM),
      .ROW_WIDTH   (ROW_WIDTH),
      .RESULT_WIDTH(RESULT_WIDTH),
      .LATENCY     (STAGES + 1)
  ) u_dut (
      .clk_i     (clk_i),
      .rst_ni    (rst_n),
      .start_i   (start_i),
      .last_row_i(last_row_i),
      .row_i     (row_i),
      .head_i    (head_q),
      .shift_o   (shift),
      .done_o    (done),
      .busy_o    (busy),
      .tvalid_o  (tvalid),
      .tready_i  (tready_i),
      .tdata_o   (tdata),
      .tlast_o   (tlast)
  );

  // The row that is being sent.
  (* anyconst *) logic [COLUMN_WIDTH-1:0] watched;
  logic loaded_q, sending_q, tvalid_q, tready_q, tlast_q, last_row_q, finished_q;
  logic [COLUMN_WIDTH:0] beats_q;
  logic [3:0] pause_q;
  logic [RESULT_WIDTH-1:0] expected_q, result;
  logic [ROW_WIDTH-1:0] row_q;
  logic [COLUMN_WIDTH-1:0] column;
  logic [TDATA_WIDTH-1:0] tdata_q;
  logic accepted, last_beat;

  assign {column, result} = {tdata[TDATA_WIDTH-1-:COLUMN_WIDTH], tdata[RESULT_WIDTH-1:0]};
  assign accepted = tvalid && tready_i;
  assign last_beat = accepted && (32'(beats_q) == SRAM_NUM - 1);

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      loaded_q <= 1'b0;
      sending_q <= 1'b0;
      tvalid_q <= 1'b0;
      tready_q <= 1'b0;
      beats_q <= '0;
      pause_q <= '0;
      finished_q <= 1'b0;
    end else begin
      if (load_i) begin
        loaded_q <= 1'b1;
        expected_q <= RESULT_WIDTH'(results_i >> (watched * RESULT_WIDTH));
      end else if (start_i) begin
        loaded_q <= 1'b0;
      end
      finished_q <= last_beat;
      if (start_i) begin
        sending_q <= 1'b1;
        beats_q <= '0;
        pause_q <= '0;
        row_q <= row_i;
        last_row_q <= last_row_i;
      end else if (sending_q) begin
        if (accepted) beats_q <= beats_q + 1'b1;
        if (last_beat) sending_q <= 1'b0;
        pause_q <= tvalid ? '0 : pause_q + 1'b1;
      end
      tvalid_q <= tvalid;
      tready_q <= tready_i;
    end
    tdata_q <= tdata;
    tlast_q <= tlast;
  end

  logic running;
  assign running = rst_n;

  `ASSUME(m_load_when_free, !load_i || (!busy && !sending_q))
  `ASSUME(m_start_after_load, !start_i || (loaded_q && !load_i && !busy && !sending_q))
  `ASSUME(m_row_is_held, !sending_q || (row_i == row_q && last_row_i == last_row_q))
  `ASSUME(m_watched, 32'(watched) < SRAM_NUM)
  `PROVE(a_tvalid_holds, !(running && tvalid_q && !tready_q) || tvalid)
  `PROVE(a_tdata_stable, !(running && tvalid_q && !tready_q) || (tdata == tdata_q && tlast == tlast_q))
  `PROVE(a_only_while_sending, !running || !tvalid || sending_q)
  `PROVE(a_columns_in_order, !(running && tvalid) || 32'(column) == 32'(beats_q))
  `PROVE(a_not_one_too_many, !(running && tvalid) || 32'(beats_q) < SRAM_NUM)
  `PROVE(a_result, !(running && tvalid && column == watched) || result == expected_q)
  `PROVE(a_row, !(running && tvalid) || tdata[RESULT_WIDTH+:ROW_WIDTH] == row_q)
  `PROVE(a_tlast, !(running && tvalid) || tlast == (last_row_q && 32'(beats_q) == SRAM_NUM - 1))
  `PROVE(a_done, !running || done == finished_q)
  `PROVE(a_busy, !running || !sending_q || busy)
  `PROVE(a_goes_on, !running || !sending_q || 32'(pause_q) < STAGES + 3)
  `GOAL(running && done && last_row_q && 32'(watched) == SRAM_NUM - 1)

endmodule

`default_nettype wire
