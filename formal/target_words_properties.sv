// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_target_words: every result leaves once, followed by its second target if both are requested, under any back-pressure
// and from reset at any time.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module target_words_properties #(
    parameter int PLACE_WIDTH = 3,
    parameter int POSITION_WIDTH = 4,
    parameter int CONFIDENCE_WIDTH = 2
) (
    input logic                        clk_i,
    input logic                        reset_i,
    input logic                        both_i,
    input logic                        s_tvalid_i,
    input logic [     PLACE_WIDTH-1:0] place_i,
    input logic [  POSITION_WIDTH-1:0] second_i,
    input logic [  POSITION_WIDTH-1:0] first_i,
    input logic [CONFIDENCE_WIDTH-1:0] confidence_i,
    input logic                        s_tlast_i,
    input logic                        m_tready_i
);

  localparam int ENTRY_WIDTH = PLACE_WIDTH + 2 * POSITION_WIDTH + CONFIDENCE_WIDTH + 2;

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic s_tready, tvalid, tlast, second;
  logic [PLACE_WIDTH+POSITION_WIDTH+CONFIDENCE_WIDTH-1:0] tdata;

  dtof_target_words #(
      .PLACE_WIDTH     (PLACE_WIDTH),
      .POSITION_WIDTH  (POSITION_WIDTH),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH)
  ) u_dut (
      .clk_i     (clk_i),
      .rst_ni    (rst_n),
      .both_i    (both_i),
      .s_tvalid_i(s_tvalid_i),
      .s_tready_o(s_tready),
      .s_tdata_i ({place_i, second_i, first_i, confidence_i}),
      .s_tlast_i (s_tlast_i),
      .m_tvalid_o(tvalid),
      .m_tready_i(m_tready_i),
      .m_tdata_o (tdata),
      .m_second_o(second),
      .m_tlast_o (tlast)
  );

  logic sent_q, waited_q, push, pop;
  logic [ENTRY_WIDTH-1:0] offered;

  assign offered = {both_i, s_tlast_i, place_i, second_i, first_i, confidence_i};
  assign push = s_tvalid_i && s_tready;
  assign pop = tvalid && m_tready_i;

  always_ff @(posedge clk_i) begin
    waited_q <= rst_n && tvalid && !m_tready_i;
    if (!rst_n || push) sent_q <= 1'b0;
    else if (pop) sent_q <= 1'b1;
  end

  axi_stream_rules #(
      .WIDTH  (ENTRY_WIDTH),
      .ASSUMED(1)
  ) u_source_rules (
      .clk_i   (clk_i),
      .rst_ni  (rst_n),
      .checking(checking),
      .tvalid_i(s_tvalid_i),
      .tready_i(s_tready),
      .tdata_i (offered)
  );

  axi_stream_rules #(
      .WIDTH(PLACE_WIDTH + POSITION_WIDTH + CONFIDENCE_WIDTH + 2)
  ) u_rules (
      .clk_i   (clk_i),
      .rst_ni  (rst_n),
      .checking(checking),
      .tvalid_i(tvalid),
      .tready_i(m_tready_i),
      .tdata_i ({second, tlast, tdata})
  );

  `PROVE(a_tvalid, !rst_n || tvalid == s_tvalid_i)
  `PROVE(a_taken, !rst_n || push == (pop && (sent_q || !both_i)))
  `PROVE(a_second, !(rst_n && tvalid) || second == sent_q)
  `PROVE(a_word, !(rst_n && tvalid) || tdata == {place_i, sent_q ? second_i : first_i, confidence_i})
  `PROVE(a_tlast, !(rst_n && tvalid) || tlast == (s_tlast_i && (sent_q || !both_i)))
  `GOAL(rst_n && pop && tlast && second && waited_q)

endmodule

`default_nettype wire
