// SPDX-License-Identifier: Apache-2.0
// Fires the laser and starts the TDCs, once for each acquisition of a frame, a pseudo-random time behind the request for it.
//
// 1. A frame that begins asks for its first acquisition. Each later one is asked for when the array has begun the one before.
// 2. A shot is requested when the frame still needs an acquisition, the line buffer has none that the array has not begun, and the
//    source owes none. The source owes one from shot_o to arrives_i; behind abort_i also the rest of the one that it is in.
// 3. The shot waits for (state & (2^bits_i - 1)) * unit_i clocks. Shot and TDC start move together, so no timestamp changes, but
//    light that does not follow the laser falls into another code in each acquisition.
// 4. The state is that of a linear feedback register of 16 bits, x^16 + x^14 + x^13 + x^11 + 1 (maximal length), which makes 16
//    steps for each request. This is the sequence of FiringOffsets in models/dtof/photon/surroundings.hpp. It goes on from frame
//    to frame; reseed_i loads seed_i, and 1 where seed_i is 0, which would stay 0. With bits_i = 0 the state rests.
// 5. give_up_i (the source is dead), abort_i, and a frame that needs no more acquisitions cancel a request that was not fired.
//    After flush_i and give_up_i the source owes no acquisition.
//
// Schedule: a request in clock 0, with its delay of d units: shot_o is high in clock 2 + d * unit_i alone, from a flip-flop.
// Source: firing offsets against other lasers; what they achieve is in reports/hostile_scenes.md (other-laser-offsets).
// Cost: 62 flip-flops and ACQ_WIDTH, 48 two-input XORs for the register's 16 steps, three counters.
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
    // the next frame's, sampled with begin_i
    input  logic [ BITS_WIDTH-1:0] bits_i,          // 0: every delay is 0
    input  logic [ UNIT_WIDTH-1:0] unit_i,          // clocks; 0: likewise
    input  logic [  ACQ_WIDTH-1:0] acquisitions_i,
    input  logic                   begin_i,         // a frame begins
    input  logic                   abort_i,         // the frame ends here
    input  logic                   flush_i,         // the source was stopped
    input  logic                   give_up_i,       // the frame takes no line any more
    // the line buffer's
    input  logic                   arrives_i,       // the first line of an acquisition is accepted
    input  logic                   queued_i,        // an acquisition is there that the array has not begun
    input  logic                   taken_i,         // the array begins an acquisition
    input  logic                   inside_i,        // the source is inside an acquisition
    input  logic                   early_i,         // it is not to be asked for the next one yet
    input  logic                   rest_ends_i,     // the end of an acquisition that is thrown away is accepted
    output logic                   shot_o,          // fires the laser and starts the TDCs, for one clock
    output logic [STATE_WIDTH-1:0] first_state_o    // the state when the last frame began
);

  localparam int UNITS_WIDTH = (1 << BITS_WIDTH) - 1;  // bits of a delay in units

  `DTOF_REQUIRE(g_illegal_bits, BITS_WIDTH >= 1 && BITS_WIDTH <= 4, "dtof_shot_dither: BITS_WIDTH must be 1 to 4")

  // The state, and the one that is 16 steps further.

  // A step shifts to the right and sets bit 15 to bits 0, 2, 3 and 5 (XOR). Of 16 steps the first eleven need the state alone.
  logic [STATE_WIDTH-1:0] state_q, first_state_q, seed, further;
  logic [10:0] first_bits;
  logic [4:0] last_bits;

  assign first_bits = state_q[10:0] ^ state_q[12:2] ^ state_q[13:3] ^ state_q[15:5];
  assign last_bits = state_q[15:11] ^ {first_bits[1:0], state_q[15:13]} ^ {first_bits[2:0], state_q[15:14]} ^ first_bits[4:0];
  assign further = {last_bits, first_bits};
  assign seed = (seed_i == '0) ? STATE_WIDTH'(1) : seed_i;

  // The frame's need, and what is on its way.

  logic [ACQ_WIDTH-1:0] left_q;  // acquisitions that the array has not begun
  logic owed_q;                  // a shot was fired, its acquisition has not arrived
  logic rest_q;                  // the source is inside an acquisition that an abort has ended
  logic waits_q;                 // a shot was requested and has not been fired
  logic shot_q;
  logic [BITS_WIDTH-1:0] bits_q;
  logic [UNIT_WIDTH-1:0] unit_q, clock_q;
  logic [UNITS_WIDTH-1:0] units_q, drawn;  // of the delay that is left
  logic ends, wanted, request, fires;

  assign ends = abort_i || flush_i || give_up_i;
  assign wanted = (left_q != '0) && !queued_i && !owed_q && !rest_q && !early_i && !arrives_i && !begin_i && !ends;
  assign request = wanted && !waits_q;
  assign fires = wanted && waits_q && (units_q == '0);
  assign drawn = (unit_q == '0) ? '0 : state_q[UNITS_WIDTH-1:0] & ~({UNITS_WIDTH{1'b1}} << bits_q);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q <= STATE_WIDTH'(1);
      first_state_q <= STATE_WIDTH'(1);
      left_q <= '0;
      owed_q <= 1'b0;
      rest_q <= 1'b0;
      waits_q <= 1'b0;
      shot_q <= 1'b0;
      bits_q <= '0;
      unit_q <= '0;
      clock_q <= '0;
      units_q <= '0;
    end else begin
      if (reseed_i) begin
        state_q <= seed;
      end else if (request && bits_q != '0) begin
        state_q <= further;
      end
      if (begin_i) begin
        first_state_q <= reseed_i ? seed : state_q;
        bits_q <= bits_i;
        unit_q <= unit_i;
      end
      if (abort_i || give_up_i) begin
        left_q <= '0;
      end else if (begin_i) begin
        left_q <= acquisitions_i;
      end else if (taken_i && left_q != '0) begin
        left_q <= left_q - 1'b1;
      end
      waits_q <= wanted && !fires;
      if (request) begin
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

  // taken_i comes only where queued_i was high, so that the need cannot end between decision and shot.
  `DTOF_ASSERT(a_needed, !shot_q || left_q != '0, "a shot is fired for an acquisition that the frame does not need")

endmodule

`default_nettype wire
