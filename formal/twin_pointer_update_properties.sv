// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_twin_pointer_update, dtof_pixel_distance and dtof_label_match together, from timestamp and word to the next word: a
// pixel's pointer word after one timestamp follows docs/reference/poolpointer.md, Point, on integers.
`include "dtof_macros.svh"
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module twin_pointer_update_properties `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int LABELS = 5,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES),
    localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES)
) (
    input logic                   clk_i,
    input logic                   update_i,
    input logic                   valid_i,
    input logic [           15:0] position_i,
    input logic [            3:0] acquisition_i,
    input logic                   thinned_i,
    input logic [POINT_WIDTH-1:0] word_i,
    input logic [   LABELS*7-1:0] cells_i
);

  logic checking;
  assign checking = 1'b1;

  logic [LABELS-1:0] hits;
  `DTOF_TYPE(dtof_pool_pkg, pixel_distance_t) distance;
  logic [POINT_WIDTH-1:0] word;
  logic changed;

  dtof_label_match #(
      .LABELS(LABELS)
  ) u_label_match (
      .valid_i (valid_i),
      .cell_i  (position_i[15:9]),
      .cells_i (cells_i),
      .hits_o  (hits)
  );

  localparam int U = 1 << POINTER_SHIFT;
  localparam int HALF = 1 << (ADVANTAGE_WIDTH - 1);
  localparam int RIVAL_REACH = (RIVAL_MOVES != 0) ? 6 : 4;  // a resting rival is a candidate and has a candidate's window
  localparam int FULL = (1 << ADVANTAGE_WIDTH) - 1;

  function automatic integer cell_of(input integer label);
    cell_of = 32'((cells_i >> (7 * label)) & (LABELS * 7)'(127));
  endfunction

  integer n, x, pointer, a, b, pa, pb, origin, lowest, highest, e, f, away, w, step, dither, move, period;
  integer next_n, next_pa, next_pb, next_a, next_b;
  logic expected_hit, rival, counted, roles_change;
  logic [POINT_WIDTH-1:0] expected;

  dtof_pixel_distance #(
      .LABELS         (LABELS),
      .SCORES_WIDTH   (4 * LABELS),
      .OFFSET_BITS    (0),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES),
      .PIXEL_WIDTH    (POINT_WIDTH)
  ) u_pixel_distance (
      .valid_i      (valid_i),
      .position_i   (position_i),
      .word_i       (word_i),
      .leader_cell_i(7'(cell_of(a))),
      .hits_i       (hits),
      .distance_o   (distance)
  );

  dtof_twin_pointer_update #(
      .LABELS         (LABELS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES)
  ) u_dut (
      .update_i     (update_i),
      .word_i       (word_i),
      .reach_i      (distance.reach),
      .up_i         (distance.up),
      .weight_i     (distance.weight),
      .gear_i       (distance.gear),
      .hit_i        (distance.hit),
      .rival_hit_i  (distance.rival_hit),
      .rival_up_i   (distance.rival_up),
      .rival_down_i (distance.rival_down),
      .thinned_i    (thinned_i),
      .acquisition_i(acquisition_i),
      .changed_o    (changed),
      .word_o       (word)
  );

  always_comb begin
    x = 32'(position_i);
    pointer = 32'(word_i) & ((1 << POINTER_WIDTH) - 1);
    n = 32'(word_i >> (POINT_WIDTH - ADVANTAGE_WIDTH)) & FULL;
    a = 0;
    b = 0;
    pb = 0;
    if (RIVAL_MOVES != 0) begin
      origin = 0;
      pb = 32'(word_i >> POINTER_WIDTH) & 127;
      lowest = 0;
      highest = 65536 - U;
      f = (x >>> 9) - pb;
    end else begin
      a = 32'(word_i >> POINTER_WIDTH) & ((1 << LABEL_WIDTH) - 1);
      b = 32'(word_i >> (POINTER_WIDTH + LABEL_WIDTH)) & ((1 << LABEL_WIDTH) - 1);
      if (pointer >= (1 << POINTER_WIDTH) / 2) pointer = pointer - (1 << POINTER_WIDTH);
      origin = 512 * cell_of(a);
      lowest = origin - 2048;
      highest = origin + 2048 - U;
      f = (x >>> 9) - cell_of(b);
    end
    pa = origin + pointer * U;
    e = (x - pa) >>> 9;
    expected_hit = valid_i && e >= -5 && e <= 4;
    rival = valid_i && !expected_hit && f >= -RIVAL_REACH && f < RIVAL_REACH;

    // Move of the pointer.
    away = (e >= 0) ? e : -1 - e;
    w = (away == 0 || away == 7) ? 1 : (away == 6) ? 2 : (away == 1 || away == 5) ? 3 : 4;
    if (ADVANTAGE_WIDTH == 7) begin
      step = (n >= 124) ? 1 : (n >= 116) ? 2 : (n >= 100) ? 4 : (n >= 80) ? 8 : (n >= 64) ? 16 : (n >= 32) ? 32
          : (n >= 16) ? 64 : (n >= 8) ? 128 : 256;
    end else begin
      step = (n >= 15) ? 16 : (n >= 14) ? 32 : (n >= 12) ? 64 : (n >= 8) ? 128 : (n >= 4) ? 256 : 512;
    end
    dither = 32'(acquisition_i[1:0]) * U + (32'(acquisition_i[3:2]) & (U - 1));
    move = ((step * w + dither) >>> 2) & ~(U - 1);
    next_pa = pa;
    if (valid_i && e >= -8 && e <= 7) begin
      next_pa = (e >= 0) ? pa + move : pa - move;
      if (next_pa < lowest) next_pa = lowest;
      if (next_pa > highest) next_pa = highest;
    end

    // Rival, advantage, change of roles.
    next_pb = pb + ((rival && f > 0) ? 1 : (rival && f < 0) ? -1 : 0);
    next_a = a;
    next_b = b;
    period = (n < HALF) ? 1 : (n < HALF + HALF / 2) ? 4 : 16;
    counted = !thinned_i && (32'(acquisition_i) & (period - 1)) == 0;
    roles_change = rival && n == 0;
    next_n = n;
    if (expected_hit && counted && n < FULL) next_n = n + 1;
    if (rival && counted && n > 0) next_n = n - 1;
    if (roles_change) begin
      next_n = 1;
      next_pa = 512 * pb + 256;
      next_pb = pa >>> 9;
      next_a = b;
      next_b = a;
    end
    if (RIVAL_MOVES != 0) begin
      expected = (POINT_WIDTH'(next_n) << (POINTER_WIDTH + 7)) | (POINT_WIDTH'(next_pb) << POINTER_WIDTH)
          | POINT_WIDTH'(next_pa >>> POINTER_SHIFT);
    end else begin
      // The new leader's pointer starts at its candidate.
      expected = (POINT_WIDTH'(next_n) << (POINTER_WIDTH + 2 * LABEL_WIDTH))
          | (POINT_WIDTH'(next_b) << (POINTER_WIDTH + LABEL_WIDTH)) | (POINT_WIDTH'(next_a) << POINTER_WIDTH)
          | POINT_WIDTH'(roles_change ? 0 : ((next_pa - origin) >>> POINTER_SHIFT) & ((1 << POINTER_WIDTH) - 1));
    end
  end

  `ASSUME(m_candidates_in_use, a < LABELS && b < LABELS)
  `PROVE(a_word, word == (update_i ? expected : '0))
  `PROVE(a_stays, changed || !update_i || word == word_i)
  `PROVE(a_changes, !changed || (update_i && (word != word_i || next_pa == lowest || next_pa == highest)))
  `GOAL(update_i && roles_change && distance.reach)

endmodule

`default_nettype wire
