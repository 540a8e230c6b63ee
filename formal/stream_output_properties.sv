// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_stream_output: every result leaves once, in order, with its status, under any back-pressure and from reset at any time.
// After a cut at any time the word at the port stays, and a frame with words that were at the port ends with an aborted word.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module stream_output_properties #(
    parameter int SRAM_NUM = 3,
    parameter int ROW_WIDTH = 2,
    parameter int POSITION_WIDTH = 3,
    parameter int CONFIDENCE_WIDTH = 2,
    parameter int HAS_CONFIDENCE = (CONFIDENCE_WIDTH > 0) ? 1 : 0,
    parameter int COUNTER_WIDTH = CONFIDENCE_WIDTH,
    parameter int RAW_COUNTER_WIDTH = CONFIDENCE_WIDTH,
    parameter int AMPLITUDE_WIDTH = 0,
    localparam int AMBIENT_WIDTH = (AMPLITUDE_WIDTH > 0) ? 6 : 0,
    localparam int LIGHT_BITS = (AMPLITUDE_WIDTH > 0) ? AMBIENT_WIDTH + AMPLITUDE_WIDTH : 1,
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int CONFIDENCE_BITS = (CONFIDENCE_WIDTH > 0) ? CONFIDENCE_WIDTH : 1,
    localparam int TDATA_WIDTH = COLUMN_WIDTH + ROW_WIDTH + AMBIENT_WIDTH + AMPLITUDE_WIDTH + POSITION_WIDTH + CONFIDENCE_WIDTH,
    localparam int ENTRY_WIDTH = 67
) (
    input logic                       clk_i,
    input logic                       reset_i,
    input logic [               15:0] weak_below_i,
    input logic [       SRAM_NUM-1:0] enable_i,
    input logic                       raw_i,
    input logic                       amplitude_i,
    input logic [     LIGHT_BITS-1:0] light_i,
    input logic                       short_i,
    input logic                       cut_i,
    input logic                       result_tvalid_i,
    input logic [   COLUMN_WIDTH-1:0] column_i,
    input logic [      ROW_WIDTH-1:0] row_i,
    input logic [ POSITION_WIDTH-1:0] position_i,
    input logic [CONFIDENCE_BITS-1:0] confidence_i,
    input logic                       result_second_i,
    input logic                       result_tlast_i,
    input logic                       m_axis_tready_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic [TDATA_WIDTH-1:0] result;
  logic [15:0] confidence;
  logic [23:0] place;
  generate
    if (AMPLITUDE_WIDTH > 0) begin : g_amplitude
      assign result = {column_i, row_i, light_i, position_i, confidence_i};
      assign confidence = 16'(confidence_i);
      assign place = amplitude_i ? {12'(light_i[AMPLITUDE_WIDTH+:AMBIENT_WIDTH]), 12'(light_i[AMPLITUDE_WIDTH-1:0])}
          : {12'(column_i), 12'(row_i)};
    end else if (CONFIDENCE_WIDTH > 0) begin : g_confidence
      assign place = {12'(column_i), 12'(row_i)};
      assign result = {column_i, row_i, position_i, confidence_i};
      assign confidence = 16'(confidence_i);
    end else begin : g_no_confidence
      assign place = {12'(column_i), 12'(row_i)};
      assign result = {column_i, row_i, position_i};
      assign confidence = '0;
    end
  endgenerate

  logic result_tready, tvalid, tuser, tlast, is_short, unfinished;
  logic [63:0] tdata;

  dtof_stream_output #(
      .SRAM_NUM         (SRAM_NUM),
      .ROW_WIDTH        (ROW_WIDTH),
      .POSITION_WIDTH   (POSITION_WIDTH),
      .CONFIDENCE_WIDTH (CONFIDENCE_WIDTH),
      .HAS_CONFIDENCE   (HAS_CONFIDENCE),
      .COUNTER_WIDTH    (COUNTER_WIDTH),
      .RAW_COUNTER_WIDTH(RAW_COUNTER_WIDTH),
      .AMPLITUDE_WIDTH  (AMPLITUDE_WIDTH)
  ) u_dut (
      .clk_i          (clk_i),
      .rst_ni         (rst_n),
      .weak_below_i   (weak_below_i),
      .enable_i       (enable_i),
      .raw_i          (raw_i),
      .amplitude_i    (amplitude_i),
      .short_i        (short_i),
      .cut_i          (cut_i),
      .result_tvalid_i(result_tvalid_i),
      .result_tready_o(result_tready),
      .result_tdata_i (result),
      .result_second_i(result_second_i),
      .result_tlast_i (result_tlast_i),
      .m_axis_tvalid_o(tvalid),
      .m_axis_tready_i(m_axis_tready_i),
      .m_axis_tdata_o (tdata),
      .m_axis_tuser_o (tuser),
      .m_axis_tlast_o (tlast),
      .m_axis_short_o (is_short),
      .unfinished_o   (unfinished)
  );

  // Expected words in a queue: {short, first, last, word}, the oldest in slot 0.
  logic [ENTRY_WIDTH-1:0] slot0_q, slot1_q, entry, aborted;
  logic [1:0] count_q;
  logic begins_q, weak, empty, masked, saturated, push, pop, stays, open, popped_open_q, popped_short_q;

  assign weak = (HAS_CONFIDENCE > 0) && !raw_i && (confidence < weak_below_i);
  assign empty = (HAS_CONFIDENCE > 0) && !raw_i && (confidence == 16'd0);
  assign masked = ((enable_i >> column_i) & 1'b1) == '0;
  // count + 1 needs one more bit.
  logic [16:0] above;
  assign above = 17'(confidence) + 17'd1;
  assign saturated = (CONFIDENCE_WIDTH > 0) && (raw_i ? above == 17'd1 << RAW_COUNTER_WIDTH
      : (COUNTER_WIDTH > 0 && above == 17'd1 << COUNTER_WIDTH));
  assign entry = {short_i, begins_q, result_tlast_i, 1'b0, raw_i, result_second_i, saturated, masked, empty, weak,
                  !weak && !empty && !masked, place, confidence, 16'(position_i)};
  assign push = result_tvalid_i && result_tready;
  assign pop = tvalid && m_axis_tready_i;

  // The frame of the word that is, or was last, at the port has not ended with this word.
  assign open = (count_q != 2'd0) ? !slot0_q[64] : popped_open_q;
  assign stays = (count_q != 2'd0) && !pop;
  // The word that ends this frame: not first, last, its highest bit set.
  assign aborted = {(count_q != 2'd0) ? slot0_q[66] : popped_short_q, 1'b0, 1'b1, 1'b1, 63'd0};

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      count_q <= '0;
      begins_q <= 1'b1;
      popped_open_q <= 1'b0;
    end else begin
      count_q <= cut_i ? 2'(stays) + 2'(open) : count_q + 2'(push) - 2'(pop);
      if (push) begins_q <= result_tlast_i;
      if (cut_i) begins_q <= 1'b1;
      popped_open_q <= open;
    end
    popped_short_q <= aborted[66];
    if (cut_i) begin
      if (!stays) slot0_q <= aborted;
      slot1_q <= aborted;
    end else begin
      if (pop) slot0_q <= (count_q == 2'd2) ? slot1_q : entry;
      else if (push && count_q == 2'd0) slot0_q <= entry;
      if (push) slot1_q <= entry;
    end
  end

  axi_stream_rules #(
      .WIDTH(67)
  ) u_rules (
      .clk_i   (clk_i),
      .rst_ni  (rst_n),
      .checking(checking),
      .tvalid_i(tvalid),
      .tready_i(m_axis_tready_i),
      .tdata_i ({is_short, tuser, tlast, tdata})
  );

  `ASSUME(m_column, 32'(column_i) < SRAM_NUM)
  `PROVE(a_tvalid, !rst_n || tvalid == (count_q != 2'd0))
  `PROVE(a_tready, !rst_n || result_tready == (count_q != 2'd2 && !cut_i))
  `PROVE(a_word, !(rst_n && tvalid) || tdata == slot0_q[63:0])
  `PROVE(a_tlast, !(rst_n && tvalid) || tlast == slot0_q[64])
  `PROVE(a_tuser, !(rst_n && tvalid) || tuser == slot0_q[65])
  `PROVE(a_short, !(rst_n && tvalid) || is_short == slot0_q[66])
  `PROVE(a_unfinished, !rst_n || unfinished == (open && !(count_q == 2'd2 && slot1_q[63])))
  `GOAL(rst_n && pop && tlast && count_q == 2'd2 && tdata[57] && !tuser)

endmodule

`default_nettype wire
