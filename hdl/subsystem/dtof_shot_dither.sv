// SPDX-License-Identifier: Apache-2.0
// Fires the laser and starts the TDCs, once for each acquisition of a frame, a pseudo-random time after the request for it.
//
// 1. A frame that begins requests its first acquisition. Each later acquisition is requested when the array has begun the one before.
// 2. A shot is requested if the frame still needs an acquisition, the line buffer has no acquisition that the array has not begun, and
//    no acquisition is outstanding. An acquisition is outstanding from shot_o to arrives_i; after abort_i the rest of the acquisition that
//    the source is delivering is outstanding, too.
// 3. The shot is delayed by (state & (2^bits_i - 1)) * unit_i clocks. Shot and TDC start move together, so no timestamp changes, but
//    light that does not follow the laser falls into another code in each acquisition.
// 4. The state is that of a linear feedback register of 16 bits, x^16 + x^14 + x^13 + x^11 + 1 (maximal length), which makes 16
//    steps per request. This is the sequence of FiringOffsets in models/dtof/photon/surroundings.hpp. It continues from frame
//    to frame. reseed_i loads seed_i, or 1 instead of 0, because the register cannot leave 0. With bits_i = 0 the state holds.
// 5. give_up_i (the source is dead), abort_i, and a frame that needs no more acquisitions cancel a request that has not fired.
//    After flush_i and give_up_i no acquisition is outstanding.
//
// Schedule: for a request in clock 0 with a delay of d units, shot_o is high in clock 2 + d * unit_i only, from a flip-flop.
// Latency: 2 clocks without a delay.
// Source: firing offsets against other lasers; what they achieve is in reports/hostile_scenes.md (other-laser-offsets).
// Cost: 65 flip-flops and ACQ_WIDTH, 48 two-input XORs for the register's 16 steps, three counters.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_shot_dither #(
    parameter int ACQ_WIDTH = 16,
    parameter int BITS_WIDTH = 3,  // bits of bits_i
    parameter int UNIT_WIDTH = 8,  // bits of unit_i
    localparam int STATE_WIDTH = 16
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   reseed_i,
    input  logic [STATE_WIDTH-1:0] seed_i,
    // of the next frame, sampled with begin_i
    input  logic [ BITS_WIDTH-1:0] bits_i,          // 0: every delay is 0
    input  logic [ UNIT_WIDTH-1:0] unit_i,          // clocks of a unit; 0: every delay is 0
    input  logic [  ACQ_WIDTH-1:0] acquisitions_i,
    input  logic                   begin_i,         // a frame begins
    input  logic                   abort_i,         // the frame ends now
    input  logic                   flush_i,         // the source was stopped
    input  logic                   give_up_i,       // the frame takes no more lines
    // from the line buffer
    input  logic                   arrives_i,       // the first line of an acquisition is accepted
    input  logic                   queued_i,        // an acquisition has begun to arrive, and the array has not begun it
    input  logic                   taken_i,         // the array begins an acquisition
    input  logic                   inside_i,        // the source is inside an acquisition
    input  logic                   early_i,         // do not request the next acquisition yet
    input  logic                   rest_ends_i,     // the last line of an ignored rest is accepted
    output logic                   shot_o,          // fires the laser and starts the TDCs, for one clock
    output logic [STATE_WIDTH-1:0] first_state_o    // the state at the begin of the last frame
);

  localparam int UNITS_WIDTH = (1 << BITS_WIDTH) - 1;  // bits of a delay, in units

  `DTOF_REQUIRE(g_illegal_bits, BITS_WIDTH >= 1 && BITS_WIDTH <= 4, "dtof_shot_dither: BITS_WIDTH must be 1 to 4")

  // The state, and the state 16 steps later.

  // A step shifts right and sets bit 15 to the XOR of bits 0, 2, 3 and 5. The first eleven of 16 steps depend on the present state alone.
  logic [STATE_WIDTH-1:0] state_q, first_state_q, seed, further;
  logic [10:0] first_bits;
  logic [4:0] last_bits;

  assign first_bits = state_q[10:0] ^ state_q[12:2] ^ state_q[13:3] ^ state_q[15:5];
  assign last_bits = state_q[15:11] ^ {first_bits[1:0], state_q[15:13]} ^ {first_bits[2:0], state_q[15:14]} ^ first_bits[4:0];
  assign further = {last_bits, first_bits};
  assign seed = (seed_i == '0) ? STATE_WIDTH'(1) : seed_i;

  // Needed acquisitions, and outstanding ones. Requests, taken_i and give_up_i come late in their clock. So registers with many bits follow a clock
  // later: the delay is loaded in every clock without a request, the state makes its steps in the clock after the request, and left_q changes in the
  // clock after taken_i.

  logic [ACQ_WIDTH-1:0] left_q;  // acquisitions that the array has not begun, and the one that it began in the last clock
  logic took_q;                  // the array began an acquisition in the last clock
  logic ended_q;                 // the frame's need ended in the last clock
  logic owed_q;                  // a shot was fired, and its acquisition has not arrived
  logic rest_q;                  // the source is delivering the rest of an acquisition that an abort has ended
  logic waits_q;                 // a shot was requested and has not fired
  logic drawn_q;                 // the state makes its steps: a shot was requested in the last clock
  logic shot_q;
  logic [BITS_WIDTH-1:0] bits_q;
  logic [UNIT_WIDTH-1:0] unit_q, clock_q;
  logic [UNITS_WIDTH-1:0] units_q, drawn;  // units_q: units left of the delay
  logic ends, left, wanted, request, fires;

  assign ends = abort_i || flush_i || give_up_i;
  assign left = (left_q != ACQ_WIDTH'(took_q)) && !ended_q;
  assign wanted = left && !queued_i && !owed_q && !rest_q && !early_i && !arrives_i && !begin_i && !ends;
  assign request = wanted && !waits_q;
  assign fires = wanted && waits_q && (units_q == '0);
  assign drawn = (unit_q == '0) ? '0 : state_q[UNITS_WIDTH-1:0] & ~({UNITS_WIDTH{1'b1}} << bits_q);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q <= STATE_WIDTH'(1);
      first_state_q <= STATE_WIDTH'(1);
      left_q <= '0;
      took_q <= 1'b0;
      ended_q <= 1'b0;
      owed_q <= 1'b0;
      rest_q <= 1'b0;
      waits_q <= 1'b0;
      drawn_q <= 1'b0;
      shot_q <= 1'b0;
      bits_q <= '0;
      unit_q <= '0;
      clock_q <= '0;
      units_q <= '0;
    end else begin
      if (reseed_i) begin
        state_q <= seed;
      end else if (drawn_q && bits_q != '0) begin
        state_q <= further;
      end
      if (begin_i) begin
        first_state_q <= reseed_i ? seed : state_q;
        bits_q <= bits_i;
        unit_q <= unit_i;
      end
      took_q <= taken_i && left && !begin_i;
      ended_q <= abort_i || give_up_i;
      if (begin_i) begin
        left_q <= acquisitions_i;
      end else if (ended_q) begin
        left_q <= '0;
      end else if (took_q) begin
        left_q <= left_q - 1'b1;
      end
      waits_q <= wanted && !fires;
      drawn_q <= request && !reseed_i;
      if (!waits_q) begin
        units_q <= drawn;
        clock_q <= unit_q - 1'b1;
      end else if (clock_q != '0) begin
        clock_q <= clock_q - 1'b1;
      end else if (units_q != '0) begin
        units_q <= units_q - 1'b1;
        clock_q <= unit_q - 1'b1;
      end
      shot_q <= fires;
      owed_q <= (fires || (owed_q && !arrives_i)) && !flush_i && !give_up_i;
      rest_q <= ((abort_i && inside_i) || (rest_q && !rest_ends_i)) && !flush_i && !give_up_i;
    end
  end

  assign shot_o = shot_q;
  assign first_state_o = first_state_q;

  // taken_i comes only while queued_i is high, so the need cannot end between the decision and the shot.
  `DTOF_ASSERT(a_needed, !shot_q || left_q != ACQ_WIDTH'(took_q), "a shot is fired for an acquisition that the frame does not need")

endmodule

`default_nettype wire
