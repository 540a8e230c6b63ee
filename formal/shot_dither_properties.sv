// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_shot_dither, before any source that answers each shot with one acquisition, and an array that needs any time for
// each: a frame has exactly one shot per acquisition. A shot comes 2 + delay clocks after its request; the delay comes from a
// register that makes its steps one by one. FREE = 1: whatever source, aborts, flushes and timeouts do, a shot fires only in a frame that
// needs an acquisition, never while an acquisition is outstanding or has not begun, never while early_i is high, and never in two
// successive clocks.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module shot_dither_properties #(
    parameter int FREE = 0,
    parameter int ACQ_WIDTH = 2,
    parameter int BITS_WIDTH = 2,
    parameter int UNIT_WIDTH = 2
) (
    input logic                  clk_i,
    input logic                  reset_i,
    input logic                  reseed_i,
    input logic [          15:0] seed_i,
    input logic [BITS_WIDTH-1:0] bits_i,
    input logic [UNIT_WIDTH-1:0] unit_i,
    input logic [ ACQ_WIDTH-1:0] acquisitions_i,
    input logic                  begin_i,
    input logic                  abort_i,
    input logic                  flush_i,
    input logic                  give_up_i,
    input logic                  arrives_i,
    input logic                  taken_i,
    input logic                  inside_i,
    input logic                  early_i,
    input logic                  rest_ends_i
);

  localparam int UNITS_WIDTH = (1 << BITS_WIDTH) - 1;

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic shot;
  logic [15:0] first_state;
  logic [1:0] queued_q;  // acquisitions that have arrived and that the array has not begun

  dtof_shot_dither #(
      .ACQ_WIDTH (ACQ_WIDTH),
      .BITS_WIDTH(BITS_WIDTH),
      .UNIT_WIDTH(UNIT_WIDTH)
  ) u_dut (
      .clk_i         (clk_i),
      .rst_ni        (rst_n),
      .reseed_i      (reseed_i),
      .seed_i        (seed_i),
      .bits_i        (bits_i),
      .unit_i        (unit_i),
      .acquisitions_i(acquisitions_i),
      .begin_i       (begin_i),
      .abort_i       (abort_i),
      .flush_i       (flush_i),
      .give_up_i     (give_up_i),
      .arrives_i     (arrives_i),
      .queued_i      (queued_q != '0),
      .taken_i       (taken_i),
      .inside_i      (inside_i),
      .early_i       (early_i),
      .rest_ends_i   (rest_ends_i),
      .shot_o        (shot),
      .first_state_o (first_state)
  );

  // State of frame, source and array, as the ports show it.
  logic [ACQ_WIDTH:0] shots_q, taken_q, frame_q;  // shots and begun acquisitions of the frame; number of acquisitions of the frame
  logic [BITS_WIDTH-1:0] bits_q;
  logic [UNIT_WIDTH-1:0] unit_q;
  logic owed_q, running_q, shot_before_q, early_before_q, ends;
  logic needs;  // an acquisition may be requested

  assign ends = abort_i || flush_i || give_up_i;
  assign needs = running_q && (taken_q != frame_q) && (queued_q == '0) && !owed_q && !shot && !early_i && !arrives_i
      && !begin_i && !ends;

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      {shots_q, taken_q, frame_q, bits_q, unit_q} <= '0;
      {owed_q, running_q, shot_before_q, early_before_q, queued_q} <= '0;
    end else begin
      shot_before_q <= shot;
      early_before_q <= early_i;
      if (begin_i) begin
        running_q <= 1'b1;
        shots_q <= '0;
        taken_q <= '0;
        frame_q <= (ACQ_WIDTH + 1)'(acquisitions_i);
        bits_q <= bits_i;
        unit_q <= unit_i;
      end else begin
        shots_q <= shots_q + (ACQ_WIDTH + 1)'(shot && shots_q != '1);
        taken_q <= taken_q + (ACQ_WIDTH + 1)'(taken_i && taken_q != frame_q);
      end
      if (abort_i || give_up_i) begin
        running_q <= 1'b0;
      end
      queued_q <= ends ? '0 : queued_q + 2'(arrives_i) - 2'(taken_i && queued_q != '0);
      owed_q <= (shot || owed_q) && !arrives_i && !flush_i && !give_up_i;
    end
  end

  `ASSUME(m_taken, !taken_i || queued_q != '0)
  `ASSUME(m_queue, !arrives_i || queued_q != '1)
  `ASSUME(m_command, !ends || (!taken_i && !begin_i))

  // Properties that hold for any source.
  `PROVE(a_in_a_frame, !rst_n || !shot || (running_q && taken_q != frame_q))
  `PROVE(a_none_waits, !rst_n || !shot || queued_q == '0)
  `PROVE(a_none_owed, !rst_n || !shot || !owed_q)
  `PROVE(a_not_early, !rst_n || !(shot && early_before_q))
  `PROVE(a_one_clock, !rst_n || !(shot && shot_before_q))

  generate
    if (FREE == 0) begin : g_paced
      // Reference register, which makes one step at a time.
      logic [15:0] state_q, first_state_q, stepped;
      logic [16*16-1:0] states;
      genvar i;
      assign states[15:0] = state_q;
      for (i = 1; i < 16; i = i + 1) begin : g_step
        assign states[16*i+:16] = {states[16*i-16] ^ states[16*i-14] ^ states[16*i-13] ^ states[16*i-11], states[16*i-15+:15]};
      end
      assign stepped = {states[240] ^ states[242] ^ states[243] ^ states[245], states[241+:15]};

      // A request, and the clocks until its shot.
      logic waits_q;
      logic [UNITS_WIDTH+UNIT_WIDTH:0] due_q, delay;
      assign delay = (UNITS_WIDTH + UNIT_WIDTH + 1)'(state_q[UNITS_WIDTH-1:0] & ~({UNITS_WIDTH{1'b1}} << bits_q))
          * (UNITS_WIDTH + UNIT_WIDTH + 1)'(unit_q);

      always_ff @(posedge clk_i) begin
        if (!rst_n) begin
          state_q <= 16'd1;
          first_state_q <= 16'd1;
          waits_q <= 1'b0;
          due_q <= '0;
        end else begin
          if (reseed_i) begin
            state_q <= (seed_i == '0) ? 16'd1 : seed_i;
          end else if (needs && !waits_q && bits_q != '0) begin
            state_q <= stepped;
          end
          if (begin_i) begin
            first_state_q <= !reseed_i ? state_q : (seed_i == '0) ? 16'd1 : seed_i;
          end
          if (needs && !waits_q) begin
            waits_q <= 1'b1;
            due_q <= delay + 1'b1;
          end else if (shot) begin
            waits_q <= 1'b0;
          end else if (due_q != '0) begin
            due_q <= due_q - 1'b1;
          end
        end
      end

      `ASSUME(m_no_command, !ends)
      `ASSUME(m_early, !early_i || !waits_q)
      `ASSUME(m_answers, !arrives_i || owed_q)
      `ASSUME(m_begin, !begin_i || (taken_q == frame_q && !shot))
      `PROVE(a_first_state, !rst_n || first_state == first_state_q)
      `PROVE(a_when_due, !rst_n || shot == (waits_q && due_q == '0))
      `PROVE(a_one_each, !rst_n || shots_q == taken_q || (shots_q == taken_q + 1'b1 && !shot))
      `PROVE(a_as_many, !rst_n || !running_q || taken_q != frame_q || shots_q == frame_q)
      `PROVE(a_not_zero, !rst_n || state_q != '0)
      `GOAL(rst_n && running_q && taken_q == frame_q && frame_q == 2 && bits_q == 2 && unit_q == 2)
    end else begin : g_free
      `GOAL(rst_n && shot && shots_q == 1 && abort_i)
    end
  endgenerate

endmodule

`default_nettype wire
