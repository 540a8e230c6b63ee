// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pixel_distance: the distance of a timestamp from the position in a pixel's word follows docs/reference/poolpointer.md,
// Track and Point, on integers.
`include "dtof_macros.svh"
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pixel_distance_properties `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    parameter int CELL_SHIFT = 9,
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS),
    localparam int SCORES_WIDTH = LABELS * SCORE_BITS,
    localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(LABELS, SCORE_BITS, OFFSET_BITS),
    localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES),
    localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES),
    localparam int PIXEL_WIDTH = dtof_pkg::max_of(TRACK_WIDTH, POINT_WIDTH)
) (
    input logic                   clk_i,
    input logic                   valid_i,
    input logic [           15:0] position_i,
    input logic                   point_i,
    input logic [PIXEL_WIDTH-1:0] word_i,
    input logic [   LABELS*7-1:0] cells_i
);

  logic checking;
  assign checking = 1'b1;

  logic [LABELS-1:0] hits;
  `DTOF_TYPE(dtof_pool_pkg, pixel_distance_t) distance;

  dtof_label_match #(
      .LABELS(LABELS)
  ) u_label_match (
      .valid_i (valid_i),
      .cell_i  (position_i[15:9]),
      .cells_i (cells_i),
      .hits_o  (hits)
  );

  function automatic integer cell_of(input integer label);
    cell_of = 32'((cells_i >> (7 * label)) & (LABELS * 7)'(127));
  endfunction

  // Track: distance to the leader's position, which is its candidate plus the offset.
  integer x, leader, offset, leader_position, track_cells;
  assign x = 32'(position_i);
  always_comb begin
    leader = 0;
    offset = 0;
    if (OFFSET_BITS > 0) begin
      leader = 32'(word_i >> SCORES_WIDTH) & ((1 << LABEL_WIDTH) - 1);
      offset = 32'(word_i >> (SCORES_WIDTH + LABEL_WIDTH)) & ((1 << OFFSET_BITS) - 1);
      if (offset >= (1 << OFFSET_BITS) / 2) offset = offset - (1 << OFFSET_BITS);
    end
    leader_position = 512 * cell_of(leader) + 64 * offset;
    track_cells = (x - leader_position) >>> 9;
  end

  // Point: Qa and Qb of the word, e and f of the equations.
  integer a, b, qa, rival_cell, pointer, e, f, n, away, step, expected_weight;
  localparam int RIVAL_REACH = (RIVAL_MOVES != 0) ? 6 : 4;  // a resting rival is a candidate and has a candidate's window
  logic expected_reach, expected_hit, expected_rival_hit;
  always_comb begin
    pointer = 32'(word_i) & ((1 << POINTER_WIDTH) - 1);
    n = 32'(word_i >> (POINT_WIDTH - ADVANTAGE_WIDTH)) & ((1 << ADVANTAGE_WIDTH) - 1);
    a = 0;
    b = 0;
    if (RIVAL_MOVES != 0) begin
      qa = pointer << POINTER_SHIFT;
      rival_cell = 32'(word_i >> POINTER_WIDTH) & 127;
    end else begin
      a = 32'(word_i >> POINTER_WIDTH) & ((1 << LABEL_WIDTH) - 1);
      b = 32'(word_i >> (POINTER_WIDTH + LABEL_WIDTH)) & ((1 << LABEL_WIDTH) - 1);
      if (pointer >= (1 << POINTER_WIDTH) / 2) pointer = pointer - (1 << POINTER_WIDTH);
      qa = 512 * cell_of(a) + (pointer << POINTER_SHIFT);
      rival_cell = cell_of(b);
    end
    e = (x - qa) >>> ((n >= ((ADVANTAGE_WIDTH == 7) ? 16 : 12)) ? CELL_SHIFT : 9);
    f = (x >>> 9) - rival_cell;
    expected_reach = valid_i && (e >= -8) && (e <= 7);
    expected_hit = valid_i && (e >= -5) && (e <= 4);
    expected_rival_hit = valid_i && !expected_hit && (f >= -RIVAL_REACH) && (f < RIVAL_REACH);
    away = (e >= 0) ? e : -1 - e;
    case (away)
      0, 7: expected_weight = 1;
      1, 5: expected_weight = 3;
      6: expected_weight = 2;
      default: expected_weight = 4;
    endcase
    if (ADVANTAGE_WIDTH == 7) begin
      step = (n >= 124) ? 1 : (n >= 116) ? 2 : (n >= 100) ? 4 : (n >= 80) ? 8 : (n >= 64) ? 16 : (n >= 32) ? 32
          : (n >= 16) ? 64 : (n >= 8) ? 128 : 256;
    end else begin
      step = (n >= 15) ? 16 : (n >= 14) ? 32 : (n >= 12) ? 64 : (n >= 8) ? 128 : (n >= 4) ? 256 : 512;
    end
  end

  dtof_pixel_distance #(
      .LABELS         (LABELS),
      .SCORES_WIDTH   (SCORES_WIDTH),
      .OFFSET_BITS    (OFFSET_BITS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES),
      .CELL_SHIFT     (CELL_SHIFT),
      .PIXEL_WIDTH    (PIXEL_WIDTH)
  ) u_dut (
      .valid_i      (valid_i),
      .position_i   (position_i),
      .word_i       (word_i),
      .leader_cell_i(7'(cell_of((RIVAL_MOVES == 0 && point_i) ? a : leader))),
      .hits_i       (hits),
      .distance_o   (distance)
  );

  // With a short advantage the gear is in units of the pointer.
  localparam int GEAR_SHIFT = (ADVANTAGE_WIDTH == 4) ? POINTER_SHIFT : 0;

  `ASSUME(m_leader_in_use, point_i || leader < LABELS)
  `ASSUME(m_leader_in_range, point_i || (leader_position >= 0 && leader_position < 65536))
  `ASSUME(m_candidates_in_use, !point_i || (a < LABELS && b < LABELS))
  `PROVE(a_offset_up,
         OFFSET_BITS == 0 || point_i || distance.offset_up == (valid_i && track_cells >= 1 && track_cells <= 7))
  `PROVE(a_offset_down,
         OFFSET_BITS == 0 || point_i || distance.offset_down == (valid_i && track_cells >= -8 && track_cells <= -2))
  `PROVE(a_no_offset, OFFSET_BITS != 0 || (!distance.offset_up && !distance.offset_down))
  `PROVE(a_reach, !point_i || distance.reach == expected_reach)
  `PROVE(a_up, !(point_i && distance.reach) || distance.up == (e >= 0))
  `PROVE(a_weight, !(point_i && distance.reach) || 32'(distance.weight) == expected_weight)
  `PROVE(a_gear, !(point_i && distance.reach) || ((1 << distance.gear) << GEAR_SHIFT) == step)
  `PROVE(a_hit, !point_i || distance.hit == expected_hit)
  `PROVE(a_rival_hit, !point_i || distance.rival_hit == expected_rival_hit)
  `PROVE(a_rival_moves, !(point_i && distance.rival_hit && RIVAL_MOVES != 0)
         || (distance.rival_up == (f > 0) && distance.rival_down == (f < 0)))
  `PROVE(a_nothing, valid_i || distance == '0)
  `GOAL(point_i && distance.rival_hit && distance.reach)

endmodule

`default_nettype wire
