// SPDX-License-Identifier: Apache-2.0
// poolPointer, point: next pointer word of a pixel after one timestamp: pointers of leader and rival, advantage. Combinational.
//
// Equation (docs/reference/poolpointer.md, Point): if the timestamp is in reach, the pointer moves towards it by
// (2^gear weight + dither) >> 2 units of 2^-11 coarse bin, rounded down to the pointer's unit u = 2^POINTER_SHIFT;
// dither = (a mod 4) u + (a >> 2) mod u, with a the number of the acquisition. A hit of the leader raises the advantage n. A hit of
// the rival lowers n; at n = 0 leader and rival change roles instead. A thinned timestamp neither raises nor lowers n.
// RIVAL_MOVES = 1: both pointers are absolute, and the rival's pointer follows its hits in cells, quarters of a coarse bin.
// RIVAL_MOVES = 0: the pointer is relative to candidate a, the rival is candidate b.
// changed_o is also high for a move that saturates.
// Latency: none. Cost: an adder of the pointer's width, a shifter; about 25 gate delays.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_twin_pointer_update #(
    parameter int LABELS = 5,
    parameter int ADVANTAGE_WIDTH = 7,  // 7, or 4 (gears whose moves are multiples of u)
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    localparam int POINTER_WIDTH = dtof_pkg::pool_pointer_width(POINTER_SHIFT, RIVAL_MOVES),
    localparam int POINT_WIDTH = dtof_pkg::pool_point_width(LABELS, ADVANTAGE_WIDTH, POINTER_SHIFT, RIVAL_MOVES)
) (
    input  logic                   update_i,
    input  logic [POINT_WIDTH-1:0] word_i,         // {advantage, rival, pointer}
    input  logic                   reach_i,
    input  logic                   up_i,
    input  logic [            2:0] weight_i,
    input  logic [            3:0] gear_i,
    input  logic                   hit_i,
    input  logic                   rival_hit_i,
    input  logic                   rival_up_i,
    input  logic                   rival_down_i,
    input  logic                   thinned_i,      // the timestamp moves the pointers, but n does not count it
    input  logic [            3:0] acquisition_i,  // number of the acquisition, mod 16
    output logic                   changed_o,      // low: word_o equals the word; also low without update_i
    output logic [POINT_WIDTH-1:0] word_o          // 0 without update_i
);

  // Bits of a move below the pointer's unit; with the dither they decide whether the move is rounded up.
  localparam int BELOW_UNIT = (ADVANTAGE_WIDTH == 4) ? 0 : POINTER_SHIFT;
  localparam int MOVE_WIDTH = ((ADVANTAGE_WIDTH == 4) ? 10 : 9) - POINTER_SHIFT;
  localparam int DITHER_WIDTH = BELOW_UNIT + 2;
  localparam int PRODUCT_WIDTH = MOVE_WIDTH + DITHER_WIDTH;

  localparam int RIVAL_WIDTH = dtof_pkg::POOL_RIVAL_WIDTH;
  localparam int LABEL_WIDTH = dtof_pkg::index_width(LABELS);
  localparam int SUM_WIDTH = dtof_pkg::max_of(POINTER_WIDTH, MOVE_WIDTH + 2) + 1;
  localparam logic signed [SUM_WIDTH-1:0] HIGHEST = SUM_WIDTH'((1 << (POINTER_WIDTH - 1)) - 1);

  localparam logic [ADVANTAGE_WIDTH-1:0] HALF_ADVANTAGE = ADVANTAGE_WIDTH'(1 << (ADVANTAGE_WIDTH - 1));

  // Placed below the pointer's lowest bit, so that one adder adds the dither and rounds down; for a move down the dither is inverted.
  logic [DITHER_WIDTH-1:0] dither;
  generate
    if (BELOW_UNIT == 0) begin : g_dither
      assign dither = acquisition_i[1:0];
    end else begin : g_long_dither
      assign dither = {acquisition_i[1:0], acquisition_i[2+:BELOW_UNIT]};
    end
  endgenerate

  logic [ADVANTAGE_WIDTH-1:0] advantage, next_advantage;
  logic [POINTER_WIDTH-1:0] pointer, moved, swapped, limited, next_pointer;
  logic [PRODUCT_WIDTH-1:0] product;
  logic counted, swap, gain, loss, rival_moves;
  logic [PRODUCT_WIDTH:0] units;
  logic [RIVAL_WIDTH-1:0] rival, rival_step, next_rival;
  logic [POINTER_WIDTH+DITHER_WIDTH:0] absolute_sum;
  logic [LABEL_WIDTH-1:0] leader_label, rival_label;
  logic [SUM_WIDTH+DITHER_WIDTH-1:0] start, step, fine_sum;
  logic signed [SUM_WIDTH-1:0] sum;

  logic fourth, sixteenth;  // every 4th acquisition, every 16th
  assign fourth = (acquisition_i[1:0] == 2'd0);
  assign sixteenth = (acquisition_i == 4'd0);

  // Inside if (update_i), so that a simulator evaluates it for updates only; the defaults avoid latches.
  always_comb begin
    word_o = '0;
    changed_o = 1'b0;
    rival_moves = 1'b0;
    units = '0;
    advantage = '0;
    next_advantage = '0;
    pointer = '0;
    moved = '0;
    swapped = '0;
    limited = '0;
    next_pointer = '0;
    product = '0;
    counted = 1'b0;
    swap = 1'b0;
    gain = 1'b0;
    loss = 1'b0;
    rival = '0;
    rival_step = '0;
    next_rival = '0;
    absolute_sum = '0;
    leader_label = '0;
    rival_label = '0;
    start = '0;
    step = '0;
    fine_sum = '0;
    sum = '0;
    if (update_i) begin
      pointer = POINTER_WIDTH'(word_i);
      advantage = ADVANTAGE_WIDTH'(word_i >> (POINT_WIDTH - ADVANTAGE_WIDTH));

      product = PRODUCT_WIDTH'(weight_i) << gear_i;

      // In the upper half of the range only every 4th, then every 16th acquisition counts.
      counted = !thinned_i && (advantage < HALF_ADVANTAGE
          || (fourth && (advantage < HALF_ADVANTAGE + HALF_ADVANTAGE / 2 || sixteenth)));
      swap = rival_hit_i && (advantage == '0);

      // Step of n: 1, 0 or -1. A change of roles happens at n = 0 and sets n to 1. Leader and rival are never hit together.
      gain = (hit_i && counted && (advantage != '1)) || swap;
      loss = rival_hit_i && counted && !swap;
      rival_moves = (RIVAL_MOVES != 0) && rival_hit_i && (rival_up_i || rival_down_i);
      units = ({1'b0, product} + (PRODUCT_WIDTH + 1)'(dither)) >> DITHER_WIDTH;
      changed_o = gain || loss || rival_moves || (reach_i && units != '0);
      next_advantage = advantage + {{(ADVANTAGE_WIDTH - 1) {loss}}, gain || loss};

      if (RIVAL_MOVES != 0) begin
        rival = RIVAL_WIDTH'(word_i >> POINTER_WIDTH);
        // Saturates at both ends of the range.
        absolute_sum = {1'b0, pointer, dither ^ {DITHER_WIDTH{!up_i}}}
            + ((POINTER_WIDTH + DITHER_WIDTH + 1)'(product) ^ {(POINTER_WIDTH + DITHER_WIDTH + 1) {!up_i}})
            + (POINTER_WIDTH + DITHER_WIDTH + 1)'(!up_i);
        moved = 1'(absolute_sum >> (POINTER_WIDTH + DITHER_WIDTH)) ? {POINTER_WIDTH{up_i}}
            : POINTER_WIDTH'(absolute_sum >> DITHER_WIDTH);
        swapped = POINTER_WIDTH'({rival, 1'b1}) << (POINTER_WIDTH - 1 - RIVAL_WIDTH);
        next_pointer = swap ? swapped : (reach_i ? moved : pointer);
        rival_step = {{(RIVAL_WIDTH - 1) {rival_hit_i && rival_down_i}}, rival_moves};  // 1, 0, -1
        next_rival = swap ? RIVAL_WIDTH'(pointer >> (POINTER_WIDTH - RIVAL_WIDTH)) : rival + rival_step;
        word_o = POINT_WIDTH'({next_advantage, next_rival, next_pointer});
      end else begin
        leader_label = LABEL_WIDTH'(word_i >> POINTER_WIDTH);
        rival_label = LABEL_WIDTH'(word_i >> (POINTER_WIDTH + LABEL_WIDTH));
        start = {{(SUM_WIDTH - POINTER_WIDTH) {1'(pointer >> (POINTER_WIDTH - 1))}}, pointer, dither ^ {DITHER_WIDTH{!up_i}}};
        step = (SUM_WIDTH + DITHER_WIDTH)'(product) ^ {(SUM_WIDTH + DITHER_WIDTH) {!up_i}};
        fine_sum = start + step + (SUM_WIDTH + DITHER_WIDTH)'(!up_i);
        sum = $signed(SUM_WIDTH'(fine_sum >> DITHER_WIDTH));
        limited = (sum > HIGHEST) ? POINTER_WIDTH'(HIGHEST)
            : (sum < ~HIGHEST) ? POINTER_WIDTH'(~HIGHEST) : POINTER_WIDTH'(sum);
        next_pointer = swap ? '0 : (reach_i ? limited : pointer);
        word_o = POINT_WIDTH'({next_advantage, swap ? leader_label : rival_label, swap ? rival_label : leader_label,
                               next_pointer});
      end
    end
  end

endmodule

`default_nettype wire
