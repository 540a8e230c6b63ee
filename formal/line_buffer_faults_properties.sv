// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_line_buffer: an acquisition that has begun is never interrupted, and every line reaches the array at its place, a
// missing line as no detection. This holds for any pace of source and array, for s_tlast_i in any line, with flushes, aborts and
// timeouts, and from reset at any time. A source that cannot wait (SOURCE_WAITS = 0) loses only whole acquisitions that the array has not
// begun. The harness watches one arbitrary line of every eighth acquisition.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module line_buffer_faults_properties #(
    parameter int ACQUISITION_LINES = 2,
    parameter int LINES = 2,
    parameter int WIDTH = 1,
    parameter int WHOLE = 0,  // 1: an acquisition is complete when it begins
    parameter int REGISTERS = 0,
    parameter int CLOCK_WAITS = 0,
    parameter int SOURCE_WAITS = 1,
    localparam int LEVEL_WIDTH = $clog2(LINES + 2)
) (
    input logic                   clk_i,
    input logic                   reset_i,
    input logic                   flush_i,
    input logic                   abort_i,
    input logic                   expire_i,
    input logic                   done_i,
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
  logic [LEVEL_WIDTH:0] lost_lines;
  logic underrun, is_short, is_long, s_tready, line_valid, starved, kept, waits, dropped, early;
  logic [1:0] lost_acquisitions;
  logic [WIDTH-1:0] line;

  dtof_line_buffer #(
      .ACQUISITION_LINES(ACQUISITION_LINES),
      .LINES            (LINES),
      .WIDTH            (WIDTH),
      .REGISTERS        (REGISTERS),
      .CLOCK_WAITS      (CLOCK_WAITS),
      .SOURCE_WAITS     (SOURCE_WAITS)
  ) u_dut (
      .clk_i             (clk_i),
      .rst_ni            (rst_n),
      .flush_i           (flush_i),
      .abort_i           (abort_i),
      .expire_i          (expire_i),
      .done_i            (done_i),
      .release_i         (release_i),
      .level_o           (level),
      .starved_o         (starved),
      .wait_o            (waits),
      .dropped_o         (dropped),
      .early_o           (early),
      .kept_o            (kept),
      .underrun_o        (underrun),
      .short_o           (is_short),
      .long_o            (is_long),
      .lost_lines_o      (lost_lines),
      .lost_acquisitions_o(lost_acquisitions),
      .s_tvalid_i        (s_tvalid_i),
      .s_tready_o        (s_tready),
      .s_tdata_i         (s_tdata_i),
      .s_tlast_i         (s_tlast_i),
      .line_valid_o      (line_valid),
      .line_ready_i      (line_ready_i),
      .line_o            (line)
  );

  // Both sides count acquisitions, modulo 8, and lines. The sides are at most LINES + 1 acquisitions apart.
  (* anyconst *) logic [2:0] watched_acquisition;
  (* anyconst *) logic [3:0] watched_line;
  logic [2:0] in_acquisition_q, out_acquisition_q;
  logic [3:0] in_line_q, out_line_q;
  logic live_q, lost_q, come_q, push, thrown, keep, in_last, step, out_last, at_watched, waits_q, drains_q, behind_q, timeout, starves;
  logic rest_q;  // the source is delivering the rest of a long or a dropped acquisition
  logic [WIDTH-1:0] expected_q;
  logic [3:0] wait_q;  // clocks in which the memory is full and no line is offered

  assign push = s_tvalid_i && s_tready;
  assign thrown = push && (flush_i || abort_i || timeout);  // lines that a source which cannot wait loses in this clock
  assign keep = push && !behind_q && !thrown && !dropped;
  assign in_last = (32'(in_line_q) == ACQUISITION_LINES - 1);
  assign step = line_valid && line_ready_i && !waits;
  assign out_last = (32'(out_line_q) == ACQUISITION_LINES - 1);
  assign at_watched = !drains_q && (out_acquisition_q == watched_acquisition) && (out_line_q == watched_line);
  assign starves = ((waits_q || line_ready_i) && !line_valid) || (waits && level == '0);
  assign timeout = expire_i && starves;

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      live_q <= 1'b0;
      in_acquisition_q <= '0;
      out_acquisition_q <= '0;
      in_line_q <= '0;
      out_line_q <= '0;
      lost_q <= 1'b0;
      come_q <= 1'b0;
      wait_q <= '0;
      waits_q <= 1'b0;
      drains_q <= 1'b0;
      behind_q <= 1'b0;
      rest_q <= 1'b0;
    end else begin
      live_q <= 1'b1;
      if (push) behind_q <= !s_tlast_i && (behind_q || in_last || dropped);
      if (push) rest_q <= !s_tlast_i && (rest_q || (keep && in_last) || dropped);
      if (dropped) begin
        in_line_q <= '0;
        if (in_acquisition_q == watched_acquisition) come_q <= 1'b0;
      end
      if (keep) begin
        in_line_q <= (in_last || s_tlast_i) ? '0 : in_line_q + 1'b1;
        if (in_last || s_tlast_i) in_acquisition_q <= in_acquisition_q + 1'b1;
        if (in_acquisition_q == watched_acquisition && in_line_q == watched_line) begin
          come_q <= 1'b1;
          expected_q <= s_tdata_i;
        end
      end
      if (step) begin
        out_line_q <= out_last ? '0 : out_line_q + 1'b1;
        if (out_last && !drains_q) begin
          out_acquisition_q <= out_acquisition_q + 1'b1;
          if (out_acquisition_q == watched_acquisition) come_q <= 1'b0;
        end
        lost_q <= (lost_q || underrun) && !out_last;
      end
      // The watched line of an acquisition that ran empty may come after the array has passed it.
      if (keep && in_acquisition_q == watched_acquisition && in_line_q == watched_line
          && out_acquisition_q != in_acquisition_q && 3'(in_acquisition_q + 1'b1) == out_acquisition_q) come_q <= 1'b0;
      waits_q <= (waits_q || line_ready_i) && !line_valid;
      drains_q <= timeout || (drains_q && !done_i);
      wait_q <= (32'(level) >= LINES && !line_valid) ? wait_q + 1'b1 : '0;
      if (flush_i || abort_i || timeout) begin
        behind_q <= !flush_i && (push ? !s_tlast_i : behind_q || in_line_q != '0);
        rest_q <= 1'b0;
        in_acquisition_q <= '0;
        out_acquisition_q <= '0;
        in_line_q <= '0;
        come_q <= 1'b0;
        wait_q <= '0;
      end
      if (abort_i) begin
        out_line_q <= '0;
        lost_q <= 1'b0;
        waits_q <= 1'b0;
        drains_q <= 1'b0;
      end
    end
  end

  // With a source that cannot wait, an acquisition that does not fit the buffer is offered a clock before the buffer is full.
  logic cannot_hold, latest, offered_q;
  assign cannot_hold = (SOURCE_WAITS == 0) && (LINES < ACQUISITION_LINES);
  assign latest = cannot_hold && (32'(level) >= LINES - 1);
  always_ff @(posedge clk_i) begin
    offered_q <= line_valid;
  end

  logic under_way, over;
  assign under_way = (out_line_q != '0);
  assign over = (in_acquisition_q != out_acquisition_q);  // the source has already ended the acquisition that the array is in

  `ASSUME(m_release, release_i != '0 && 32'(release_i) <= ACQUISITION_LINES && (CLOCK_WAITS != 0 || 32'(release_i) <= LINES)
                     && (WHOLE == 0 || 32'(release_i) == ACQUISITION_LINES))
  `ASSUME(m_flush_between, !flush_i || abort_i || (!under_way && !line_ready_i && !waits_q && !drains_q))
  `ASSUME(m_done_between, !done_i || (!under_way && !line_ready_i && !waits_q))
  `ASSUME(m_watched, 32'(watched_line) < ACQUISITION_LINES)
  `PROVE(a_uninterrupted, !rst_n || !under_way || line_valid)
  `PROVE(a_released, !rst_n || under_way || !line_valid || drains_q || over || latest || 16'(level) >= ((CLOCK_WAITS != 0) ? 16'd1 : release_i))
  `PROVE(a_offered, !rst_n || !dropped || offered_q || lost_q)
  `PROVE(a_waits, !rst_n || !waits || (CLOCK_WAITS != 0 && under_way && !lost_q && !drains_q && (REGISTERS == 0 || level == '0)))
  `PROVE(a_no_underrun, !rst_n || CLOCK_WAITS == 0 || !underrun)
  `PROVE(a_dropped, !rst_n || !dropped || (SOURCE_WAITS == 0 && push && !behind_q && !thrown
                                           && 32'(level) >= ((REGISTERS != 0) ? LINES : LINES - 1)))
  `PROVE(a_dropped_whole, !rst_n || !dropped || !under_way || drains_q || over || in_line_q == '0)
  `PROVE(a_line, !rst_n || !step || !at_watched || lost_q || underrun || (come_q ? line == expected_q : over && line == {WIDTH{1'b1}}))
  `PROVE(a_lost, !rst_n || !step || !(lost_q || underrun || drains_q) || line == {WIDTH{1'b1}})
  `PROVE(a_underrun_inside, !rst_n || !underrun || (step && under_way && !lost_q && !drains_q && level <= 1))
  `PROVE(a_whole_never_runs_empty, !rst_n || WHOLE == 0 || !underrun)
  `PROVE(a_drains, !rst_n || !drains_q || line_valid)
  `PROVE(a_takes_lines, !rst_n || s_tready || !live_q || (SOURCE_WAITS != 0
                                                          && (flush_i || abort_i || expire_i || (32'(level) >= LINES && !behind_q))))
  `PROVE(a_takes_none_in_reset, live_q || !rst_n || !s_tready)
  `PROVE(a_level, !rst_n || 32'(level) <= LINES + ((REGISTERS != 0) ? 0 : 1))
  `PROVE(a_kept, !rst_n || kept == keep)
  `PROVE(a_short, !rst_n || is_short == (keep && s_tlast_i && !in_last))
  `PROVE(a_long, !rst_n || is_long == (keep && !s_tlast_i && in_last))
  `PROVE(a_starved, !rst_n || starved == starves)
  `PROVE(a_lost_acquisition, !rst_n || !(step && out_last && (lost_q || underrun || drains_q)) || lost_acquisitions != 2'(dropped))
  `PROVE(a_nothing_lost, !rst_n || lost_acquisitions == 2'(dropped) || (lost_acquisitions == 2'(dropped) + 1'b1 && step && out_last))
  `PROVE(a_early_in_a_rest, !rst_n || !rest_q || early)
  `PROVE(a_early, !rst_n || CLOCK_WAITS != 0 || early == (rest_q || (cannot_hold && (in_line_q != '0 || !starves))))
  `PROVE(a_goes_on, !rst_n || 32'(wait_q) <= ACQUISITION_LINES + 1)
  `GOAL(rst_n && step && at_watched && watched_acquisition == 3'd1 && !lost_q && !underrun
        && 32'(watched_line) == ACQUISITION_LINES - 1)

  logic unused;
  assign unused = ^lost_lines;

endmodule

`default_nettype wire
