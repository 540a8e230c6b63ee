// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_raster_buffer: every result leaves once, in raster order, for any pace of both sides and from reset at any time. The
// harness watches one arbitrary pixel, its first or its second result; a frame has one or two results of every pixel. After a cut at any
// time the result at the port stays; a frame with results that were at the port ends with an aborted result; any other frame leaves no result.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module raster_buffer_properties #(
    parameter int SRAM_NUM = 2,
    parameter int PIXELS_PER_SRAM = 2,
    parameter int WIDTH = 1,
    parameter int TARGETS = 1,
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM)
) (
    input logic                    clk_i,
    input logic                    reset_i,
    input logic                    cut_i,
    input logic                    both_i,      // with a frame's first result: the pixels of the frame have two results
    input logic                    s_tvalid_i,
    input logic [       WIDTH-1:0] s_result_i,
    input logic [COLUMN_WIDTH-1:0] s_column_i,
    input logic [   ROW_WIDTH-1:0] s_row_i,
    input logic                    s_second_i,
    input logic                    s_tlast_i,
    input logic                    m_tready_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic s_tready, tvalid, tlast, second, aborted, unfinished;
  logic [WIDTH-1:0] result;
  logic [COLUMN_WIDTH-1:0] column;
  logic [ROW_WIDTH-1:0] row;

  dtof_raster_buffer #(
      .SRAM_NUM       (SRAM_NUM),
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .WIDTH          (WIDTH),
      .TARGETS        (TARGETS)
  ) u_dut (
      .clk_i     (clk_i),
      .rst_ni    (rst_n),
      .cut_i     (cut_i),
      .s_tvalid_i(s_tvalid_i),
      .s_tready_o(s_tready),
      .s_result_i(s_result_i),
      .s_column_i(s_column_i),
      .s_row_i   (s_row_i),
      .s_second_i(s_second_i),
      .s_tlast_i (s_tlast_i),
      .m_tvalid_o(tvalid),
      .m_tready_i(m_tready_i),
      .m_result_o(result),
      .m_column_o(column),
      .m_row_o   (row),
      .m_second_o(second),
      .m_aborted_o(aborted),
      .unfinished_o(unfinished),
      .m_tlast_o (tlast)
  );

  (* anyconst *) logic [COLUMN_WIDTH-1:0] watched_column;
  (* anyconst *) logic [ROW_WIDTH-1:0] watched_row;
  (* anyconst *) logic watched_second;
  logic [7:0] in_q, out_q;  // number of results of the frame
  logic come_q, held_q, whole_q, both_q, both_in, both_in_q, is_watched, push, pop;
  logic [7:0] last_in, last_out;
  logic [1:0] pause_q;
  logic owed_q, aborted_q, ends;  // owed_q: the aborted result of a cut frame is still to come; aborted_q: it is at the port
  logic [WIDTH-1:0] expected_q, result_q;

  // All pixels of a frame have one result, or all have two; the frame's first result decides.
  assign both_in = (TARGETS > 1) && ((in_q == '0) ? both_i : both_in_q);
  assign last_in = 8'(SRAM_NUM * PIXELS_PER_SRAM * (both_in ? 2 : 1) - 1);
  assign last_out = 8'(SRAM_NUM * PIXELS_PER_SRAM * (both_q ? 2 : 1) - 1);
  assign is_watched = (s_column_i == watched_column) && (s_row_i == watched_row) && (s_second_i == watched_second);
  assign push = s_tvalid_i && s_tready;
  assign pop = tvalid && m_tready_i;
  assign ends = pop && (aborted || out_q == last_out);

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      in_q <= '0;
      out_q <= '0;
      come_q <= 1'b0;
      held_q <= 1'b0;
      whole_q <= 1'b0;
      pause_q <= '0;
      owed_q <= 1'b0;
      aborted_q <= 1'b0;
    end else begin
      if (push) begin
        in_q <= s_tlast_i ? '0 : in_q + 1'b1;
        both_in_q <= both_in;
        if (s_tlast_i) whole_q <= 1'b1;
        if (s_tlast_i) both_q <= both_in;
        if (is_watched) begin
          come_q <= 1'b1;
          expected_q <= s_result_i;
        end
      end
      if (pop) begin
        out_q <= out_q + 1'b1;
        if (ends) begin
          out_q <= '0;
          whole_q <= 1'b0;
          come_q <= 1'b0;
          owed_q <= 1'b0;
        end
      end
      if (cut_i && !ends) begin
        in_q <= '0;
        if (!tvalid && out_q == '0) begin
          whole_q <= 1'b0;
          come_q <= 1'b0;
        end else if (!tvalid || out_q != last_out) begin
          owed_q <= 1'b1;
        end
      end
      aborted_q <= aborted;
      held_q <= tvalid && !m_tready_i;
      pause_q <= (whole_q && !tvalid) ? pause_q + 1'b1 : '0;
    end
    result_q <= result;
  end

  // An aborted result has no pixel and no data.
  axi_stream_rules #(
      .WIDTH(2 + WIDTH + COLUMN_WIDTH + ROW_WIDTH + 1)
  ) u_rules (
      .clk_i   (clk_i),
      .rst_ni  (rst_n),
      .checking(checking),
      .tvalid_i(tvalid),
      .tready_i(m_tready_i),
      .tdata_i ({aborted, tlast, aborted ? '0 : {result, second, column, row}})
  );

  // A frame has each pixel once or twice, and ends with tlast.
  `ASSUME(m_in_array, 32'(s_column_i) < SRAM_NUM && 32'(s_row_i) < PIXELS_PER_SRAM)
  `ASSUME(m_watched, 32'(watched_column) < SRAM_NUM && 32'(watched_row) < PIXELS_PER_SRAM
          && (!watched_second || TARGETS > 1))
  `ASSUME(m_once, !s_tvalid_i || !is_watched || !come_q || whole_q)
  `ASSUME(m_last, s_tlast_i == (in_q == last_in))
  `ASSUME(m_second, both_in ? (!s_tlast_i || s_second_i) : !s_second_i)
  `ASSUME(m_all, !s_tvalid_i || !s_tlast_i || come_q || is_watched || (watched_second && !both_in))
  `PROVE(a_only_whole_frames, !(rst_n && tvalid) || whole_q)
  `PROVE(a_no_mixing, !(rst_n && push) || !whole_q)
  `PROVE(a_order, !(rst_n && tvalid && !aborted) ||
         (32'(row) * SRAM_NUM + 32'(column)) * (both_q ? 2 : 1) + 32'(second) == 32'(out_q))
  `PROVE(a_result, !(rst_n && tvalid && !aborted && column == watched_column && row == watched_row && second == watched_second)
         || result == expected_q)
  `PROVE(a_tlast, !(rst_n && tvalid) || tlast == (aborted || out_q == last_out))
  `PROVE(a_aborted, !(rst_n && tvalid && aborted) || owed_q)
  `PROVE(a_ends_at_once, !(rst_n && owed_q && !held_q) || (tvalid && aborted))
  `PROVE(a_takes_results, !rst_n || whole_q || cut_i || s_tready)
  `PROVE(a_goes_on, !rst_n || pause_q < 3)
  `PROVE(a_unfinished, !rst_n || unfinished == (whole_q && !owed_q && !(tvalid && out_q == last_out)))
  `GOAL(rst_n && pop && tlast && column == watched_column && row == watched_row)

endmodule

`default_nettype wire
