// SPDX-License-Identifier: Apache-2.0
// poolPointer: the control that all pairs and engines share, once per array: state machine, sequencers of pairs and engines, settings of a frame.
// sent_o has all commands of a clock, as a sent_t (dtof_pool_commands.svh).
//
// start_i samples the settings, except template_i, which must be stable while busy_o is high. The sequencers give reads, writes, their
// addresses and the loads of groups' words one clock before all other commands; registers here align them.
// Schedule: of a frame in dtof_pool_controller, of an acquisition in dtof_pair_sequencer, of the engines' operations in dtof_pool_sequencer.
// Latency: commands leave in the clock in which their sequencer gives them, those that come early one clock later.
// Cost: the modules in it and ADDR_WIDTH + 8 flip-flops, with PRIOR = 1 two more, per array.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_control `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SLOTS = 2,
    parameter int GROUP_SIZE = 4,
    parameter int LABELS = 5,
    parameter int RIVAL_MOVES = 1,
    parameter int LINE_HALVES = 2,
    parameter int SIGNIFICANCE_WIDTH = 0,  // bits of a candidate's significance
    parameter int PARITY = 0,
    parameter int TIME_GATE = 0,
    parameter int PRIOR = 0,
    parameter int ENGINE_COLUMNS = 34,  // columns of a full engine
    parameter int LAST_COLUMNS = 30,    // columns of the last engine, up to ENGINE_COLUMNS
    parameter int ACQ_WIDTH = 16,
    localparam int GROUPS = (PIXELS_PER_SRAM + GROUP_SIZE - 1) / GROUP_SIZE,
    localparam int PIXEL_WORDS = GROUPS * (GROUP_SIZE / 2),
    localparam int SRAM_WORDS = PIXEL_WORDS + (GROUPS + 1) / 2,
    localparam int ADDR_WIDTH = dtof_pkg::index_width(SRAM_WORDS),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int STEP_WIDTH = dtof_pkg::index_width(ENGINE_COLUMNS),
    localparam int STEP_PAIRS = (ENGINE_COLUMNS + 1) / 2,
    localparam int LAST_PAIRS = (LAST_COLUMNS + 1) / 2,
    localparam int PART_WIDTH = dtof_pkg::pool_part_width(LINE_HALVES),
    localparam int SENT_WIDTH = dtof_pkg::pool_sent_width(NP, ADDR_WIDTH, ROW_WIDTH, STEP_PAIRS + LAST_PAIRS, PART_WIDTH)
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    // as in dtof_pool_pointer_array
    input  logic                  start_i,
    input  logic [ ACQ_WIDTH-1:0] acq_num_i,
    input  logic [        NP-1:0] gate_begin_i,
    input  logic [        NP-1:0] gate_end_i,
    input  logic [ ACQ_WIDTH-1:0] coarse_end_i,
    input  logic [ ACQ_WIDTH-1:0] track_end_i,
    input  logic                  smooth_i,
    input  logic [dtof_pkg::POOL_COARSE_BINS*dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] template_i,
    input  logic                  prior_i,
    output logic                  busy_o,
    output logic                  done_o,
    output logic [           2:0] state_o,
    output logic [dtof_pkg::ERROR_WIDTH-1:0] error_o,
    input  logic                  tdc_valid_i,
    output logic                  tdc_ready_o,
    output logic [SENT_WIDTH-1:0] sent_o,
    // dtof_pool_result_path
    output logic                  send_o,
    output logic [STEP_WIDTH-1:0] send_column_o,
    output logic [ ROW_WIDTH-1:0] send_row_o,
    output logic                  send_last_o,
    input  logic                  send_waits_i,
    input  logic                  send_busy_i
);

  logic stream, coarse, point, more, acq_done, stream_idle, clear;
  logic [dtof_pkg::POOL_ACQUISITION_WIDTH-1:0] acquisition_t1;
  logic decode, choose, decide, engine_done, underrun, illegal_schedule;
  logic [ADDR_WIDTH-1:0] clear_address, stream_address, engine_address;
  logic [ACQ_WIDTH-1:0] acq_num;
  logic keep_groups;

  dtof_pool_controller #(
      .CLEAR_WORDS(PIXEL_WORDS),
      .FIRST_CLEAR_WORDS((PARITY != 0) ? SRAM_WORDS : PIXEL_WORDS),
      .ADDR_WIDTH (ADDR_WIDTH),
      .ACQ_WIDTH  (ACQ_WIDTH)
  ) u_controller (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .start_i        (start_i),
      .acq_num_i      (acq_num_i),
      .coarse_end_i   (coarse_end_i),
      .track_end_i    (track_end_i),
      .busy_o         (busy_o),
      .done_o         (done_o),
      .state_o        (state_o),
      .illegal_schedule_o(illegal_schedule),
      .acq_num_o      (acq_num),
      .stream_o       (stream),
      .coarse_o       (coarse),
      .point_o        (point),
      .more_o         (more),
      .acquisition_t1_o(acquisition_t1),
      .acq_done_i     (acq_done),
      .stream_idle_i  (stream_idle),
      .keep_groups_i  (keep_groups),
      .clear_o        (clear),
      .clear_address_o(clear_address),
      .decode_o       (decode),
      .choose_o       (choose),
      .decide_o       (decide),
      .engine_done_i  (engine_done)
  );

  logic beat_t1, first_slot_t1, odd_t1, second_row_t0, first_row_t2, second_row_t2, last_slot_t1;
  logic keep_first, keep_last, load, stream_read, stream_optional, stream_late, stream_write, stream_word_load, group_load, group_upper;
  logic [3:0] acquisition_t2;
  logic [dtof_pkg::POOL_THINNING_WIDTH-1:0] thinning_t2;
  logic [PART_WIDTH-1:0] part;
  logic sweep, make_room, groups;

  // With RIVAL_MOVES = 1 the pointer phase does not use candidates.
  assign groups = !coarse && !(RIVAL_MOVES != 0 && point);

  logic [NP-1:0] gate_begin, gate_end;

  dtof_gate_register #(
      .NP       (NP),
      .TIME_GATE(TIME_GATE)
  ) u_gate_register (
      .clk_i       (clk_i),
      .start_i     (start_i),
      .busy_i      (busy_o),
      .gate_begin_i(gate_begin_i),
      .gate_end_i  (gate_end_i),
      .gate_begin_o(gate_begin),
      .gate_end_o  (gate_end)
  );

  dtof_array_errors u_errors (
      .clk_i             (clk_i),
      .rst_ni            (rst_ni),
      .start_i           (start_i),
      .busy_i            (busy_o),
      .underrun_i        (underrun),
      .illegal_schedule_i(illegal_schedule),
      .error_o           (error_o)
  );

  dtof_pair_sequencer #(
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .SLOTS          (SLOTS),
      .GROUP_SIZE     (GROUP_SIZE),
      .LINE_HALVES    (LINE_HALVES)
  ) u_pair_sequencer (
      .clk_i            (clk_i),
      .rst_ni           (rst_ni),
      .stream_i         (stream),
      .coarse_i         (coarse),
      .groups_i         (groups),
      .more_i           (more),
      .acquisition_t1_i (acquisition_t1),
      .tdc_valid_i      (tdc_valid_i),
      .tdc_ready_o      (tdc_ready_o),
      .acq_done_o       (acq_done),
      .idle_o           (stream_idle),
      .underrun_o       (underrun),
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

  logic [STEP_WIDTH-1:0] engine_column;
  logic [STEP_PAIRS-1:0] engine_select;
  logic engine_read, engine_write, engine_upper, engine_neighbour;
  `DTOF_TYPE(dtof_pool_pkg, pool_engine_command_t) command;
  logic [ROW_WIDTH-1:0] scratch_row;
  logic prior_q;
  logic [$clog2(dtof_pkg::POOL_COARSE_BINS)-1:0] template_bin;

  dtof_pool_sequencer #(
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .GROUP_SIZE     (GROUP_SIZE),
      .LABELS         (LABELS),
      .LINE_HALVES    (LINE_HALVES),
      .ENGINE_COLUMNS (ENGINE_COLUMNS),
      .SMOOTH_STARTS  (RIVAL_MOVES),
      .PRIOR          (PRIOR),
      .SIGNIFICANCE_WIDTH(SIGNIFICANCE_WIDTH)
  ) u_sequencer (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .decode_i     (decode),
      .choose_i     (choose),
      .decide_i     (decide),
      .prior_i      (prior_q),
      .done_o       (engine_done),
      .read_d_o     (engine_read),
      .write_d_o    (engine_write),
      .address_d_o  (engine_address),
      .select_o     (engine_select),
      .upper_o      (engine_upper),
      .neighbour_o  (engine_neighbour),
      .command_o    (command),
      .template_bin_o(template_bin),
      .scratch_row_o(scratch_row),
      .column_o     (engine_column),
      .send_o       (send_o),
      .send_column_o(send_column_o),
      .send_row_o   (send_row_o),
      .send_last_o  (send_last_o),
      .send_waits_i (send_waits_i),
      .send_busy_i  (send_busy_i)
  );

  logic smooth_q;

  always_ff @(posedge clk_i) begin
    if (start_i && !busy_o) begin
      smooth_q <= smooth_i;
    end
  end

  logic [dtof_pkg::POOL_SIGNIFICANCE_OFFSET_WIDTH-1:0] significance_offset;

  dtof_significance_offset #(
      .ACQ_WIDTH(ACQ_WIDTH)
  ) u_significance_offset (
      .clk_i    (clk_i),
      .acq_num_i(acq_num),
      .offset_o (significance_offset)
  );

  logic [dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] template_entry;
  logic template_hidden;

  dtof_coarse_template u_coarse_template (
      .clk_i     (clk_i),
      .template_i(template_i),
      .bin_i     (template_bin),
      .entry_o   (template_entry),
      .hidden_o  (template_hidden)
  );

  // The SRAMs hold groups' words of a last frame only if a frame has ended since reset. With PARITY = 1 these words are cleared when
  // nobody needs them, because an engine replaces a part of a word, and writes back the other parts as it has read them.

  generate
    if (PRIOR != 0) begin : g_prior
      logic ended_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          ended_q <= 1'b0;
        end else begin
          ended_q <= ended_q || done_o;
        end
      end
      always_ff @(posedge clk_i) begin
        if (start_i && !busy_o) begin
          prior_q <= prior_i && ended_q;
        end
      end
      assign keep_groups = ended_q;
    end else begin : g_no_prior
      assign prior_q = 1'b0;
      assign keep_groups = 1'b0;
      logic unused_prior;
      assign unused_prior = prior_i;
    end
  endgenerate

  // Commands to pairs and engines. The last engine may have fewer columns; its last pair then replaces the missing neighbour to its
  // right.

  logic read_q, write_q, has_right, last_has_right;
  logic [ADDR_WIDTH-1:0] address_q;
  logic [LAST_PAIRS-1:0] last_select, last_part;

  // The sequencers give read, write and address one clock before the other commands; this register aligns them, in time for the data that
  // a pair prepares before it writes.
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      read_q <= 1'b0;
      write_q <= 1'b0;
    end else begin
      read_q <= stream_read || engine_read;
      write_q <= stream_write || engine_write || clear;
    end
  end

  logic coarse_q, point_q, engine_q, optional_q, late_q, group_load_q, group_upper_q;

  always_ff @(posedge clk_i) begin
    coarse_q <= coarse;
    point_q <= point;
    engine_q <= !stream;
    optional_q <= stream_optional;
    late_q <= stream_late;
    address_q <= clear ? clear_address : (stream ? stream_address : engine_address);
    group_load_q <= group_load;
    group_upper_q <= group_upper;
  end

  generate
    if (LAST_PAIRS < STEP_PAIRS) begin : g_fewer
      assign last_part = engine_select[LAST_PAIRS-1:0]
          | (LAST_PAIRS'(engine_neighbour && engine_select[LAST_PAIRS]) << (LAST_PAIRS - 1));
    end else begin : g_all
      assign last_part = engine_select;
      logic unused_neighbour;
      assign unused_neighbour = engine_neighbour;
    end

    if (PRIOR != 0 && LAST_COLUMNS < ENGINE_COLUMNS && LAST_COLUMNS % 2 == 1) begin : g_missing_column
      // The engines work on the last pair's missing second column, too; its choices must not count as used.
      assign last_select = last_part & {LAST_PAIRS{!(command.giving_used && engine_column == STEP_WIDTH'(LAST_COLUMNS))}};
    end else begin : g_no_missing_column
      assign last_select = last_part;
    end
  endgenerate

  // In decode engine_column is the first column of the pair in work.
  assign has_right = (engine_column != STEP_WIDTH'(command.decoding ? (ENGINE_COLUMNS - 1) / 2 * 2 : ENGINE_COLUMNS - 1));
  assign last_has_right = (engine_column != STEP_WIDTH'(command.decoding ? (LAST_COLUMNS - 1) / 2 * 2 : LAST_COLUMNS - 1));
  `include "dtof_pool_commands.svh"

  sent_t sent;

  assign sent.template_hidden = template_hidden;
  assign sent.template_entry = template_entry;
  assign sent.significance_offset = significance_offset;
  assign sent.gate_begin = gate_begin;
  assign sent.gate_end = gate_end;
  assign sent.smooth = smooth_q;
  assign sent.coarse = coarse_q;
  assign sent.point = point_q;
  assign sent.beat_t1 = beat_t1;
  assign sent.first_slot_t1 = first_slot_t1;
  assign sent.last_slot_t1 = last_slot_t1;
  assign sent.odd_t1 = odd_t1;
  assign sent.second_row_t0 = second_row_t0;
  assign sent.first_row_t2 = first_row_t2;
  assign sent.second_row_t2 = second_row_t2;
  assign sent.acquisition_t2 = acquisition_t2;
  assign sent.thinning_t2 = thinning_t2;
  assign sent.keep_first = keep_first;
  assign sent.keep_last = keep_last;
  assign sent.load = load;
  assign sent.part = part;
  assign sent.sweep = sweep;
  assign sent.make_room = make_room;
  assign sent.read = read_q;
  assign sent.optional = optional_q;
  assign sent.late = late_q;
  assign sent.write = write_q;
  assign sent.address = address_q;
  assign sent.word_load = stream_word_load;
  assign sent.group_load = group_load_q;
  assign sent.group_upper = group_upper_q;
  assign sent.engine = engine_q;
  assign sent.replace = engine_write;
  assign sent.clear = clear;
  assign sent.select = engine_select;
  assign sent.last_select = last_select;
  assign sent.upper = engine_upper;
  assign sent.used = command.giving_used;
  assign sent.has_right = has_right;
  assign sent.last_has_right = last_has_right;
  assign sent.scratch_row = scratch_row;
  assign sent.command = command;
  assign sent_o = sent;

endmodule

`default_nettype wire
