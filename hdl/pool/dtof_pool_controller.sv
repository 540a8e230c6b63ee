// SPDX-License-Identifier: Apache-2.0
// poolPointer: state machine of a frame and counter of acquisitions, once per array.
//
// IDLE -> RESET -> COARSE -> DECODE -> RESET -> TRACK -> CHOOSE -> POINT -> DECIDE -> IDLE
//   RESET clears the pixels' words, and before COARSE those of the groups, too, if FIRST_CLEAR_WORDS includes them: one address per clock.
//   COARSE, TRACK and POINT take timestamps. In DECODE, CHOOSE and DECIDE
//   the engines work; in DECIDE they also send the results.
// A stream phase takes acquisitions up to its end in the schedule (docs/reference/poolpointer.md, Parameters): coarse_end_i, track_end_i,
// acq_num_i. All three are sampled with start_i in IDLE; start_i while busy is ignored. done_o is high in the frame's last clock.
// Latency: busy_o rises one clock after start_i, RESET begins two clocks after start_i, its first address one clock later.
// Cost: an acquisition counter, three registers of ACQ_WIDTH bits, two comparators, per array.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_controller `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int CLEAR_WORDS = 80,  // pixels' words, before the track phase
    parameter int FIRST_CLEAR_WORDS = CLEAR_WORDS,  // words before the coarse phase; more than CLEAR_WORDS: those of the groups, too
    parameter int ADDR_WIDTH = 7,
    parameter int ACQ_WIDTH = 16
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    input  logic                  start_i,       // ignored while busy_o is high, also in the clock of done_o
    input  logic [ ACQ_WIDTH-1:0] acq_num_i,
    input  logic [ ACQ_WIDTH-1:0] coarse_end_i,
    input  logic [ ACQ_WIDTH-1:0] track_end_i,
    output logic                  busy_o,
    output logic                  done_o,
    output logic [           2:0] state_o,
    output logic                  illegal_schedule_o,  // of the frame that has just begun; one clock
    output logic [ ACQ_WIDTH-1:0] acq_num_o,     // number of acquisitions of the frame
    // dtof_pair_sequencer
    output logic                  stream_o,
    output logic                  coarse_o,
    output logic                  point_o,
    output logic                  more_o,
    output logic [dtof_pkg::POOL_ACQUISITION_WIDTH-1:0] acquisition_t1_o,  // low bits of the acquisition's number, of the timestamp at T1
    input  logic                  acq_done_i,
    input  logic                  stream_idle_i,
    // clear
    input  logic                  keep_groups_i,  // RESET takes as long, and does not clear the groups' words
    output logic                  clear_o,
    output logic [ADDR_WIDTH-1:0] clear_address_o,
    // engines
    output logic                  decode_o,
    output logic                  choose_o,
    output logic                  decide_o,
    input  logic                  engine_done_i
);

  localparam logic [ADDR_WIDTH-1:0] LAST_PIXELS = ADDR_WIDTH'(CLEAR_WORDS - 1);
  localparam logic [ADDR_WIDTH-1:0] LAST_OF_ALL = ADDR_WIDTH'(FIRST_CLEAR_WORDS - 1);

  `DTOF_TYPE(dtof_pool_pkg, pool_state_t) state_d, state_q;
  logic stream_q, coarse_q, point_q, acq_done_q, start_q, done_q, decoded_q, entered_q, more_q, more_then_q;
  logic [ACQ_WIDTH-1:0] acq_num_q, coarse_end_q, track_end_q, acquisition_then, acquisition_q, phase_end;
  logic [ADDR_WIDTH-1:0] address_q;
  logic accept, clears, cleared, groups;

  assign accept = start_i && !busy_o;
  // One clock after the state, because only then all engines' words are 0.
  assign clears = (state_q == dtof_pool_pkg::POOL_STATE_RESET) && !entered_q;
  assign cleared = clears && (address_q == (decoded_q ? LAST_PIXELS : LAST_OF_ALL));
  assign groups = (FIRST_CLEAR_WORDS > CLEAR_WORDS) && (address_q > LAST_PIXELS);

  always_comb begin
    state_d = state_q;
    case (state_q)
      dtof_pool_pkg::POOL_STATE_IDLE:
      if (start_q) begin
        state_d = dtof_pool_pkg::POOL_STATE_RESET;
      end
      dtof_pool_pkg::POOL_STATE_RESET:
      if (cleared) begin
        if (decoded_q) begin
          state_d = dtof_pool_pkg::POOL_STATE_TRACK;
        end else begin
          state_d = dtof_pool_pkg::POOL_STATE_COARSE;
        end
      end
      dtof_pool_pkg::POOL_STATE_COARSE:
      if (stream_idle_i) begin
        state_d = dtof_pool_pkg::POOL_STATE_DECODE;
      end
      dtof_pool_pkg::POOL_STATE_DECODE:
      if (engine_done_i) begin
        state_d = dtof_pool_pkg::POOL_STATE_RESET;
      end
      dtof_pool_pkg::POOL_STATE_TRACK:
      if (stream_idle_i) begin
        state_d = dtof_pool_pkg::POOL_STATE_CHOOSE;
      end
      dtof_pool_pkg::POOL_STATE_CHOOSE:
      if (engine_done_i) begin
        state_d = dtof_pool_pkg::POOL_STATE_POINT;
      end
      dtof_pool_pkg::POOL_STATE_POINT:
      if (stream_idle_i) begin
        state_d = dtof_pool_pkg::POOL_STATE_DECIDE;
      end
      dtof_pool_pkg::POOL_STATE_DECIDE:
      if (engine_done_i) begin
        state_d = dtof_pool_pkg::POOL_STATE_IDLE;
      end
      default: state_d = dtof_pool_pkg::POOL_STATE_IDLE;
    endcase
  end

  // End of the current phase; between two phases the end of the next, so that the comparison does not depend on the change of state.
  always_comb begin
    phase_end = coarse_end_q;
    if (state_q == dtof_pool_pkg::POOL_STATE_CHOOSE || state_q == dtof_pool_pkg::POOL_STATE_POINT) begin
      phase_end = acq_num_q;
    end else if (decoded_q) begin
      phase_end = track_end_q;
    end
  end

  // acq_done_i comes straight from the port. Therefore the comparison for the next acquisition is done ahead, and the number itself changes
  // one clock later. The next acq_done_i is at least two pixels of two slots later.
  assign acquisition_then = acquisition_q + 1'b1;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q <= dtof_pool_pkg::POOL_STATE_IDLE;
      stream_q <= 1'b0;
      coarse_q <= 1'b0;
      point_q <= 1'b0;
      acq_done_q <= 1'b0;
      start_q <= 1'b0;
      done_q <= 1'b0;
      decoded_q <= 1'b0;
      entered_q <= 1'b0;
      more_q <= 1'b0;
      more_then_q <= 1'b0;
      acq_num_q <= '0;
      coarse_end_q <= '0;
      track_end_q <= '0;
      acquisition_q <= '0;
      address_q <= '0;
    end else begin
      state_q <= state_d;
      entered_q <= (state_d != state_q);
      // Registered copies of the state, because tdc_ready_o depends on them.
      stream_q <= (state_d == dtof_pool_pkg::POOL_STATE_COARSE) || (state_d == dtof_pool_pkg::POOL_STATE_TRACK)
          || (state_d == dtof_pool_pkg::POOL_STATE_POINT);
      coarse_q <= (state_d == dtof_pool_pkg::POOL_STATE_COARSE);
      point_q <= (state_d == dtof_pool_pkg::POOL_STATE_POINT);
      acq_done_q <= acq_done_i;
      start_q <= accept;
      done_q <= (state_q == dtof_pool_pkg::POOL_STATE_DECIDE) && (state_d == dtof_pool_pkg::POOL_STATE_IDLE);
      if (accept) begin
        acq_num_q <= acq_num_i;
        coarse_end_q <= coarse_end_i;
        track_end_q <= track_end_i;
        acquisition_q <= '0;
        decoded_q <= 1'b0;
      end else begin
        if (acq_done_q) begin
          acquisition_q <= acquisition_then;
        end
        if (state_q == dtof_pool_pkg::POOL_STATE_DECODE) begin
          decoded_q <= 1'b1;
        end
      end
      more_q <= acq_done_i ? more_then_q : acq_done_q ? more_q : (acquisition_q < phase_end);
      more_then_q <= (acquisition_then < phase_end);
      address_q <= (clears && !cleared) ? address_q + 1'b1 : '0;
    end
  end

  assign illegal_schedule_o = start_q && !(coarse_end_q <= track_end_q && track_end_q <= acq_num_q);
  `DTOF_ASSERT(a_schedule, !illegal_schedule_o,
               "the schedule must be coarse_end_i <= track_end_i <= acq_num_i")

  assign busy_o = start_q || (state_q != dtof_pool_pkg::POOL_STATE_IDLE) || done_q;
  assign done_o = done_q;
  assign acq_num_o = acq_num_q;
  assign state_o = state_q;
  assign stream_o = stream_q;
  assign coarse_o = coarse_q;
  assign point_o = point_q;
  assign more_o = more_q;
  assign acquisition_t1_o = dtof_pkg::POOL_ACQUISITION_WIDTH'(acquisition_q);
  assign clear_o = clears && !(groups && keep_groups_i);
  assign clear_address_o = address_q;
  assign decode_o = entered_q && (state_q == dtof_pool_pkg::POOL_STATE_DECODE);
  assign choose_o = entered_q && (state_q == dtof_pool_pkg::POOL_STATE_CHOOSE);
  assign decide_o = entered_q && (state_q == dtof_pool_pkg::POOL_STATE_DECIDE);

endmodule

`default_nettype wire
