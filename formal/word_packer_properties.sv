// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_word_packer: every word leaves once and in order, in its half of a beat, under any back-pressure and from reset at any
// time; frames of other words pass unchanged.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module word_packer_properties (
    input logic        clk_i,
    input logic        reset_i,
    input logic        short_i,
    input logic        s_tvalid_i,
    input logic [63:0] s_tdata_i,
    input logic        s_tlast_i,
    input logic        m_tready_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic s_tready, tvalid, tuser, tlast, begins_q;
  logic [63:0] tdata;

  dtof_word_packer u_dut (
      .clk_i     (clk_i),
      .rst_ni    (rst_n),
      .short_i   (short_i),
      .s_tvalid_i(s_tvalid_i),
      .s_tready_o(s_tready),
      .s_tdata_i (s_tdata_i),
      .s_tuser_i (begins_q),
      .s_tlast_i (s_tlast_i),
      .m_tvalid_o(tvalid),
      .m_tready_i(m_tready_i),
      .m_tdata_o (tdata),
      .m_tuser_o (tuser),
      .m_tlast_o (tlast)
  );

  // {aborted, second, saturated, masked, empty, weak, valid, confidence, position}
  function automatic logic [31:0] shortened(input logic [63:0] word);
    shortened = {word[63], word[61:56], (word[31:16] > 16'd511) ? 9'd511 : word[24:16], word[15:0]};
  endfunction

  // The present frame: whether an odd number of its words was taken, and the last of them.
  logic odd_q, short_q, last_begins_q, push, pop, complete;
  logic [63:0] last_q;

  assign push = s_tvalid_i && s_tready;
  assign pop = tvalid && m_tready_i;
  assign complete = !short_i || odd_q || s_tlast_i;  // the word at the input completes a beat

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      odd_q <= 1'b0;
      begins_q <= 1'b1;
    end else if (push) begin
      odd_q <= !s_tlast_i && !odd_q;
      begins_q <= s_tlast_i;
    end
    if (push) begin
      short_q <= short_i;
      last_q <= s_tdata_i;
      last_begins_q <= begins_q;
    end
  end

  axi_stream_rules #(
      .WIDTH  (66),
      .ASSUMED(1)
  ) u_source_rules (
      .clk_i   (clk_i),
      .rst_ni  (rst_n),
      .checking(checking),
      .tvalid_i(s_tvalid_i),
      .tready_i(s_tready),
      .tdata_i ({short_i, s_tlast_i, s_tdata_i})
  );

  axi_stream_rules #(
      .WIDTH(66)
  ) u_rules (
      .clk_i   (clk_i),
      .rst_ni  (rst_n),
      .checking(checking),
      .tvalid_i(tvalid),
      .tready_i(m_tready_i),
      .tdata_i ({tuser, tlast, tdata})
  );

  `ASSUME(m_one_kind, !(rst_n && s_tvalid_i) || begins_q || short_i == short_q)
  `PROVE(a_tvalid, !rst_n || tvalid == (s_tvalid_i && complete))
  `PROVE(a_taken, !rst_n || push == (s_tvalid_i && (pop || !complete)))
  `PROVE(a_word, !(rst_n && tvalid && !short_i) || (tdata == s_tdata_i && tuser == begins_q))
  `PROVE(a_pair, !(rst_n && tvalid && short_i && odd_q)
         || (tdata == {shortened(s_tdata_i), shortened(last_q)} && tuser == last_begins_q))
  `PROVE(a_alone, !(rst_n && tvalid && short_i && !odd_q) || (tdata == {32'd0, shortened(s_tdata_i)} && tuser == begins_q))
  `PROVE(a_tlast, !(rst_n && tvalid) || tlast == s_tlast_i)
  `GOAL(rst_n && pop && short_i && tlast && !odd_q && !tuser && tdata[24:16] == 9'd511)

endmodule

`default_nettype wire
