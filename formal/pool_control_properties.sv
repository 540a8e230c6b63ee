// SPDX-License-Identifier: Apache-2.0
// Proves the control of dtof_pool_pointer_array with the columns of one SRAM: dtof_pool_controller, dtof_pair_sequencer, the registers
// between them and the columns, dtof_pool_quad. Free inputs replace the engines; they are restricted to what
// pool_sequencer_properties proves of dtof_pool_sequencer. Assertions of dtof_sram check that the single-port SRAM has one access per
// clock, and only in range.
//
// Every frame ends, for the reasons in control_properties.sv. Clocks in which the engines work are not counted here, because
// pool_sequencer_properties proves that operations of dtof_pool_sequencer end in time.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_control_properties #(
    parameter int COLUMNS = 2,
    parameter int PIXELS = 3,
    parameter int SLOTS = 2,
    parameter int GROUP_SIZE = 4,
    parameter int ACQ_WIDTH = 4,
    parameter int LONGEST_STAY = 24,
    parameter int PRIOR = 0,
    parameter int COUNT_WIDTH = 4,
    localparam int PAIRS = (COLUMNS + 1) / 2,
    localparam int NP = 8,
    localparam int GROUPS = (PIXELS + GROUP_SIZE - 1) / GROUP_SIZE,
    localparam int PIXEL_WORDS = GROUPS * (GROUP_SIZE / 2),
    localparam int WORDS = PIXEL_WORDS + (GROUPS + 1) / 2,
    localparam int ADDR_WIDTH = dtof_pkg::index_width(WORDS),
    localparam int HALF_WIDTH = dtof_pkg::pool_half_width(2, 1, 0, 4, 0, 1),
    localparam int LINE_HALVES = dtof_pkg::pool_line_halves(HALF_WIDTH, COUNT_WIDTH),
    localparam int LINE_WIDTH = LINE_HALVES * HALF_WIDTH,
    localparam int PART_WIDTH = dtof_pkg::pool_part_width(LINE_HALVES)
) (
    input logic                  clk_i,
    input logic                  start_i,
    input logic [ ACQ_WIDTH-1:0] acq_num_i,
    input logic [ ACQ_WIDTH-1:0] coarse_end_i,
    input logic [ ACQ_WIDTH-1:0] track_end_i,
    input logic                  tdc_valid_i,
    input logic [COLUMNS*NP-1:0] timestamp_i,
    input logic                  sweep_i,  // at the begin of an acquisition: the columns treat it as a sweep
    // accesses that an engine may make
    input logic                  engine_read_i,
    input logic                  engine_write_i,
    input logic [ADDR_WIDTH-1:0] engine_address_i,
    input logic [     PAIRS-1:0] engine_select_i,
    input logic                  engine_upper_i,
    input logic                  engine_used_i,
    input logic                  engine_done_i
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic busy, done, stream, coarse, point, more, acq_done, stream_idle, clear, decode, choose, decide;
  logic [2:0] state;
  logic [dtof_pkg::POOL_ACQUISITION_WIDTH-1:0] acquisition, told;
  logic [dtof_pkg::POOL_THINNING_WIDTH-1:0] thinning_t2, expected_thinning_q;
  logic is_sweep_q;  // free, because a frame of 64 acquisitions is too long for the proof
  // High bits of an acquisition's number; free, too.
  (* anyconst *) logic [2:0] high;
  assign told = acquisition | (dtof_pkg::POOL_ACQUISITION_WIDTH'(high) << 6)
      | dtof_pkg::POOL_ACQUISITION_WIDTH'({dtof_pkg::POOL_SWEEP_WIDTH{is_sweep_q}});
  logic [ADDR_WIDTH-1:0] clear_address, stream_address;

  dtof_pool_controller #(
      .CLEAR_WORDS(PIXEL_WORDS),
      .ADDR_WIDTH (ADDR_WIDTH),
      .ACQ_WIDTH  (ACQ_WIDTH)
  ) u_controller (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .start_i        (start_i),
      .acq_num_i      (acq_num_i),
      .coarse_end_i   (coarse_end_i),
      .track_end_i    (track_end_i),
      .busy_o         (busy),
      .done_o         (done),
      .state_o        (state),
      .stream_o       (stream),
      .coarse_o       (coarse),
      .point_o        (point),
      .more_o         (more),
      .acquisition_t1_o(acquisition),
      .acq_done_i     (acq_done),
      .stream_idle_i  (stream_idle),
      .clear_o        (clear),
      .clear_address_o(clear_address),
      .decode_o       (decode),
      .choose_o       (choose),
      .decide_o       (decide),
      .engine_done_i  (engine_done_i)
  );

  logic beat_t1, first_slot_t1, odd_t1, second_row_t0, first_row_t2, second_row_t2, last_slot_t1, ready;
  logic keep_first, keep_last, load, stream_read, stream_optional, stream_late, stream_write, stream_word_load, group_load, group_upper;
  logic [3:0] acquisition_t2;
  logic [PART_WIDTH-1:0] part;
  logic sweep, make_room;

  dtof_pair_sequencer #(
      .PIXELS_PER_SRAM(PIXELS),
      .SLOTS          (SLOTS),
      .GROUP_SIZE     (GROUP_SIZE),
      .LINE_HALVES    (LINE_HALVES)
  ) u_pair_sequencer (
      .clk_i            (clk_i),
      .rst_ni           (checking),
      .stream_i         (stream),
      .coarse_i         (coarse),
      .groups_i         (!coarse && !point),
      .more_i           (more),
      .acquisition_t1_i (told),
      .tdc_valid_i      (tdc_valid_i),
      .tdc_ready_o      (ready),
      .acq_done_o       (acq_done),
      .idle_o           (stream_idle),
      .beat_t1_o        (beat_t1),
      .first_slot_t1_o  (first_slot_t1),
      .last_slot_t1_o   (last_slot_t1),
      .odd_t1_o         (odd_t1),
      .second_row_t0_o  (second_row_t0),
      .first_row_t2_o   (first_row_t2),
      .second_row_t2_o  (second_row_t2),
      .acquisition_t2_o (acquisition_t2),
      .thinning_t2_o    (thinning_t2),
      .keep_first_o     (keep_first),
      .keep_last_o      (keep_last),
      .load_o           (load),
      .part_o           (part),
      .sweep_o          (sweep),
      .make_room_o      (make_room),
      .read_d_o         (stream_read),
      .optional_d_o     (stream_optional),
      .late_d_o         (stream_late),
      .write_d_o        (stream_write),
      .address_d_o      (stream_address),
      .word_load_d_o    (stream_word_load),
      .group_load_d_o   (group_load),
      .group_upper_d_o  (group_upper)
  );

  // As in dtof_pool_pointer_array.
  logic coarse_q, point_q, engine_q, read_q, optional_q, late_q, write_q, group_load_q, group_upper_q;
  logic [ADDR_WIDTH-1:0] address_q;

  always_ff @(posedge clk_i or negedge checking) begin
    if (!checking) begin
      read_q <= 1'b0;
      write_q <= 1'b0;
    end else begin
      read_q <= stream_read || engine_read_i;
      write_q <= stream_write || engine_write_i || clear;
    end
  end

  always_ff @(posedge clk_i) begin
    coarse_q <= coarse;
    point_q <= point;
    engine_q <= !stream;
    optional_q <= stream_optional;
    late_q <= stream_late;
    address_q <= clear ? clear_address : (stream ? stream_address : engine_address_i);
    group_load_q <= group_load;
    group_upper_q <= group_upper;
  end

  logic [2*LINE_WIDTH-1:0] unused_words;

  dtof_pool_quad #(
      .COLUMNS        (COLUMNS),
      .NP             (NP),
      .PIXELS_PER_SRAM(PIXELS),
      .SLOTS          (SLOTS),
      .COUNT_WIDTH    (COUNT_WIDTH),
      .GROUP_SIZE     (GROUP_SIZE),
      .LABELS         (2),
      .SCORE_BITS     (1),
      .OFFSET_BITS    (0),
      .ADVANTAGE_WIDTH(4),
      .POINTER_SHIFT  (0),
      .RIVAL_MOVES    (1),
      .PRIOR          (PRIOR)
  ) u_quad (
      .clk_i           (clk_i),
      .rst_ni          (checking),
      .timestamp_i     (timestamp_i),
      .coarse_i        (coarse_q),
      .point_i         (point_q),
      .beat_t1_i       (beat_t1),
      .first_slot_t1_i (first_slot_t1),
      .last_slot_t1_i  (last_slot_t1),
      .odd_t1_i        (odd_t1),
      .second_row_t0_i (second_row_t0),
      .first_row_t2_i  (first_row_t2),
      .second_row_t2_i (second_row_t2),
      .acquisition_t2_i(acquisition_t2),
      .thinning_t2_i   (thinning_t2),
      .keep_first_i    (keep_first),
      .keep_last_i     (keep_last),
      .load_i          (load),
      .part_i          (part),
      .sweep_i         (sweep),
      .make_room_i     (make_room),
      .read_i          (read_q),
      .optional_i      (optional_q),
      .late_i          (late_q),
      .write_i         (write_q),
      .address_i       (address_q),
      .word_load_d_i   (stream_word_load),
      .group_load_i    (group_load_q),
      .group_upper_i   (group_upper_q),
      .engine_i        (engine_q),
      .replace_i       (engine_write_i),
      .clear_i         (clear),
      .select_i        (engine_select_i),
      .upper_i         (engine_upper_i),
      .used_i          (engine_used_i),
      .engine_word_i   ('0),
      .first_beside_i  ('0),
      .second_beside_i ('0),
      .first_word_o    (unused_words[LINE_WIDTH-1:0]),
      .second_word_o   (unused_words[2*LINE_WIDTH-1:LINE_WIDTH])
  );

  // A frame; its clears are observed at one arbitrary address.
  (* anyconst *) logic [ADDR_WIDTH-1:0] watched;
  logic frame_q, accepted_q, accepted_before_q, working_q, decoded_q;
  logic [2:0] state_q;
  logic [ACQ_WIDTH-1:0] acq_num_q, coarse_end_q, track_end_q, acquisitions_q;
  logic [1:0] clears_q;
  logic [5:0] stay_q;
  logic [7:0] place_q;
  logic accepted, acquisition_begins, begins_q, stay_ends;

  // If the number of rows is no multiple of four, rows are missing; the array takes no timestamps for them.
  assign accepted = checking && ready && tdc_valid_i;
  assign acquisition_begins = accepted && (place_q == '0);
  assign stay_ends = (state != state_q);

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      frame_q <= 1'b0;
      accepted_q <= 1'b0;
      accepted_before_q <= 1'b0;
      working_q <= 1'b0;
      decoded_q <= 1'b0;
      state_q <= dtof_pool_pkg::POOL_STATE_IDLE;
      acquisitions_q <= '0;
      clears_q <= '0;
      stay_q <= '0;
      place_q <= '0;
      acq_num_q <= '0;
      begins_q <= 1'b0;
      is_sweep_q <= 1'b0;
    end else begin
      begins_q <= acquisition_begins;
      expected_thinning_q <= ((32'(told) >> 4) % 4 == 0) ? {told[6], told[7], told[8]} : 3'd7;
      if (acquisition_begins) is_sweep_q <= sweep_i;
      frame_q <= (start_i && !frame_q) || (frame_q && !done);
      accepted_q <= start_i && !frame_q;
      accepted_before_q <= accepted_q;
      working_q <= decode || choose || decide || (working_q && !engine_done_i);
      state_q <= state;
      if (start_i && !frame_q) begin
        {acq_num_q, coarse_end_q, track_end_q} <= {acq_num_i, coarse_end_i, track_end_i};
        acquisitions_q <= '0;
        decoded_q <= 1'b0;
      end else begin
        if (acquisition_begins) acquisitions_q <= acquisitions_q + 1'b1;
        if (decode) decoded_q <= 1'b1;
      end
      clears_q <= (stay_ends ? 2'd0 : clears_q) + 2'(clear && clear_address == watched);
      stay_q <= (stay_ends || acq_done || ready || working_q || state == dtof_pool_pkg::POOL_STATE_IDLE) ? '0 : stay_q + 1'b1;
      if (accepted) place_q <= (32'(place_q) == PIXELS * SLOTS - 1) ? '0 : place_q + 1'b1;
    end
  end

  logic legal;
  logic [ACQ_WIDTH-1:0] begun;
  assign begun = acquisitions_q;
  always_comb begin
    case (state_q)
      dtof_pool_pkg::POOL_STATE_IDLE: legal = (state == dtof_pool_pkg::POOL_STATE_RESET);
      dtof_pool_pkg::POOL_STATE_RESET: legal = (state == (decoded_q ? dtof_pool_pkg::POOL_STATE_TRACK : dtof_pool_pkg::POOL_STATE_COARSE));
      dtof_pool_pkg::POOL_STATE_COARSE: legal = (state == dtof_pool_pkg::POOL_STATE_DECODE) && begun == coarse_end_q;
      dtof_pool_pkg::POOL_STATE_DECODE: legal = (state == dtof_pool_pkg::POOL_STATE_RESET);
      dtof_pool_pkg::POOL_STATE_TRACK: legal = (state == dtof_pool_pkg::POOL_STATE_CHOOSE) && begun == track_end_q;
      dtof_pool_pkg::POOL_STATE_CHOOSE: legal = (state == dtof_pool_pkg::POOL_STATE_POINT);
      dtof_pool_pkg::POOL_STATE_POINT: legal = (state == dtof_pool_pkg::POOL_STATE_DECIDE) && begun == acq_num_q;
      default: legal = (state == dtof_pool_pkg::POOL_STATE_IDLE);
    endcase
  end

  `ASSUME(m_contiguous, place_q == '0 || tdc_valid_i)
  `ASSUME(m_schedule, coarse_end_i <= track_end_i && track_end_i <= acq_num_i)
  `ASSUME(m_engine_works_when_asked, working_q || (!engine_read_i && !engine_write_i && !engine_done_i))
  `ASSUME(m_engine_one_access, !(engine_read_i && engine_write_i))
  `ASSUME(m_engine_done_last, !engine_done_i || (!engine_read_i && !engine_write_i))
  `ASSUME(m_engine_one_pair, (engine_select_i & (engine_select_i - 1'b1)) == '0)
  `ASSUME(m_engine_address, 32'(engine_address_i) < WORDS)
  `ASSUME(m_watched, 32'(watched) < PIXEL_WORDS)
  `PROVE(a_busy, busy == frame_q)
  `PROVE(a_start_is_not_lost, !accepted_before_q || state == dtof_pool_pkg::POOL_STATE_RESET)
  `PROVE(a_done_ends_a_frame, !done || (frame_q && acquisitions_q == acq_num_q))
  `PROVE(a_states, !stay_ends || legal)
  `PROVE(a_no_state_lasts, 32'(stay_q) < LONGEST_STAY)
  `PROVE(a_reset_clears_once, !(stay_ends && state_q == dtof_pool_pkg::POOL_STATE_RESET) || clears_q == 2'd1)
  `PROVE(a_stream_alone, !(accepted && (clear || working_q)))
  `PROVE(a_acquisition_number, !begins_q || acquisition == dtof_pkg::POOL_ACQUISITION_WIDTH'(acquisitions_q - 1'b1))
  `PROVE(a_thinning, !begins_q || thinning_t2 == expected_thinning_q)
  `GOAL(done && acq_num_q == ACQ_WIDTH'(3) && coarse_end_q == ACQ_WIDTH'(1) && track_end_q == ACQ_WIDTH'(2))

endmodule

`default_nettype wire
