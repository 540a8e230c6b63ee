// SPDX-License-Identifier: Apache-2.0
// poolPointer: sequencer of the stream phases, once per array. It counts the timestamps of an acquisition, handshakes with the TDC
// stream, and schedules the accesses of the columns' single-port SRAMs, whose words hold two rows (a pair of pixels per column).
//
// Acquisitions start on a raster of SLOTS clocks, so that the SRAM accesses at the end of an acquisition and at the start of the
// next do not collide. If the number of rows is no multiple of four (LINE_HALVES = 2: eight), SLOTS clocks pass without timestamps
// for each missing row.
//
// Schedule (T0: the clock in which a pixel's last slot is at the port):
//   before the first acquisition of track and point (prime):
//                            read the word of group 0, if the phase needs groups, then the word of pair 0
//   track and point, second pixel of a pair:
//                            T1: read the next pair's group word, if its group is another and the phase needs groups
//                            T2: read the next pair; register the group's word
//                            T3 (SLOTS = 2): read the next pair, if only its second row has a detection
//                            T3: register the next pair's first pixel
//                            T4: write this pair; register the next pair
//   coarse phase, second pixel of a pair, for part k of the two parts of a group's bins:
//                            T1 + k: read, T2 + k: register, T3 + k: count and write
//   coarse phase with LINE_HALVES = 2, second pixel of a second pair, for part k of the four parts:
//                            T2 + 2 k: read, T3 + 2 k: register, T4 + 2 k: count, T5 + 2 k: count and write
// Every 2^POOL_SWEEP_WIDTH-th acquisition of the coarse phase is a sweep: all parts are read and no timestamp counts. In the group's
// first visit (a pair of rows, with LINE_HALVES = 2 four rows) the columns look for full bins, in its second visit they make room.
// optional_d_o marks reads that only columns with detections need: parts outside of sweeps, and with SLOTS = 2 the pairs of an
// acquisition, except its first pair, which is read before the acquisition begins.
// The outputs read, write, address and the loads are given one clock early (_d); the array registers and distributes them.
// Latency: the stage of an output is in its name (_t0, _t1, _t2). Cost: counters, and copies of the pair's number per stage.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pair_sequencer #(
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SLOTS = 2,
    parameter int GROUP_SIZE = 8,
    parameter int LINE_HALVES = 1,  // halves of a word that eight bins occupy, 1 or 2
    localparam int PART_WIDTH = dtof_pkg::pool_part_width(LINE_HALVES),
    localparam int GROUPS = (PIXELS_PER_SRAM + GROUP_SIZE - 1) / GROUP_SIZE,
    localparam int PIXEL_WORDS = GROUPS * (GROUP_SIZE / 2),
    localparam int GROUP_WORDS = (GROUPS + 1) / 2,  // each holds two groups
    localparam int ADDR_WIDTH = dtof_pkg::index_width(PIXEL_WORDS + GROUP_WORDS)
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    input  logic                  stream_i,          // a stream phase is in progress
    input  logic                  coarse_i,          // this phase is the coarse phase
    input  logic                  groups_i,          // the phase needs the groups' words; low in the coarse phase
    input  logic                  more_i,            // the phase has another acquisition to take
    input  logic [dtof_pkg::POOL_ACQUISITION_WIDTH-1:0] acquisition_t1_i,  // low bits of the acquisition's number, of the timestamp at T1
    input  logic                  tdc_valid_i,
    output logic                  tdc_ready_o,
    output logic                  acq_done_o,        // the last timestamp of an acquisition is at the port
    output logic                  idle_o,            // the pipeline is empty and the phase has no more acquisitions
    output logic                  underrun_o,       // tdc_valid_i is low inside an acquisition
    // to the columns
    output logic                  beat_t1_o,
    output logic                  first_slot_t1_o,
    output logic                  last_slot_t1_o,
    output logic                  odd_t1_o,
    output logic                  second_row_t0_o,   // the timestamp at the port belongs to a pair's second pixel
    output logic                  first_row_t2_o,    // coarse: a pair's first pixel is complete
    output logic                  second_row_t2_o,   // coarse: a pair's second pixel is complete
    output logic [           3:0] acquisition_t2_o,
    output logic [dtof_pkg::POOL_THINNING_WIDTH-1:0] thinning_t2_o,  // level of this acquisition; a timestamp in eighth e of the range
                                                                    // (0 to 7) is thinned if level < 7 - e
    // coarse
    output logic                  keep_first_o,      // four parts, T3 of a first pair: register the columns' choice
    output logic                  keep_last_o,       // four parts, T3 of a second pair: register the columns' choice
    output logic                  load_o,            // one clock after the read of a part
    output logic [PART_WIDTH-1:0] part_o,            // with load_o: number of the part
    output logic                  sweep_o,           // this visit is a sweep; changes with load_o of the first part
    output logic                  make_room_o,       // with sweep_o: this is the group's second visit; low in the other phases
    // SRAM commands, one clock early
    output logic                  read_d_o,
    output logic                  optional_d_o,      // with read_d_o: columns without detections do not need the word
    output logic                  late_d_o,          // with optional_d_o: coarse, the part is not the first; otherwise, the read is for the pair's second
                                                     // row, and T2 has read the word if the first row has a detection
    output logic                  write_d_o,
    output logic [ADDR_WIDTH-1:0] address_d_o,
    output logic                  word_load_d_o,
    output logic                  group_load_d_o,
    output logic                  group_upper_d_o    // with group_load_d_o: the group is in the upper half of the word
);

  localparam int VISIT_PAIRS = LINE_HALVES;  // pairs of rows that count together
  // Including missing pairs. A group has at least two visits.
  localparam int PAIRS = 2 * VISIT_PAIRS * ((PIXELS_PER_SRAM + 4 * VISIT_PAIRS - 1) / (4 * VISIT_PAIRS));
  localparam int STEPS = 2 * SLOTS;
  localparam int STEP_WIDTH = $clog2(STEPS);
  localparam int PAIR_WIDTH = dtof_pkg::index_width(PAIRS);
  localparam int SLOT_WIDTH = dtof_pkg::index_width(SLOTS);
  localparam int GROUP_PAIRS = GROUP_SIZE / 2;
  localparam int GROUP_SHIFT = $clog2(GROUP_PAIRS);
  localparam int PARTS = 1 << PART_WIDTH;
  localparam int PART_CLOCKS = PARTS / 2;  // clocks from one part to the next
  localparam logic [PAIR_WIDTH-1:0] LAST_PAIR = PAIR_WIDTH'(PAIRS - 1);
  localparam logic [STEP_WIDTH-1:0] LAST_STEP = STEP_WIDTH'(STEPS - 1);
  localparam logic [SLOT_WIDTH-1:0] LAST_SLOT = SLOT_WIDTH'(SLOTS - 1);
  localparam int FIRST_STAGE = (PARTS == 2) ? 0 : 1;    // stage T in which the first part is read
  localparam int LAST_STAGE = FIRST_STAGE + 1 + PART_CLOCKS * PARTS;  // stage T in which the last part is written
  // A phase ends after the command of its last count: stream_i falls one clock after drain_q = 0.
  localparam int DRAIN_WIDTH = $clog2(LAST_STAGE);
  localparam logic [DRAIN_WIDTH-1:0] DRAIN_CLOCKS = DRAIN_WIDTH'(LAST_STAGE - 1);
  localparam logic [2:0] PRIMED = 3'd6;

  // T0

  logic active_q;
  logic [2:0] prime_q;
  logic [DRAIN_WIDTH-1:0] drain_q;
  logic [SLOT_WIDTH-1:0] raster_q;
  logic [STEP_WIDTH-1:0] step_q;
  logic [PAIR_WIDTH-1:0] pair_q;
  logic at_start, busy, missing, second_pixel, last_pair;

  assign at_start = stream_i && (prime_q == PRIMED) && (raster_q == '0) && !active_q && more_i;
  assign busy = active_q || (at_start && tdc_valid_i);
  assign second_pixel = (step_q >= STEP_WIDTH'(SLOTS));
  assign last_pair = (pair_q == LAST_PAIR);
  assign missing = (32'(pair_q) * 2 + 32'(second_pixel)) >= PIXELS_PER_SRAM;
  assign tdc_ready_o = (active_q && !missing) || at_start;
  assign acq_done_o = busy && last_pair && (step_q == LAST_STEP);
  assign idle_o = (drain_q == '0);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      active_q <= 1'b0;
      prime_q <= '0;
      drain_q <= DRAIN_CLOCKS;
      raster_q <= '0;
      step_q <= '0;
      pair_q <= '0;
    end else begin
      if (!stream_i) begin
        prime_q <= '0;
        raster_q <= '0;
        drain_q <= DRAIN_CLOCKS;
      end else begin
        raster_q <= (raster_q == LAST_SLOT) ? '0 : raster_q + 1'b1;
        if (prime_q != PRIMED) begin
          prime_q <= prime_q + 1'b1;
        end
        if (more_i || busy) begin
          drain_q <= DRAIN_CLOCKS;
        end else if (drain_q != '0) begin
          drain_q <= drain_q - 1'b1;
        end
      end
      if (busy) begin
        active_q <= !acq_done_o;
        step_q <= (step_q == LAST_STEP) ? '0 : step_q + 1'b1;
        if (step_q == LAST_STEP) begin
          pair_q <= last_pair ? '0 : pair_q + 1'b1;
        end
      end
    end
  end

  // Inside an acquisition, a clock without tdc_valid_i counts as "no detection".
  assign underrun_o = active_q && !missing && !tdc_valid_i;
  `DTOF_ASSERT(a_contiguous_acquisition, !underrun_o,
               "tdc_valid_i fell inside an acquisition")

  // T1

  logic busy_t1_q, beat_t1_q, first_slot_t1_q, second_pixel_t1_q;
  logic [STEP_WIDTH-1:0] step_t1_q;
  logic [PAIR_WIDTH-1:0] pair_t1_q, next_pair_t1;
  logic first_slot, next_group_t1, last_step_t1, second_row_t1;

  assign first_slot = (step_q == '0) || (step_q == STEP_WIDTH'(SLOTS));

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      busy_t1_q <= 1'b0;
      beat_t1_q <= 1'b0;
      first_slot_t1_q <= 1'b0;
    end else begin
      busy_t1_q <= busy;
      beat_t1_q <= busy && !missing && tdc_valid_i;
      first_slot_t1_q <= busy && first_slot;
    end
  end

  always_ff @(posedge clk_i) begin
    step_t1_q <= step_q;
    pair_t1_q <= pair_q;
    second_pixel_t1_q <= second_pixel;
  end

  assign next_pair_t1 = (pair_t1_q == LAST_PAIR) ? '0 : pair_t1_q + 1'b1;
  assign next_group_t1 = (GROUPS > 1) && ((32'(next_pair_t1) % GROUP_PAIRS) == 0);
  // Last step of a pixel; missing pixels have steps, too.
  assign last_step_t1 = busy_t1_q && (step_t1_q == STEP_WIDTH'(SLOTS - 1) || step_t1_q == LAST_STEP);
  assign second_row_t1 = coarse_i && last_step_t1 && second_pixel_t1_q;

  // Parts of a group's bins, from FIRST_STAGE on.

  logic [LAST_STAGE:FIRST_STAGE] fetch_tn;
  logic [LAST_STAGE:FIRST_STAGE+1] fetch_tn_q;
  logic [(LAST_STAGE+1)*PAIR_WIDTH-1:0] pair_tn;  // pair at T0 .. LAST_STAGE, T0 lowest
  logic [(LAST_STAGE-1)*PAIR_WIDTH-1:0] pair_tn_q;  // pair at T2 .. LAST_STAGE
  logic [PAIR_WIDTH-1:0] pair_t3;
  logic second_visit_t2_q, second_visit_t3_q, second_row_t2_q, second_row_t3_q, second_pair_t2_q, second_pair_t3_q;
  logic [3:0] acquisition_t2_q;
  logic [dtof_pkg::POOL_THINNING_WIDTH-1:0] thinning_t2_q;
  logic sweep_t1, sweep_t2_q, sweep_then, second_visit_then;
  logic [PAIR_WIDTH-1:0] pair_then;  // pair, one clock before load_o of the first part
  logic read_part, load_part, write_part;
  integer n;

  assign fetch_tn = {fetch_tn_q, (PARTS == 2) ? coarse_i && busy && step_q == LAST_STEP : second_row_t1 && pair_t1_q[0]};
  assign pair_tn = {pair_tn_q, pair_t1_q, pair_q};

  always_comb begin
    read_part = 1'b0;
    load_part = 1'b0;
    write_part = 1'b0;
    for (n = 0; n < PARTS; n = n + 1) begin
      read_part = read_part || fetch_tn[FIRST_STAGE+n*PART_CLOCKS];
      load_part = load_part || fetch_tn[FIRST_STAGE+1+n*PART_CLOCKS];
      write_part = write_part || fetch_tn[FIRST_STAGE+1+(n+1)*PART_CLOCKS];
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      fetch_tn_q <= '0;
      load_o <= 1'b0;
      second_visit_t2_q <= 1'b0;
      second_visit_t3_q <= 1'b0;
      second_row_t2_q <= 1'b0;
      second_row_t3_q <= 1'b0;
    end else begin
      fetch_tn_q <= fetch_tn[LAST_STAGE-1:FIRST_STAGE];
      load_o <= load_part;
      second_visit_t2_q <= last_step_t1 && second_pixel_t1_q && !coarse_i;
      second_visit_t3_q <= second_visit_t2_q;
      second_row_t2_q <= second_row_t1;
      second_row_t3_q <= second_row_t2_q;
    end
  end

  assign sweep_t1 = (acquisition_t1_i[dtof_pkg::POOL_SWEEP_WIDTH-1:0] == {dtof_pkg::POOL_SWEEP_WIDTH{1'b1}});
  assign sweep_then = (PARTS == 2) ? sweep_t1 : sweep_t2_q;
  assign pair_then = pair_tn[(FIRST_STAGE+1)*PAIR_WIDTH+:PAIR_WIDTH];
  assign second_visit_then = ((32'(pair_then) % GROUP_PAIRS) / VISIT_PAIRS == 1);

  always_ff @(posedge clk_i) begin
    pair_tn_q <= pair_tn[PAIR_WIDTH+:(LAST_STAGE-1)*PAIR_WIDTH];
    acquisition_t2_q <= acquisition_t1_i[3:0];
    // One acquisition of four thins. The levels of these come in the reverse order of their bits, so that short frames have all.
    thinning_t2_q <= {acquisition_t1_i[6], acquisition_t1_i[7], acquisition_t1_i[8]}
        | {dtof_pkg::POOL_THINNING_WIDTH{acquisition_t1_i[5:4] != 2'd0}};
    sweep_t2_q <= sweep_t1;
    first_row_t2_o <= coarse_i && last_step_t1 && !second_pixel_t1_q;
    second_pair_t2_q <= pair_t1_q[0];
    second_pair_t3_q <= second_pair_t2_q;
    if (load_part) begin
      part_o <= fetch_tn[FIRST_STAGE+1] ? '0 : part_o + 1'b1;
    end
    if (fetch_tn[FIRST_STAGE+1]) begin
      sweep_o <= sweep_then;
    end
    make_room_o <= coarse_i && (fetch_tn[FIRST_STAGE+1] ? sweep_then && second_visit_then : make_room_o);
  end

  `DTOF_ASSERT(a_phase_complete, stream_i || (!busy_t1_q && !second_visit_t2_q && !second_visit_t3_q && fetch_tn_q == '0),
               "a phase ended with timestamps in the pipeline")

  assign beat_t1_o = beat_t1_q;
  assign first_slot_t1_o = first_slot_t1_q;
  assign last_slot_t1_o = last_step_t1;
  assign odd_t1_o = acquisition_t1_i[0];
  assign second_row_t0_o = second_pixel;
  assign acquisition_t2_o = acquisition_t2_q;
  assign thinning_t2_o = thinning_t2_q;
  assign second_row_t2_o = second_row_t2_q;
  assign keep_first_o = second_row_t3_q && PARTS == 4 && !second_pair_t3_q;
  assign keep_last_o = second_row_t3_q && PARTS == 4 && second_pair_t3_q;
  assign pair_t3 = pair_tn[3*PAIR_WIDTH+:PAIR_WIDTH];

  logic prime_group, prime_word, read_group, read_word, write_word, optional_word, late_q;
  assign prime_group = stream_i && groups_i && (prime_q == 3'd1);
  assign prime_word = stream_i && !coarse_i && (prime_q == 3'd2);
  assign read_group = busy_t1_q && groups_i && next_group_t1 && (step_t1_q == STEP_WIDTH'(STEPS - 2));
  assign read_word = busy_t1_q && !coarse_i && (step_t1_q == LAST_STEP);
  assign write_word = second_visit_t3_q;
  assign optional_word = read_word && SLOTS == 2 && pair_t1_q != LAST_PAIR;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      late_q <= 1'b0;
    end else begin
      late_q <= optional_word;
    end
  end

  assign read_d_o = prime_group || prime_word || read_group || read_word || late_q || read_part;
  assign late_d_o = late_q || (read_part && !fetch_tn[FIRST_STAGE]);
  // With four parts sweep_o has this visit's value from the read of the second part on.
  assign optional_d_o = optional_word || late_q || (read_part && !((PARTS == 2 || fetch_tn[FIRST_STAGE]) ? sweep_t1 : sweep_o));
  assign write_d_o = write_word || write_part;
  assign group_load_d_o = groups_i && (prime_word || (busy_t1_q && next_group_t1 && step_t1_q == LAST_STEP));
  assign word_load_d_o = (stream_i && !coarse_i && prime_q == 3'd3) || second_visit_t2_q;

  assign group_upper_d_o = !prime_word && 1'(32'(next_pair_t1) >> GROUP_SHIFT);

  // Address of the part that is read or written next. A part is never read in the clock in which another is written.
  function automatic logic [ADDR_WIDTH-1:0] word_of(input logic [PAIR_WIDTH-1:0] pair,
                                                           input logic [ADDR_WIDTH-1:0] part);
    word_of = ADDR_WIDTH'((32'(pair) >> GROUP_SHIFT) << GROUP_SHIFT) | part;
  endfunction

  logic [ADDR_WIDTH-1:0] part_address;
  integer m;
  always_comb begin
    part_address = '0;
    for (m = 0; m < PARTS; m = m + 1) begin
      if (fetch_tn[FIRST_STAGE+m*PART_CLOCKS]) begin
        part_address = word_of(pair_tn[(FIRST_STAGE+m*PART_CLOCKS)*PAIR_WIDTH+:PAIR_WIDTH], ADDR_WIDTH'(m));
      end
      if (fetch_tn[FIRST_STAGE+1+(m+1)*PART_CLOCKS]) begin
        part_address = word_of(pair_tn[(FIRST_STAGE+1+(m+1)*PART_CLOCKS)*PAIR_WIDTH+:PAIR_WIDTH], ADDR_WIDTH'(m));
      end
    end
  end

  always_comb begin
    address_d_o = '0;
    if (read_group) begin
      address_d_o = ADDR_WIDTH'(PIXEL_WORDS + (32'(next_pair_t1) >> (GROUP_SHIFT + 1)));
    end else if (prime_group) begin
      address_d_o = ADDR_WIDTH'(PIXEL_WORDS);
    end else if (read_word) begin
      address_d_o = ADDR_WIDTH'(next_pair_t1);
    end else if (late_q) begin
      address_d_o = ADDR_WIDTH'(pair_t1_q);
    end else if (write_word) begin
      address_d_o = ADDR_WIDTH'(pair_t3);
    end else if (coarse_i) begin
      address_d_o = part_address;
    end
  end

endmodule

`default_nettype wire
