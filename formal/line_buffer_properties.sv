// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_line_buffer: an acquisition that has begun is never interrupted, except that with CLOCK_WAITS = 1 the array's clock stops
// exactly while the next line is late. Every line reaches the array at its place or, after an underrun, as no detection. This holds for
// any pace of source and array and from reset at any time. The harness watches one arbitrary line of every fourth acquisition. s_tlast_i is
// at the right line; line_buffer_faults_properties has all other cases.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module line_buffer_properties #(
    parameter int ACQUISITION_LINES = 2,
    parameter int LINES = 2,
    parameter int WIDTH = 1,
    parameter int WHOLE = 0,  // 1: an acquisition is complete when it begins
    parameter int REGISTERS = 0,
    parameter int CLOCK_WAITS = 0,
    localparam int LEVEL_WIDTH = $clog2(LINES + 2)
) (
    input logic                   clk_i,
    input logic                   reset_i,
    input logic                   flush_i,
    input logic [           15:0] release_i,
    input logic                   s_tvalid_i,
    input logic [      WIDTH-1:0] s_tdata_i,
    input logic                   s_tlast_i,
    input logic                   line_ready_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic [LEVEL_WIDTH-1:0] level;
  logic underrun, is_short, is_long, s_tready, line_valid, starved, kept, waits;
  logic [1:0] lost_acquisitions;
  logic [LEVEL_WIDTH:0] lost_lines;
  logic [WIDTH-1:0] line;

  dtof_line_buffer #(
      .ACQUISITION_LINES(ACQUISITION_LINES),
      .LINES            (LINES),
      .WIDTH            (WIDTH),
      .REGISTERS        (REGISTERS),
      .CLOCK_WAITS      (CLOCK_WAITS)
  ) u_dut (
      .clk_i       (clk_i),
      .rst_ni      (rst_n),
      .flush_i     (flush_i),
      .abort_i     (1'b0),
      .expire_i    (1'b0),
      .done_i      (1'b0),
      .release_i   (release_i),
      .level_o     (level),
      .underrun_o  (underrun),
      .starved_o   (starved),
      .wait_o      (waits),
      .kept_o      (kept),
      .short_o     (is_short),
      .long_o      (is_long),
      .lost_lines_o(lost_lines),
      .lost_acquisitions_o(lost_acquisitions),
      .s_tvalid_i  (s_tvalid_i),
      .s_tready_o  (s_tready),
      .s_tdata_i   (s_tdata_i),
      .s_tlast_i   (s_tlast_i),
      .line_valid_o(line_valid),
      .line_ready_i(line_ready_i),
      .line_o      (line)
  );

  // Both sides count acquisitions, modulo 4, and lines. The sides are at most LINES + 1 lines apart.
  (* anyconst *) logic [1:0] watched_acquisition;
  (* anyconst *) logic [3:0] watched_line;
  logic [1:0] in_acquisition_q, out_acquisition_q;
  logic [3:0] in_line_q, out_line_q;
  logic live_q, lost_q, come_q, push, step, at_watched;
  logic waited_q;  // in the last clock the array's clock was stopped for a line between the SRAM and its output
  logic [WIDTH-1:0] expected_q;
  logic [3:0] wait_q;  // clocks in which the memory is full and no line is offered

  assign push = s_tvalid_i && s_tready;
  assign step = line_valid && line_ready_i && !waits;
  assign at_watched = (out_acquisition_q == watched_acquisition) && (out_line_q == watched_line);

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      live_q <= 1'b0;
      in_acquisition_q <= '0;
      out_acquisition_q <= '0;
      in_line_q <= '0;
      out_line_q <= '0;
      lost_q <= 1'b0;
      waited_q <= 1'b0;
      come_q <= 1'b0;
      wait_q <= '0;
    end else begin
      live_q <= 1'b1;
      if (push) begin
        in_line_q <= (32'(in_line_q) == ACQUISITION_LINES - 1) ? '0 : in_line_q + 1'b1;
        if (32'(in_line_q) == ACQUISITION_LINES - 1) in_acquisition_q <= in_acquisition_q + 1'b1;
        if (in_acquisition_q == watched_acquisition && in_line_q == watched_line) begin
          come_q <= 1'b1;
          expected_q <= s_tdata_i;
        end
      end
      if (step) begin
        out_line_q <= (32'(out_line_q) == ACQUISITION_LINES - 1) ? '0 : out_line_q + 1'b1;
        if (32'(out_line_q) == ACQUISITION_LINES - 1) out_acquisition_q <= out_acquisition_q + 1'b1;
        lost_q <= (lost_q || underrun) && (32'(out_line_q) != ACQUISITION_LINES - 1);
        if (at_watched && !lost_q && !underrun) come_q <= 1'b0;
      end
      waited_q <= waits && level != '0;
      wait_q <= (32'(level) >= LINES && !line_valid) ? wait_q + 1'b1 : '0;
      if (flush_i) begin
        in_acquisition_q <= '0;
        out_acquisition_q <= '0;
        in_line_q <= '0;
        come_q <= 1'b0;
        wait_q <= '0;
      end
    end
  end

  logic under_way;
  assign under_way = (out_line_q != '0);

  `ASSUME(m_release, release_i != '0 && 32'(release_i) <= ACQUISITION_LINES && (CLOCK_WAITS != 0 || 32'(release_i) <= LINES)
                     && (WHOLE == 0 || 32'(release_i) == ACQUISITION_LINES))
  `ASSUME(m_flush_between, !flush_i || (!under_way && !line_ready_i))
  `ASSUME(m_tlast, s_tlast_i == (32'(in_line_q) == ACQUISITION_LINES - 1))
  `ASSUME(m_watched, 32'(watched_line) < ACQUISITION_LINES)
  `PROVE(a_uninterrupted, !rst_n || !under_way || line_valid)
  `PROVE(a_released, !rst_n || under_way || !line_valid || 16'(level) >= ((CLOCK_WAITS != 0) ? 16'd1 : release_i))
  `PROVE(a_waits, !rst_n || !waits || (CLOCK_WAITS != 0 && under_way && (REGISTERS == 0 || level == '0)))
  `PROVE(a_waits_for_a_line, !rst_n || CLOCK_WAITS == 0 || REGISTERS == 0 || waits == (under_way && level == '0))
  `PROVE(a_waits_at_most_for_the_sram, !rst_n || !waits || level == '0 || !waited_q)
  `PROVE(a_no_underrun, !rst_n || CLOCK_WAITS == 0 || !underrun)
  `PROVE(a_starved, !rst_n || !(waits && level == '0) || starved)
  `PROVE(a_line, !rst_n || !step || !at_watched || lost_q || underrun || (come_q && line == expected_q))
  `PROVE(a_lost, !rst_n || !step || !(lost_q || underrun) || line == {WIDTH{1'b1}})
  `PROVE(a_underrun_inside, !rst_n || !underrun || (step && under_way && !lost_q && level <= 1))
  `PROVE(a_whole_never_runs_empty, !rst_n || WHOLE == 0 || !underrun)
  `PROVE(a_takes_lines, !rst_n || s_tready || flush_i || !live_q || (32'(level) >= LINES && !(REGISTERS != 0 && step)))
  `PROVE(a_level, !rst_n || 32'(level) <= LINES + ((REGISTERS != 0) ? 0 : 1))
  `PROVE(a_framed, !rst_n || !(is_short || is_long))
  `PROVE(a_kept, !rst_n || kept == push)
  `PROVE(a_lost_acquisition, !rst_n || lost_acquisitions == 2'(step && (lost_q || underrun) && 32'(out_line_q) == ACQUISITION_LINES - 1))
  `PROVE(a_goes_on, !rst_n || 32'(wait_q) <= ACQUISITION_LINES + 1)
  `GOAL(rst_n && step && at_watched && watched_acquisition == 2'd1 && !lost_q && !underrun
        && 32'(watched_line) == ACQUISITION_LINES - 1)

  logic unused;
  assign unused = starved ^ ^lost_lines;

endmodule

`default_nettype wire
