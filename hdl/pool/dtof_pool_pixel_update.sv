// SPDX-License-Identifier: Apache-2.0
// poolPointer, track and point: next word of a pixel after one timestamp, for the columns of a pair one after the other.
//
// Equations: docs/reference/poolpointer.md, Track, Point.
//   clock
//   0       distance of the timestamp (dtof_pixel_distance), score of the leader; registered
//   1       next word, combinational
// Without a timestamp all registers hold, so that the logic behind them does not switch.
// Latency: 1 clock; a new pixel may come in every clock. Cost at the defaults: see reports/area.md.

`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_pixel_update `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int NP = 10,
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    parameter int CELL_SHIFT = 9,
    localparam int TRACK_WIDTH = dtof_pkg::pool_track_width(LABELS, SCORE_BITS, OFFSET_BITS),
    localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES),
    localparam int PIXEL_WIDTH = dtof_pkg::max_of(TRACK_WIDTH, POINT_WIDTH),
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH,
    localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS)
) (
    input  logic                   clk_i,
    input  logic                   track_i,        // track phase
    input  logic                   point_i,        // pointer phase
    // clock 0
    input  logic                   valid_i,        // the pixel has a timestamp
    input  logic [         NP-1:0] timestamp_i,    // timestamp that the pixel uses
    input  logic [     LABELS-1:0] hits_i,         // candidates that the timestamp hits
    input  logic                   thinned_i,      // the timestamp counts for no label
    input  logic [ CELL_WIDTH-1:0] leader_cell_i,  // cell of the candidate that the word refers to as leader
    input  logic [PIXEL_WIDTH-1:0] word_i,
    // clock 1
    input  logic [            3:0] acquisition_i,  // number of the acquisition, mod 16
    output logic                   changed_o,      // word_o differs from the pixel's word; low outside both phases
    output logic [PIXEL_WIDTH-1:0] word_o          // next word of the last pixel with a timestamp; 0 outside both phases
);

  logic [15:0] position;

  generate
    if (NP == 16) begin : g_position
      assign position = timestamp_i;
    end else begin : g_middle_of_bin
      // Middle of the timestamp's bin: a 1, then zeros.
      assign position = {timestamp_i, 1'b1, {(15 - NP) {1'b0}}};
    end
  endgenerate

  `DTOF_TYPE(dtof_pool_pkg, pixel_distance_t) distance, distance_q;
  logic [LABELS-1:0] hits_q;
  logic [SCORE_BITS-1:0] leader_score, leader_score_q;
  logic [PIXEL_WIDTH-1:0] word_q;
  logic thinned_q;

  dtof_pixel_distance #(
      .LABELS         (LABELS),
      .SCORES_WIDTH   (LABELS * SCORE_BITS),
      .OFFSET_BITS    (OFFSET_BITS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES),
      .CELL_SHIFT     (CELL_SHIFT),
      .PIXEL_WIDTH    (PIXEL_WIDTH)
  ) u_pixel_distance (
      .valid_i      (valid_i),
      .position_i   (position),
      .word_i       (word_i),
      .leader_cell_i(leader_cell_i),
      .hits_i       (hits_i),
      .distance_o   (distance)
  );

  generate
    if (OFFSET_BITS == 0) begin : g_no_leader
      assign leader_score = '0;
    end else begin : g_leader
      logic [LABEL_WIDTH-1:0] leader;
      integer k;
      assign leader = word_i[LABELS*SCORE_BITS+:LABEL_WIDTH];
      always_comb begin
        leader_score = '0;
        for (k = 0; k < LABELS; k = k + 1) begin
          leader_score = leader_score | (SCORE_BITS'(word_i >> (k * SCORE_BITS)) & {SCORE_BITS{leader == LABEL_WIDTH'(k)}});
        end
      end
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    if (valid_i) begin
      distance_q <= distance;
      leader_score_q <= leader_score;
      hits_q <= hits_i & {LABELS{!thinned_i}};
      thinned_q <= thinned_i;
      word_q <= word_i;
    end
  end

  // Next word.

  logic [TRACK_WIDTH-1:0] tracked;
  logic [POINT_WIDTH-1:0] pointed;
  logic track_changes, point_changes;

  dtof_pool_track_update #(
      .LABELS     (LABELS),
      .SCORE_BITS (SCORE_BITS),
      .OFFSET_BITS(OFFSET_BITS)
  ) u_track_update (
      .word_i        (word_q[TRACK_WIDTH-1:0]),
      .leader_score_i(leader_score_q),
      .hits_i        (hits_q),
      .offset_up_i   (distance_q.offset_up && !thinned_q),
      .offset_down_i (distance_q.offset_down && !thinned_q),
      .changed_o     (track_changes),
      .word_o        (tracked)
  );

  dtof_twin_pointer_update #(
      .LABELS         (LABELS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES)
  ) u_pointer_update (
      .update_i     (point_i),
      .word_i       (word_q[POINT_WIDTH-1:0]),
      .reach_i      (distance_q.reach),
      .up_i         (distance_q.up),
      .weight_i     (distance_q.weight),
      .gear_i       (distance_q.gear),
      .hit_i        (distance_q.hit),
      .rival_hit_i  (distance_q.rival_hit),
      .rival_up_i   (distance_q.rival_up),
      .rival_down_i (distance_q.rival_down),
      .thinned_i    (thinned_q),
      .acquisition_i(acquisition_i),
      .changed_o    (point_changes),
      .word_o       (pointed)
  );

  assign changed_o = (track_i && track_changes) || (point_i && point_changes);

  assign word_o = (PIXEL_WIDTH'(tracked) & {PIXEL_WIDTH{track_i}}) | (PIXEL_WIDTH'(pointed) & {PIXEL_WIDTH{point_i}});

endmodule

`default_nettype wire
