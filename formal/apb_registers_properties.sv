// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_apb_registers: a write changes the register at its offset and no other, in the bytes that pstrb_i selects; a read
// returns what was written last, a constant or a status; a refused access is answered with an error and changes nothing; sticky bits
// are set by their events, and only a 1 written to them clears them; the settings of a frame change together, with a commit. The
// harness watches one arbitrary register. The master keeps a request until it ends, and may do anything else, for instance access without a setup;
// a reset may come at any time.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module apb_registers_properties #(
    parameter int HAS_SCHEDULE = 1,
    parameter int TIME_GATE = 1,
    parameter int RASTER_ORDER = 0,
    parameter int SECOND_TARGET = 1,
    parameter int AMPLITUDE = 1,
    parameter int PRIOR = 1,
    parameter int RAW_HISTOGRAM = 1,
    parameter int PARITY = 0,
    parameter int SELF_TEST = 1,
    parameter int CLOCK_WAITS = 1,
    parameter int SOURCE_WAITS = 0,
    parameter int WINDOW_CENTRED = 1,
    parameter int RIVAL_MOVES = 0,
    parameter int NP = 3,
    parameter int SRAM_NUM = 35,
    parameter int CONFIDENCE_WIDTH = 2,
    parameter int ACQ_WIDTH = 3
) (
    input logic        clk_i,
    input logic        reset_i,
    input logic        psel_i,
    input logic        penable_i,
    input logic        pwrite_i,
    input logic [11:0] paddr_i,
    input logic [31:0] pwdata_i,
    input logic [ 3:0] pstrb_i,
    input logic        busy_i,
    input logic [ 2:0] state_i,
    input logic [15:0] level_i,
    input logic [31:0] frame_count_i,
    input logic [31:0] frame_cycles_i,
    input logic [31:0] frame_crc_i,
    input logic        starting_i,
    input logic        frame_crc_pending_i,
    input logic [31:0] lost_lines_i,
    input logic [31:0] lost_acquisitions_i,
    input logic [15:0] shot_state_i,
    input logic [31:0] parity_errors_i,
    input logic        self_test_busy_i,
    input logic        self_test_passed_i,
    input logic        frame_i,
    input logic        underrun_i,
    input logic        start_ignored_i,
    input logic        illegal_schedule_i,
    input logic        overrun_i,
    input logic        short_i,
    input logic        long_i,
    input logic        timeout_i,
    input logic        stalled_i,
    input logic        flush_ignored_i,
    input logic        parity_error_i,
    input logic        self_test_failed_i,
    input logic        aborted_i,
    input logic        counter_full_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  // The array's reset after rst_ni takes eleven clocks.
  localparam logic [3:0] STARTING_CLOCKS = 4'd11;
  logic [3:0] started_q;
  logic starting;
  assign starting = starting_i && started_q < STARTING_CLOCKS;
  always_ff @(posedge clk_i) begin
    started_q <= !rst_n ? 4'd0 : started_q + 4'(started_q < STARTING_CLOCKS);
  end

  localparam int MOST_RELEASE = 5;

  logic pready, pslverr, start, self_test, flush, abort, continuous, reseed, second, amplitude, raw, smooth, prior, short_words, irq;
  logic [31:0] prdata, test_seed, test_expected;
  logic [23:0] watchdog;
  logic [15:0] seed, release_lines, weak_below, settle;
  logic [11:0] raw_first, raw_last;
  logic [ACQ_WIDTH-1:0] acquisitions, coarse_end, track_end;
  logic [255:0] coarse_template;
  logic [NP-1:0] gate_begin, gate_end;
  logic [SRAM_NUM-1:0] enable;
  logic [2:0] shot_bits;
  logic [7:0] shot_unit;

  dtof_apb_registers #(
      .READOUT         (3),
      .HAS_SCHEDULE    (HAS_SCHEDULE),
      .TIME_GATE       (TIME_GATE),
      .RASTER_ORDER    (RASTER_ORDER),
      .PARITY          (PARITY),
      .SELF_TEST       (SELF_TEST),
      .CLOCK_WAITS     (CLOCK_WAITS),
      .SOURCE_WAITS    (SOURCE_WAITS),
      .SECOND_TARGET   (SECOND_TARGET),
      .AMPLITUDE       (AMPLITUDE),
      .PRIOR           (PRIOR),
      .RAW_HISTOGRAM   (RAW_HISTOGRAM),
      .RAW_BINS        (1000),
      .NP              (NP),
      .SRAM_NUM        (SRAM_NUM),
      .PIXELS_PER_SRAM (70),
      .SLOTS           (2),
      .FRACTION_WIDTH  (6),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .ACQ_WIDTH       (ACQ_WIDTH),
      .COUNT_WIDTH     (9),
      .NB              (5),
      .WINDOW_CENTRED  (WINDOW_CENTRED),
      .POINTER_STEP    (21),
      .GROUP_SIZE      (4),
      .LABELS          (5),
      .SCORE_BITS      (6),
      .OFFSET_BITS     (7),
      .ADVANTAGE_WIDTH (8),
      .POINTER_SHIFT   (1),
      .CELL_SHIFT      (10),
      .RIVAL_MOVES     (RIVAL_MOVES),
      .ENGINE_COLUMNS  (34),
      .COARSE_SHARE    (14),
      .TRACK_SHARE     (20),
      .BUFFER_LINES    (324),
      .MOST_RELEASE    (MOST_RELEASE)
  ) u_dut (
      .clk_i              (clk_i),
      .rst_ni             (rst_n),
      .starting_i         (starting),
      .psel_i             (psel_i),
      .penable_i          (penable_i),
      .pwrite_i           (pwrite_i),
      .paddr_i            (paddr_i),
      .pwdata_i           (pwdata_i),
      .pstrb_i            (pstrb_i),
      .pready_o           (pready),
      .prdata_o           (prdata),
      .pslverr_o          (pslverr),
      .start_o            (start),
      .self_test_o        (self_test),
      .flush_o            (flush),
      .abort_o            (abort),
      .continuous_o       (continuous),
      .watchdog_o         (watchdog),
      .shot_seed_o        (seed),
      .shot_reseed_o      (reseed),
      .self_test_seed_o   (test_seed),
      .self_test_expected_o(test_expected),
      .second_o           (second),
      .amplitude_o        (amplitude),
      .raw_o              (raw),
      .raw_first_o        (raw_first),
      .raw_last_o         (raw_last),
      .acquisitions_o     (acquisitions),
      .coarse_end_o       (coarse_end),
      .track_end_o        (track_end),
      .smooth_o           (smooth),
      .template_o         (coarse_template),
      .prior_o            (prior),
      .short_words_o      (short_words),
      .gate_begin_o       (gate_begin),
      .gate_end_o         (gate_end),
      .release_o          (release_lines),
      .weak_below_o       (weak_below),
      .enable_o           (enable),
      .shot_bits_o        (shot_bits),
      .shot_unit_o        (shot_unit),
      .settle_o           (settle),
      .busy_i             (busy_i),
      .state_i            (state_i),
      .level_i            (level_i),
      .frame_count_i      (frame_count_i),
      .frame_cycles_i     (frame_cycles_i),
      .frame_crc_i        (frame_crc_i),
      .frame_crc_pending_i(frame_crc_pending_i),
      .lost_lines_i       (lost_lines_i),
      .lost_acquisitions_i(lost_acquisitions_i),
      .shot_state_i       (shot_state_i),
      .parity_errors_i    (parity_errors_i),
      .self_test_busy_i   (self_test_busy_i),
      .self_test_passed_i (self_test_passed_i),
      .frame_i            (frame_i),
      .underrun_i         (underrun_i),
      .start_ignored_i    (start_ignored_i),
      .illegal_schedule_i (illegal_schedule_i),
      .overrun_i          (overrun_i),
      .short_i            (short_i),
      .long_i             (long_i),
      .timeout_i          (timeout_i),
      .stalled_i          (stalled_i),
      .flush_ignored_i    (flush_ignored_i),
      .parity_error_i     (parity_error_i),
      .self_test_failed_i (self_test_failed_i),
      .aborted_i          (aborted_i),
      .counter_full_i     (counter_full_i),
      .irq_o              (irq)
  );

  // The lowest `number` bits of a word, 0 to 32.
  function automatic logic [31:0] low_bits(input integer number);
    low_bits = (number <= 0) ? 32'd0 : (number >= 32) ? 32'hffffffff : (32'd1 << number) - 32'd1;
  endfunction

  function automatic logic is_template(input logic [11:0] offset);
    is_template = (offset >= dtof_registers_pkg::TEMPLATE) && (offset < dtof_registers_pkg::TEMPLATE + 12'd32);
  endfunction

  function automatic logic is_enable(input logic [11:0] offset);
    is_enable = (offset >= dtof_registers_pkg::COLUMN_ENABLE) && (offset < dtof_registers_pkg::COLUMN_ENABLE + 12'd128);
  endfunction

  // Bits of a register that keep what is written: the settings of this configuration.
  function automatic logic [31:0] kept_bits(input logic [11:0] offset);
    kept_bits = '0;
    case (offset)
      dtof_registers_pkg::CONTROL: kept_bits = 32'h2;
      dtof_registers_pkg::IRQ_ENABLE: kept_bits = 32'h3;
      dtof_registers_pkg::ACQUISITIONS: kept_bits = low_bits(ACQ_WIDTH);
      dtof_registers_pkg::COARSE_END, dtof_registers_pkg::TRACK_END: if (HAS_SCHEDULE != 0) kept_bits = low_bits(ACQ_WIDTH);
      dtof_registers_pkg::WATCHDOG: kept_bits = 32'h00ffffff;
      dtof_registers_pkg::GATE: if (TIME_GATE != 0) kept_bits = (low_bits(NP) << 16) | low_bits(NP);
      dtof_registers_pkg::RELEASE: kept_bits = 32'h0000ffff;
      dtof_registers_pkg::WEAK_BELOW: kept_bits = (CONFIDENCE_WIDTH < 16) ? low_bits(CONFIDENCE_WIDTH + 1) : 32'h0000ffff;
      dtof_registers_pkg::OUTPUT: kept_bits = {26'd0, AMPLITUDE != 0, 1'b1, PRIOR != 0, HAS_SCHEDULE != 0, RAW_HISTOGRAM != 0, SECOND_TARGET != 0};
      dtof_registers_pkg::RAW_ROWS: if (RAW_HISTOGRAM != 0) kept_bits = 32'h0fff0fff;
      dtof_registers_pkg::SHOT: kept_bits = 32'h0000ff07;
      dtof_registers_pkg::SHOT_SEED, dtof_registers_pkg::SETTLE: kept_bits = 32'h0000ffff;
      dtof_registers_pkg::SELF_TEST_SEED, dtof_registers_pkg::SELF_TEST_EXPECTED: if (SELF_TEST != 0) kept_bits = 32'hffffffff;
      default:
      if (is_template(offset)) begin
        if (HAS_SCHEDULE != 0) kept_bits = 32'hffffffff;
      end else if (is_enable(offset)) begin
        kept_bits = low_bits(SRAM_NUM - 8 * (32'(offset) - 32'(dtof_registers_pkg::COLUMN_ENABLE)));
      end
    endcase
  endfunction

  // Bits of which a 1 is a command.
  function automatic logic [31:0] command_bits(input logic [11:0] offset);
    command_bits = (offset == dtof_registers_pkg::CONTROL) ? ((SELF_TEST != 0) ? 32'h1d : 32'hd) : (offset == dtof_registers_pkg::COMMIT) ? 32'h1 : '0;
  endfunction

  function automatic logic is_sticky(input logic [11:0] offset);
    is_sticky = (offset == dtof_registers_pkg::ERROR) || (offset == dtof_registers_pkg::WARNING)
        || (offset == dtof_registers_pkg::IRQ_STATUS);
  endfunction

  function automatic logic [31:0] reset_value(input logic [11:0] offset);
    reset_value = '0;
    case (offset)
      dtof_registers_pkg::WATCHDOG: reset_value = 32'h00ffffff;
      dtof_registers_pkg::GATE: if (TIME_GATE != 0) reset_value = low_bits(NP) << 16;
      dtof_registers_pkg::RELEASE: reset_value = MOST_RELEASE;
      dtof_registers_pkg::OUTPUT: reset_value = (HAS_SCHEDULE != 0) ? 32'h4 : 32'h0;
      dtof_registers_pkg::SHOT: reset_value = 32'h100;
      dtof_registers_pkg::SHOT_SEED: reset_value = 32'h1;
      dtof_registers_pkg::SELF_TEST_SEED: reset_value = (SELF_TEST != 0) ? 32'h1 : 32'h0;
      default: if (is_enable(offset)) reset_value = kept_bits(offset);
    endcase
  endfunction

  // Transfers. A read samples in its setup; if the setup follows a write's access directly, or while a checksum is pending, it samples in a wait
  // state behind the setup.
  logic samples, sampled_q, waits_q, wrote_q, legal_q, access, exists, legal, writes, chosen, starts, commits;
  logic [11:0] offset;
  logic [31:0] bytes, ones;

  assign offset = {paddr_i[11:2], 2'b00};
  assign samples = rst_n && psel_i && (!penable_i || waits_q);
  assign access = rst_n && psel_i && penable_i && sampled_q && !waits_q;
  assign bytes = {{8{pstrb_i[3]}}, {8{pstrb_i[2]}}, {8{pstrb_i[1]}}, {8{pstrb_i[0]}}};
  assign ones = pwdata_i & bytes;
  assign exists = (offset <= 12'h030) || (offset >= 12'h040 && offset <= 12'h14c);

  logic [31:0] may;  // bits that may be written as 1
  assign may = (is_template(offset) && busy_i) ? '0 : kept_bits(offset) | command_bits(offset);
  assign legal = exists && (!pwrite_i || is_sticky(offset) || (may != '0 && (ones & ~may) == '0));
  assign writes = access && pwrite_i && legal_q;
  assign chosen = writes && offset == dtof_registers_pkg::CONTROL && (ones[0] || ones[4]);
  assign starts = chosen && !busy_i && !ones[dtof_registers_pkg::CONTROL_ABORT_LSB];
  assign commits = starts || (writes && offset == dtof_registers_pkg::COMMIT && ones[0]);

  // The watched register: what was written last, and what the last commit made valid.
  (* anyconst *) logic [9:0] watched_word;
  logic [11:0] watched;
  logic [31:0] stored_q, committed_q;
  logic committed_once_q;
  assign watched = {watched_word, 2'b00};

  // An illegal schedule ends continuous mode, unless a write sets CONTINUOUS in the same clock.
  logic [31:0] stays;
  assign stays = (watched == dtof_registers_pkg::CONTROL && illegal_schedule_i) ? '0 : stored_q;

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      stored_q <= reset_value(watched);
      committed_once_q <= 1'b0;
    end else begin
      stored_q <= (writes && offset == watched) ? ((stays & ~bytes) | ones) & kept_bits(watched) : stays;
      if (commits) begin
        committed_q <= stored_q;
        committed_once_q <= 1'b1;
      end
    end
  end

  // Sticky bits and commands.
  logic [9:0] error_events, error_q;
  logic [3:0] warning_events, warning_q;
  logic [1:0] causes, cause_q, cause_enable_q;
  logic start_q, ignored_q, self_test_q, flush_q, abort_q, reseed_q;
  logic failed_q;  // an error in the last clock

  assign error_events = {self_test_failed_i, parity_error_i, flush_ignored_i, stalled_i, timeout_i, short_i || long_i, overrun_i, illegal_schedule_i,
                         start_ignored_i || ignored_q, underrun_i};
  assign warning_events = {long_i, short_i, aborted_i, counter_full_i};
  assign causes = {failed_q, frame_i};

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      error_q <= '0;
      warning_q <= '0;
      cause_q <= '0;
      cause_enable_q <= '0;
      {start_q, ignored_q, self_test_q, flush_q, abort_q, reseed_q, failed_q} <= '0;
    end else begin
      error_q <= error_events | ((writes && offset == dtof_registers_pkg::ERROR) ? error_q & ~ones[9:0] : error_q);
      warning_q <= warning_events | ((writes && offset == dtof_registers_pkg::WARNING) ? warning_q & ~ones[3:0] : warning_q);
      cause_q <= causes | ((writes && offset == dtof_registers_pkg::IRQ_STATUS) ? cause_q & ~ones[1:0] : cause_q);
      if (writes && offset == dtof_registers_pkg::IRQ_ENABLE && pstrb_i[0]) cause_enable_q <= pwdata_i[1:0];
      failed_q <= error_events != '0;
      start_q <= starts;
      ignored_q <= chosen && !starts;
      self_test_q <= starts && ones[4];
      flush_q <= writes && offset == dtof_registers_pkg::CONTROL && ones[2];
      abort_q <= writes && offset == dtof_registers_pkg::CONTROL && ones[3];
      reseed_q <= writes && offset == dtof_registers_pkg::SHOT_SEED && (pstrb_i[0] || pstrb_i[1]);
    end
  end

  // What a read returns of registers that no write changes, or that writes only clear.
  logic is_fixed;
  logic [31:0] fixed;
  always_comb begin
    is_fixed = 1'b1;
    fixed = '0;
    case (offset)
      dtof_registers_pkg::ID: fixed = "DOFP";
      dtof_registers_pkg::VERSION: fixed = dtof_registers_pkg::VERSION_VALUE;
      dtof_registers_pkg::READOUT:
      fixed = {13'd0, AMPLITUDE != 0, SELF_TEST != 0, SOURCE_WAITS != 0, CLOCK_WAITS != 0, PARITY != 0, PRIOR != 0, RAW_HISTOGRAM != 0, SECOND_TARGET != 0,
               RASTER_ORDER != 0, TIME_GATE != 0, HAS_SCHEDULE != 0, 8'd3};
      dtof_registers_pkg::SIZE: fixed = {16'd70, 16'(SRAM_NUM)};
      dtof_registers_pkg::WIDTHS: fixed = {8'(ACQ_WIDTH), 8'(CONFIDENCE_WIDTH), 8'd6, 8'(NP)};
      dtof_registers_pkg::LINES: fixed = {16'd324, 16'd140};
      dtof_registers_pkg::SLOTS: fixed = 32'd2;
      dtof_registers_pkg::RAW_BINS: fixed = 32'd1000;
      dtof_registers_pkg::HISTOGRAM: fixed = {15'd0, WINDOW_CENTRED != 0, 8'd5, 8'd9};
      dtof_registers_pkg::POINTER: fixed = {17'd0, 15'd21};
      dtof_registers_pkg::POOL: if (HAS_SCHEDULE != 0) fixed = {4'd10, 4'd1, 4'd8, 4'd7, 4'd6, 4'd5, 8'd4};
      dtof_registers_pkg::ENGINES: if (HAS_SCHEDULE != 0) fixed = {15'd0, RIVAL_MOVES != 0, 16'd34};
      dtof_registers_pkg::SHARES: if (HAS_SCHEDULE != 0) fixed = {16'd0, 8'd20, 8'd14};
      dtof_registers_pkg::STATUS: fixed = {level_i, 6'd0, self_test_passed_i, self_test_busy_i, 1'b0, state_i, 3'd0, busy_i};
      dtof_registers_pkg::ERROR: fixed = 32'(error_q);
      dtof_registers_pkg::IRQ_STATUS: fixed = 32'(cause_q);
      dtof_registers_pkg::FRAME_COUNT: fixed = frame_count_i;
      dtof_registers_pkg::FRAME_CYCLES: fixed = frame_cycles_i;
      dtof_registers_pkg::WARNING: fixed = 32'(warning_q);
      dtof_registers_pkg::LOST_LINES: fixed = lost_lines_i;
      dtof_registers_pkg::LOST_ACQUISITIONS: fixed = lost_acquisitions_i;
      dtof_registers_pkg::COMMIT: fixed = '0;
      dtof_registers_pkg::SHOT_STATE: fixed = 32'(shot_state_i);
      dtof_registers_pkg::FRAME_CRC: fixed = frame_crc_i;
      dtof_registers_pkg::PARITY_ERRORS: fixed = parity_errors_i;
      default: is_fixed = 1'b0;
    endcase
  end

  // What the setup decides, and the master's request, which stays until its end.
  logic reads_q, requests_q;  // reads_q: the read's result is known; requests_q: a request of the last clock has not ended
  logic [31:0] read_q;
  logic [48:0] request, request_q;
  assign request = {pwrite_i, paddr_i, pwdata_i, pstrb_i};
  always_ff @(posedge clk_i) begin
    sampled_q <= samples;
    waits_q <= samples && (starting || (!pwrite_i && (frame_crc_pending_i || (wrote_q && !waits_q))));
    wrote_q <= writes;
    requests_q <= samples;
    request_q <= request;
    if (samples) begin
      legal_q <= legal;
      reads_q <= !pwrite_i && (is_fixed || (exists && offset == watched));
      read_q <= is_fixed ? fixed : stored_q;
    end
  end

  `ASSUME(m_request_stays, !(rst_n && requests_q) || (psel_i && request == request_q))
  `ASSUME(m_wait_state, !(rst_n && waits_q) || penable_i)
  logic [1:0] pending_q;  // clocks in which the checksum has been pending: at most two
  always_ff @(posedge clk_i) begin
    pending_q <= frame_crc_pending_i ? pending_q + 2'd1 : 2'd0;
  end
  `ASSUME(m_pending, !frame_crc_pending_i || pending_q < 2'd2)

  // The watched register at the outputs: the settings of frames behind a commit, the others at once.
  logic has_output, at_once;
  logic [31:0] shown;
  always_comb begin
    has_output = 1'b1;
    at_once = 1'b0;
    shown = '0;
    case (watched)
      dtof_registers_pkg::CONTROL: {at_once, shown[1]} = {1'b1, continuous};
      dtof_registers_pkg::WATCHDOG: {at_once, shown[23:0]} = {1'b1, watchdog};
      dtof_registers_pkg::SHOT_SEED: {at_once, shown[15:0]} = {1'b1, seed};
      dtof_registers_pkg::SELF_TEST_SEED: {at_once, shown} = {1'b1, test_seed};
      dtof_registers_pkg::SELF_TEST_EXPECTED: {at_once, shown} = {1'b1, test_expected};
      dtof_registers_pkg::ACQUISITIONS: shown = 32'(acquisitions);
      dtof_registers_pkg::COARSE_END: shown = 32'(coarse_end);
      dtof_registers_pkg::TRACK_END: shown = 32'(track_end);
      dtof_registers_pkg::GATE: shown = {16'(gate_end), 16'(gate_begin)};
      dtof_registers_pkg::RELEASE: shown = 32'(release_lines);
      dtof_registers_pkg::WEAK_BELOW: shown = 32'(weak_below);
      dtof_registers_pkg::OUTPUT: shown = {26'd0, amplitude, short_words, prior, smooth, raw, second};
      dtof_registers_pkg::RAW_ROWS: shown = {4'd0, raw_last, 4'd0, raw_first};
      dtof_registers_pkg::SHOT: shown = {16'd0, shot_unit, 5'd0, shot_bits};
      dtof_registers_pkg::SETTLE: shown = 32'(settle);
      default:
      if (is_template(watched)) begin
        at_once = 1'b1;
        shown = 32'(coarse_template >> (8 * (32'(watched) - 32'(dtof_registers_pkg::TEMPLATE))));
      end else if (is_enable(watched)) begin
        shown = 32'(enable >> (8 * (32'(watched) - 32'(dtof_registers_pkg::COLUMN_ENABLE))));
      end else begin
        has_output = 1'b0;
      end
    endcase
  end

  apb_rules #(
      .MOST_WAITS(3 + 32'(STARTING_CLOCKS))
  ) u_apb_rules (
      .clk_i    (clk_i),
      .rst_ni   (rst_n),
      .checking (checking),
      .psel_i   (psel_i),
      .penable_i(penable_i),
      .pwrite_i (pwrite_i),
      .paddr_i  (paddr_i),
      .pwdata_i (pwdata_i),
      .pstrb_i  (pstrb_i),
      .pready_i (pready),
      .pslverr_i(pslverr)
  );

  `PROVE(a_ready, !rst_n || pready == !waits_q)
  `PROVE(a_error, !rst_n || pslverr == (psel_i && penable_i && !waits_q && !(sampled_q && legal_q)))
  `PROVE(a_read, !(access && !pwrite_i && reads_q) || prdata == read_q)
  `PROVE(a_at_once, !(rst_n && has_output && at_once) || shown == stored_q)
  `PROVE(a_committed, !(rst_n && has_output && !at_once && committed_once_q) || shown == committed_q)
  `PROVE(a_commands, !rst_n || {start, self_test, flush, abort, reseed} == {start_q, self_test_q, flush_q, abort_q, reseed_q})
  `PROVE(a_irq, !rst_n || irq == ((cause_q & cause_enable_q) != '0))
  `GOAL(rst_n && committed_once_q && watched == dtof_registers_pkg::ACQUISITIONS && committed_q != stored_q && committed_q != '0
        && error_q[3:0] == 4'b1010 && cause_q[1] && irq && access && !pwrite_i && offset == watched)

endmodule

`default_nettype wire
