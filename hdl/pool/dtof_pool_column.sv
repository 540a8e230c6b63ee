// SPDX-License-Identifier: Apache-2.0
// poolPointer: the part of a column that its pair does not share: the input of timestamps, and which timestamp of a pixel is used.
// dtof_pool_pixel_update then computes the pixel's next word, for both columns of a pair one after the other. An engine, shared by
// several columns, does what needs several pixels at once (decode, choose, decide: dtof_pool_engine).
//
// Equations: docs/reference/poolpointer.md, Timestamps, Coarse, Track, Point.
//
// A pixel uses one of the first two timestamps of its slots. The preferred timestamp is the second in odd acquisitions if there are
// two, otherwise the first. T1 and T2 are clocks after T0, in which the pixel's last slot is at the port:
//   clock   coarse                          track and point
//   T1                                      point: which of the two timestamps are inside; track, and point without RIVAL_MOVES:
//                                           which candidates the first timestamp hits
//   T2      one of two pixels is chosen     the timestamp that is used; track: which candidates the second timestamp (or the only
//                                           one) hits, and which of the two timestamps scores
// Latency: the stage of an output is in its name. Cost at the defaults: see reports/area.md.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_column #(
    parameter int NP = 10,
    parameter int SLOTS = 2,
    parameter int LABELS = 5,
    parameter int RIVAL_MOVES = 1,
    parameter int TIME_GATE = 0,
    parameter int BROADCAST_STAGES = 2,  // clocks from the array's control to the column; timestamps are delayed as much
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH,
    localparam int CELLS_WIDTH = LABELS * CELL_WIDTH,
    localparam int COARSE_WIDTH = $clog2(dtof_pkg::POOL_COARSE_BINS)
) (
    input  logic                    clk_i,
    input  logic [          NP-1:0] timestamp_i,
    input  logic [          NP-1:0] gate_begin_i,
    input  logic [          NP-1:0] gate_end_i,
    input  logic                    point_i,           // pointer phase
    input  logic                    leans_i,           // this phase uses candidates
    // stream of timestamps
    input  logic                    beat_t1_i,         // the pixel's slot is at T1, with or without a detection
    input  logic                    first_slot_t1_i,
    input  logic                    last_slot_t1_i,
    input  logic                    odd_t1_i,          // odd acquisition
    input  logic                    first_row_t2_i,    // coarse: the pair's first pixel is complete
    input  logic                    second_row_t2_i,   // coarse: the pair's second pixel is complete
    // pixel at T1 or T2
    input  logic [ CELLS_WIDTH-1:0] cells_i,           // candidates of the group of the pixel at T1 and T2
    input  logic [  CELL_WIDTH-1:0] pointer_cell_t1_i, // with compares_t1_o: the cell of the pointer of the pixel at T1
    output logic                    compares_t1_o,     // high when the pixel has two timestamps, so that one may be inside; also in some other clocks
    output logic                    detected_t1_o,     // the pixel will have a timestamp at T2
    output logic                    may_have_t1_o,     // early form of detected_t1_o, also high in other clocks
    // a detection is in one of the two slots that are now at T1 and T0 (bit 0), at T0 and one clock before (bit 1); SLOTS = 2
    output logic [             1:0] comes_o,
    output logic                    detected_t2_o,     // the pixel has a timestamp
    output logic [          NP-1:0] used_t2_o,         // timestamp that the pixel uses
    output logic [      LABELS-1:0] hits_t2_o,         // candidates that the timestamp hits; 0 without a timestamp
    // coarse bin of the timestamp used, registered: first of the first pixel, then of the pixel chosen from the two
    output logic                    held_valid_o,
    output logic [COARSE_WIDTH-1:0] held_bin_o,
    output logic                    upper_t2_o         // coarse: the bin chosen from the two pixels is in the upper half of all bins
);

  localparam int TRACK_REACH = 4;
  localparam int POINT_REACH = 8;

  // The first two timestamps of a pixel, complete at T1.

  logic [NP-1:0] timestamp_t1, first_q, second, second_q;
  logic [CELL_WIDTH-1:0] first_cell;
  logic [BROADCAST_STAGES:0] comes;
  logic [BROADCAST_STAGES-1:0] comes_q;
  logic valid_t1, has_first, has_first_q, has_second, has_second_q, unused_detected, detected_t1;

  dtof_timestamp_input #(
      .NP       (NP),
      .TIME_GATE(TIME_GATE),
      .STAGES   (BROADCAST_STAGES)
  ) u_timestamp_input (
      .clk_i         (clk_i),
      .timestamp_i   (timestamp_i),
      .gate_begin_i  (gate_begin_i),
      .gate_end_i    (gate_end_i),
      .detected_t0_o (unused_detected),
      .detected_t1_o (detected_t1),
      .timestamp_t1_o(timestamp_t1)
  );

  assign valid_t1 = beat_t1_i && detected_t1;

  // Detections before the gate; bit s: s clocks after the port. dtof_timestamp_input has the same registers; synthesis merges them.
  assign comes = {comes_q, timestamp_i != '1};
  always_ff @(posedge clk_i) begin
    comes_q <= comes[BROADCAST_STAGES-1:0];
  end
  assign comes_o = {comes[BROADCAST_STAGES:BROADCAST_STAGES-1] != '0, detected_t1 || comes[BROADCAST_STAGES]};
  assign has_first = valid_t1 || (has_first_q && !first_slot_t1_i);
  assign first_cell = (first_slot_t1_i || !has_first_q) ? timestamp_t1[NP-1-:CELL_WIDTH] : first_q[NP-1-:CELL_WIDTH];

  always_ff @(posedge clk_i) begin
    has_first_q <= has_first;
    has_second_q <= has_second;
    if (valid_t1 && (first_slot_t1_i || !has_first_q)) begin
      first_q <= timestamp_t1;
    end
    if (has_second) begin
      second_q <= second;
    end
  end

  generate
    if (SLOTS == 2) begin : g_two_slots
      assign second = timestamp_t1;
      assign has_second = !first_slot_t1_i && has_first_q && valid_t1;
    end else begin : g_more_slots
      assign second = has_second_q ? second_q : timestamp_t1;
      assign has_second = !first_slot_t1_i && (has_second_q || (has_first_q && valid_t1));
    end
  endgenerate

  // Which timestamp the pixel uses, at T2: the preferred one; in the pointer phase the other one if only that one is inside.

  // first_inside and second_inside arrive late, so they are registered, and the choice follows at T2.
  logic first_inside, second_inside, first_inside_q, second_inside_q, odd_q, point_q, prefers_second, use_second;
  genvar n;
  logic [LABELS-1:0] hits;

  generate
    if (RIVAL_MOVES != 0) begin : g_near_pointer
      // Inside: the timestamp's cell is POINT_REACH below to POINT_REACH - 1 above the pointer's cell. The pointer's cell arrives late,
      // from the SRAM. Therefore all terms that depend on the timestamp alone are ready before, and a tree compares the low bits. The first
      // of two timestamps is registered.
      logic [2*CELL_WIDTH-1:0] cells;
      logic [1:0] is_inside;
      assign cells = {second[NP-1-:CELL_WIDTH], first_q[NP-1-:CELL_WIDTH]};
      assign {second_inside, first_inside} = is_inside;
      for (n = 0; n < 2; n = n + 1) begin : g_timestamp
        logic [CELL_WIDTH:0] top;
        logic [CELL_WIDTH-4:0] same, one_less, pointer_high;
        logic [3:0] above, not_below;
        logic is_above;
        assign top = {1'b0, cells[n*CELL_WIDTH+:CELL_WIDTH]} + (CELL_WIDTH + 1)'(POINT_REACH);
        assign same = top[CELL_WIDTH:4];
        assign one_less = same - 1'b1;
        assign pointer_high = {1'b0, pointer_cell_t1_i[CELL_WIDTH-1:4]};
        assign above = pointer_cell_t1_i[3:0] & ~top[3:0];
        assign not_below = pointer_cell_t1_i[3:0] | ~top[3:0];
        assign is_above = above[3] || (not_below[3] && above[2])
            || (not_below[3] && not_below[2] && (above[1] || (not_below[1] && above[0])));
        // The pointer's high part must be `same` or `one_less`; the lowest bit tells which. is_above tells which one is inside.
        assign is_inside[n] = (same == pointer_high || one_less == pointer_high) && ((same[0] ^ pointer_high[0]) == is_above);
      end
    end else begin : g_near_candidates
      assign first_inside = |hits;
      assign second_inside = 1'b1;
      logic unused_cell;
      assign unused_cell = ^pointer_cell_t1_i;
    end
  endgenerate

  // From the column's registers only, so that the pointer's cell comes early; also high in some other clocks.
  assign compares_t1_o = (RIVAL_MOVES != 0) && ((has_first_q && detected_t1) || (SLOTS > 2 && has_second_q));
  // Outside the pointer phase the preferred timestamp is used.
  assign prefers_second = has_second_q && odd_q;
  assign use_second = point_q ? has_second_q && (odd_q ? second_inside_q || !first_inside_q : second_inside_q && !first_inside_q)
                      : prefers_second;
  assign used_t2_o = use_second ? second_q : first_q;

  always_ff @(posedge clk_i) begin
    odd_q <= odd_t1_i;
    point_q <= point_i;
    first_inside_q <= first_inside;
    second_inside_q <= second_inside;
  end

  // Coarse: from two pixels one is chosen: the first in even acquisitions, the second in odd acquisitions, or the other pixel if
  // this pixel has no timestamp.

  logic held_valid_q, second_row_counts, preferred_upper;
  logic [COARSE_WIDTH-1:0] held_bin_q, bin;

  assign detected_t1_o = has_first;
  assign may_have_t1_o = detected_t1 || has_first_q;
  assign detected_t2_o = has_first_q;
  assign bin = used_t2_o[NP-1-:COARSE_WIDTH];
  // The SRAM's read enable depends on upper_t2_o, which therefore takes the short way.
  assign preferred_upper = prefers_second ? second_q[NP-1] : first_q[NP-1];

  // The second pixel replaces the first if the first has no timestamp, or in odd acquisitions.
  assign second_row_counts = has_first_q && (odd_q || !held_valid_q);
  assign upper_t2_o = second_row_counts ? preferred_upper : (held_valid_q && held_bin_q[COARSE_WIDTH-1]);

  always_ff @(posedge clk_i) begin
    if (first_row_t2_i || (second_row_t2_i && second_row_counts)) begin
      held_valid_q <= has_first_q;
      held_bin_q <= bin;
    end
  end

  assign held_valid_o = held_valid_q;
  assign held_bin_o = held_bin_q;

  // Track: candidates that the timestamps hit: of the first timestamp at T1, of the second (or only) timestamp at T2. The score uses
  // the other timestamp if only that one hits; the leader's offset follows the preferred timestamp.

  logic [LABELS-1:0] first_hits_q;
  logic [CELL_WIDTH-1:0] matched_q;
  logic track_second, hits_of_second;

  dtof_label_match #(
      .LABELS(LABELS),
      .WINDOW(TRACK_REACH)
  ) u_label_match (
      .valid_i(has_first_q),
      .cell_i (matched_q),
      .cells_i(cells_i),
      .hits_o (hits)
  );

  assign track_second = odd_q ? (hits != '0) || (first_hits_q == '0) : (hits != '0) && (first_hits_q == '0);
  assign hits_of_second = (RIVAL_MOVES == 0 && point_q) ? use_second : track_second;
  assign hits_t2_o = (has_second_q && !hits_of_second) ? first_hits_q : hits;

  always_ff @(posedge clk_i) begin
    // Holds in phases without candidates and without a timestamp, so that the logic behind it does not switch.
    if (leans_i && (valid_t1 || (SLOTS > 2 && last_slot_t1_i && has_second))) begin
      matched_q <= (last_slot_t1_i && has_second) ? second[NP-1-:CELL_WIDTH] : first_cell;
    end
    if (has_second) begin
      first_hits_q <= hits;
    end
  end

endmodule

`default_nettype wire
