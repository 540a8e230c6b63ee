// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_async_line_fifo: whatever the two clocks do, every line that is accepted leaves once, in order and whole; at most DEPTH lines
// are inside; a reset of either side at any time does what the module's header says. The harness follows one arbitrary line, and counts the
// lines in front of this line. Steps are those of the global clock; in each the clocks and resets may rise, fall or stay.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module async_line_fifo_properties #(
    parameter int WIDTH = 1,
    parameter int DEPTH = 2,
    parameter int TOGETHER = 0,     // 1: both clocks have an edge in every second step
    parameter int RESET_CLOCKS = 4  // clocks of the other side in a reset
) (
    input logic             clk_i,        // of the replayed counterexample alone
    input logic             clk_tdc_i,
    input logic             clk_read_i,
    input logic             reset_tdc_i,
    input logic             reset_read_i,
    input logic             s_tvalid_i,
    input logic [WIDTH-1:0] s_tdata_i,
    input logic             s_tlast_i,
    input logic             m_tready_i,
    input logic             watch_i       // follow the line that enters now
);

  logic checking = 1'b0;
  always @($global_clock) begin
    checking <= 1'b1;
  end

  logic rst_tdc_n, rst_n, s_tready, m_tvalid, m_tlast;
  logic [WIDTH-1:0] m_tdata;
  assign rst_tdc_n = checking && !reset_tdc_i;
  assign rst_n = checking && !reset_read_i;

  dtof_async_line_fifo #(
      .WIDTH(WIDTH),
      .DEPTH(DEPTH)
  ) u_dut (
      .clk_tdc_i (clk_tdc_i),
      .rst_tdc_ni(rst_tdc_n),
      .s_tvalid_i(s_tvalid_i),
      .s_tready_o(s_tready),
      .s_tdata_i (s_tdata_i),
      .s_tlast_i (s_tlast_i),
      .clk_i     (clk_read_i),
      .rst_ni    (rst_n),
      .m_tvalid_o(m_tvalid),
      .m_tready_i(m_tready_i),
      .m_tdata_o (m_tdata),
      .m_tlast_o (m_tlast)
  );

  // The step before; flip-flops sample it at a rising edge in this step.
  logic clk_tdc_q = 1'b1, clk_read_q = 1'b1;
  logic accepted_q = 1'b0, taken_q = 1'b0, valid_q = 1'b0;
  logic rst_tdc_q = 1'b0, rst_q = 1'b0;
  logic [WIDTH:0] in_q, out_q;
  logic tdc_edge, read_edge, push, pop;
  always @($global_clock) begin
    clk_tdc_q <= clk_tdc_i;
    clk_read_q <= clk_read_i;
    rst_tdc_q <= rst_tdc_n;
    rst_q <= rst_n;
    accepted_q <= s_tvalid_i && s_tready;
    taken_q <= m_tvalid && m_tready_i;
    valid_q <= m_tvalid;
    in_q <= {s_tlast_i, s_tdata_i};
    out_q <= {m_tlast, m_tdata};
  end
  assign tdc_edge = clk_tdc_i && !clk_tdc_q;
  assign read_edge = clk_read_i && !clk_read_q;
  assign push = tdc_edge && rst_tdc_q && accepted_q;
  assign pop = read_edge && rst_q && taken_q;

  // Lines that must leave. One that was accepted in the TDCs' last clock before a reset need not.
  logic pending_q = 1'b0, kept_inside_q = 1'b0;
  logic skip_q, source_inside_q;
  logic [WIDTH:0] pending_line_q;
  logic commit, cut, enter;
  logic [WIDTH:0] entering;
  logic [3:0] inside_q = '0;  // lines in the FIFO
  logic [3:0] ahead_q;        // lines in front of the watched one
  logic end_q = 1'b0;         // one of them ends an acquisition that a reset has cut
  logic watching_q = 1'b0;
  logic [WIDTH:0] watched_q;

  assign commit = tdc_edge && rst_tdc_q && pending_q;
  assign cut = !rst_tdc_q && kept_inside_q;
  assign enter = (commit || cut) && rst_n;
  assign entering = commit ? pending_line_q : {(WIDTH + 1) {1'b1}};

  always @($global_clock) begin
    // source
    if (!rst_tdc_n) begin
      {source_inside_q, skip_q, pending_q} <= '0;
    end else begin
      if (push) source_inside_q <= !in_q[WIDTH];
      if (!rst_n) begin
        skip_q <= push ? !in_q[WIDTH] : source_inside_q;
      end else if (push && in_q[WIDTH]) begin
        skip_q <= 1'b0;
      end
      pending_q <= rst_n && (push ? !skip_q : pending_q && !commit);
      if (push) pending_line_q <= in_q;
    end
    // inside
    if (!rst_n) begin
      {kept_inside_q, inside_q, ahead_q, end_q, watching_q} <= '0;
    end else begin
      if (commit) kept_inside_q <= !pending_line_q[WIDTH];
      else if (cut) kept_inside_q <= 1'b0;
      inside_q <= inside_q + 4'(enter) - 4'(pop);
      end_q <= cut || (end_q && !(pop && inside_q == 4'd1));
      if (enter && watch_i && !watching_q) begin
        watching_q <= 1'b1;
        watched_q <= entering;
        ahead_q <= inside_q - 4'(pop);
      end else if (pop) begin
        if (ahead_q == '0) watching_q <= 1'b0;
        ahead_q <= ahead_q - 4'd1;
      end
    end
  end

  // Clocks of the other side in a reset, and how long something has not come.
  // The first reset may be shorter.
  logic [2:0] tdc_reset_q = 3'(RESET_CLOCKS - 1), reset_q = 3'(RESET_CLOCKS - 1);
  logic [2:0] late_q = '0;
  logic [4:0] closed_q = '0;
  logic tdc_ticked_q, read_ticked_q;
  always @($global_clock) begin
    tdc_reset_q <= rst_tdc_n ? '0 : (tdc_reset_q == 3'd7) ? tdc_reset_q : tdc_reset_q + 3'(read_edge);
    reset_q <= rst_n ? '0 : (reset_q == 3'd7) ? reset_q : reset_q + 3'(tdc_edge);
    late_q <= (!rst_n || inside_q == '0 || m_tvalid) ? '0 : (late_q == 3'd7) ? late_q : late_q + 3'(read_edge);
    if (!rst_n || !rst_tdc_n || inside_q != '0 || s_tready) begin
      {closed_q, tdc_ticked_q, read_ticked_q} <= '0;
    end else begin
      tdc_ticked_q <= tdc_ticked_q || tdc_edge;
      read_ticked_q <= read_ticked_q || read_edge;
      if (tdc_ticked_q && read_ticked_q) begin
        {tdc_ticked_q, read_ticked_q} <= '0;
        closed_q <= (closed_q == 5'd31) ? closed_q : closed_q + 5'd1;
      end
    end
  end

  `ASSUME(m_tdc_reset, !rst_tdc_n || rst_tdc_q || 32'(tdc_reset_q) >= RESET_CLOCKS)
  `ASSUME(m_reset, !rst_n || rst_q || 32'(reset_q) >= RESET_CLOCKS)
  `ASSUME(m_together, TOGETHER == 0 || (clk_read_i != clk_read_q && clk_tdc_i == clk_read_i))
  `PROVE(a_depth, 32'(inside_q) + 32'(pending_q) <= DEPTH + 32'(end_q))
  `PROVE(a_there, !m_tvalid || inside_q != '0)
  `PROVE(a_line, !pop || !rst_n || !watching_q || ahead_q != '0 || out_q == watched_q)
  `PROVE(a_stays, !valid_q || pop || !rst_q || !rst_n || (m_tvalid && {m_tlast, m_tdata} == out_q))
  `PROVE(a_reset, (rst_tdc_n || !s_tready) && (rst_n || !m_tvalid))
  `PROVE(a_closed_in_reset, 32'(reset_q) < RESET_CLOCKS || !s_tready)
  `PROVE(a_comes, 32'(late_q) <= 6)
  `PROVE(a_opens, 32'(closed_q) <= 20)
  `GOAL(pop && watching_q && ahead_q == '0 && watched_q == {1'b1, {WIDTH{1'b0}}} && inside_q == 4'd2)

  logic unused;
  assign unused = clk_i;

endmodule

`default_nettype wire
