// SPDX-License-Identifier: Apache-2.0
// The registers of dtof_subsystem behind an APB4 port (hdl/subsystem/registers.toml; table in docs/user/integration.md).
//
// A transfer takes two clocks; a read may have up to three wait states, and every transfer waits while starting_i is high. pslverr_o reports
// an access to an offset without a register, a write to a register without a writable bit in this configuration, and a write of 1 to a bit
// of a setting or command that this configuration does not have. Such an access writes nothing. pstrb_i selects bytes; there is no pprot.
// Settings become valid together, with COMMIT, START or a self-test. CONTROL, IRQ_ENABLE, WATCHDOG, SHOT_SEED, SELF_TEST_SEED and
// SELF_TEST_EXPECTED are valid at once. If software clears a bit in the clock of a new event, the bit stays set.
// Schedule: clock 0 is APB's setup, in which a read samples; clock 1 is its access, with prdata_o from flip-flops. A write takes effect at the end
// of clock 1. A read has a wait state, and samples in its last one, if its setup directly follows a write's access, so that it sees what the write
// has done, and while the checksum of a frame's end is pending. irq_o shows an error one clock after ERROR. An access without a setup is refused.
// Latency: a command is a pulse in the clock after its write; a committed setting is at its output in the clock after the commit.
// Cost: two flip-flops per bit of a setting, SRAM_NUM such bits for the columns, and the read multiplexer.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_apb_registers #(
    parameter int READOUT = 0,
    parameter int HAS_SCHEDULE = 0,
    parameter int TIME_GATE = 0,
    parameter int RASTER_ORDER = 0,
    parameter int PARITY = 0,
    parameter int SELF_TEST = 0,
    parameter int CLOCK_WAITS = 1,
    parameter int SOURCE_WAITS = 1,
    parameter int SECOND_TARGET = 0,
    parameter int AMPLITUDE = 0,
    parameter int PRIOR = 0,
    parameter int RAW_HISTOGRAM = 0,
    parameter int RAW_BINS = 0,
    parameter int NP = 10,
    parameter int SRAM_NUM = 200,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SLOTS = 2,
    parameter int FRACTION_WIDTH = 0,
    parameter int CONFIDENCE_WIDTH = 4,
    parameter int ACQ_WIDTH = 16,
    // constants that software reads; from GROUP_SIZE on they read as 0 without HAS_SCHEDULE
    parameter int COUNT_WIDTH = 10,
    parameter int NB = 5,
    parameter int WINDOW_CENTRED = 0,
    parameter int POINTER_STEP = 1,
    parameter int GUARD = 0,
    parameter int GROUP_SIZE = 4,
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int CELL_SHIFT = 9,
    parameter int RIVAL_MOVES = 1,
    parameter int ENGINE_COLUMNS = 34,
    parameter int COARSE_SHARE = 14,
    parameter int TRACK_SHARE = 30,
    parameter int BUFFER_LINES = 324,
    parameter int MOST_RELEASE = 320
) (
    input  logic                 clk_i,
    input  logic                 rst_ni,
    // APB4
    input  logic                 starting_i,     // the array's reset after rst_ni is not over yet
    input  logic                 psel_i,
    input  logic                 penable_i,
    input  logic                 pwrite_i,
    input  logic [         11:0] paddr_i,
    input  logic [         31:0] pwdata_i,
    input  logic [          3:0] pstrb_i,
    output logic                 pready_o,
    output logic [         31:0] prdata_o,
    output logic                 pslverr_o,
    // commands and settings
    output logic                 start_o,
    output logic                 self_test_o,    // with start_o: the frame is a self-test; 0 without SELF_TEST
    output logic                 flush_o,
    output logic                 abort_o,
    output logic                 continuous_o,
    output logic [         23:0] watchdog_o,
    output logic [         15:0] shot_seed_o,
    output logic                 shot_reseed_o,  // in the clock after a write of SHOT_SEED
    output logic [         31:0] self_test_seed_o,      // self_test_seed_o and self_test_expected_o are 0 without SELF_TEST
    output logic [         31:0] self_test_expected_o,
    // committed settings
    output logic                 second_o,       // 0 without SECOND_TARGET
    output logic                 amplitude_o,    // 0 without AMPLITUDE
    output logic                 raw_o,          // raw_o, raw_first_o and raw_last_o are 0 without RAW_HISTOGRAM
    output logic [         11:0] raw_first_o,
    output logic [         11:0] raw_last_o,
    output logic [ACQ_WIDTH-1:0] acquisitions_o,
    output logic [ACQ_WIDTH-1:0] coarse_end_o,   // coarse_end_o, track_end_o and smooth_o are 0 without HAS_SCHEDULE
    output logic [ACQ_WIDTH-1:0] track_end_o,
    output logic                 smooth_o,
    output logic [        255:0] template_o,     // written without a commit; writable only while busy_i is low; 0 without HAS_SCHEDULE
    output logic                 prior_o,        // 0 without PRIOR
    output logic                 short_words_o,
    output logic [       NP-1:0] gate_begin_o,   // gate_begin_o and gate_end_o are 0 without TIME_GATE
    output logic [       NP-1:0] gate_end_o,
    output logic [         15:0] release_o,
    output logic [         15:0] weak_below_o,
    output logic [ SRAM_NUM-1:0] enable_o,
    output logic [          2:0] shot_bits_o,
    output logic [          7:0] shot_unit_o,
    output logic [         15:0] settle_o,
    // status
    input  logic                 busy_i,
    input  logic [          2:0] state_i,
    input  logic [         15:0] level_i,
    input  logic [         31:0] frame_count_i,
    input  logic [         31:0] frame_cycles_i,
    input  logic [         31:0] frame_crc_i,
    input  logic                 frame_crc_pending_i,  // frame_crc_i follows at once: reads wait
    input  logic [         31:0] lost_lines_i,
    input  logic [         31:0] lost_acquisitions_i,
    input  logic [         15:0] shot_state_i,
    input  logic [         31:0] parity_errors_i,
    input  logic                 self_test_busy_i,
    input  logic                 self_test_passed_i,
    // events
    input  logic                 frame_i,
    input  logic                 underrun_i,
    input  logic                 start_ignored_i,
    input  logic                 illegal_schedule_i,
    input  logic                 overrun_i,
    input  logic                 short_i,
    input  logic                 long_i,
    input  logic                 timeout_i,
    input  logic                 stalled_i,
    input  logic                 flush_ignored_i,
    input  logic                 parity_error_i,
    input  logic                 self_test_failed_i,
    input  logic                 aborted_i,
    input  logic                 counter_full_i,
    output logic                 irq_o
);

  localparam int ERRORS = 10;
  localparam int WARNINGS = 4;
  localparam int CAUSES = 2;  // causes of an interrupt
  localparam int WEAK_WIDTH = dtof_pkg::min_of(CONFIDENCE_WIDTH + 1, 16);

  // What a transfer may do is decided in its setup, in which all its signals are valid.

  logic setup, access, armed_q, waits_q, wrote_q, writable_q, refused_q, known, writable, write, starts, commit;
  logic [11:0] offset;
  logic [31:0] mask;     // bits that pstrb_i selects
  logic [31:0] written;  // selected bits that are written as 1
  logic [31:0] there;    // bits that a write of 1 may set: fields of this configuration, or all bits where a 1 has no effect

  assign offset = {paddr_i[11:2], 2'b00};
  assign setup = psel_i && (!penable_i || waits_q);  // also in a wait state, in which a read samples again
  assign access = psel_i && penable_i && armed_q && !waits_q;
  assign known = dtof_registers_pkg::is_register(offset);
  assign writable = dtof_registers_pkg::is_writable(offset) && (there != '0) && ((written & ~there) == '0);
  assign write = access && pwrite_i && writable_q;
  assign mask = {{8{pstrb_i[3]}}, {8{pstrb_i[2]}}, {8{pstrb_i[1]}}, {8{pstrb_i[0]}}};

  assign written = pwdata_i & mask;
  assign starts = write && (offset == dtof_registers_pkg::CONTROL)
      && (written[dtof_registers_pkg::CONTROL_START_LSB] || written[dtof_registers_pkg::CONTROL_SELF_TEST_LSB]);
  assign commit = starts || (write && offset == dtof_registers_pkg::COMMIT && written[dtof_registers_pkg::COMMIT_SETTINGS_LSB]);

  logic unused_address;
  assign unused_address = ^paddr_i[1:0];

  logic [31:0] read_data, read_data_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      armed_q <= 1'b0;
      waits_q <= 1'b0;
      wrote_q <= 1'b0;
    end else begin
      armed_q <= setup;
      waits_q <= setup && (starting_i || (!pwrite_i && (frame_crc_pending_i || (!penable_i && wrote_q))));
      wrote_q <= write;
    end
  end

  always_ff @(posedge clk_i) begin
    if (setup) begin
      read_data_q <= read_data;
      writable_q <= writable;
      refused_q <= pwrite_i ? !writable : !known;
    end
  end

  assign pready_o = !waits_q;
  assign pslverr_o = psel_i && penable_i && !waits_q && (refused_q || !armed_q);
  assign prdata_o = read_data_q;

  // Commands, settings, and flags that events set.

  logic start_q, flush_q, abort_q, continuous_q;
  logic [ERRORS-1:0] error_q, error_event, error_event_q, error_cleared;
  logic [WARNINGS-1:0] warning_q, warning_event, warning_cleared;
  logic [23:0] watchdog_q;
  logic [CAUSES-1:0] cause_q, cause_event, cause_cleared, cause_enable_q;
  logic [ACQ_WIDTH-1:0] acquisitions_q;
  logic [15:0] release_q;
  logic [WEAK_WIDTH-1:0] weak_below_q;
  logic [2:0] shot_bits_q;
  logic [7:0] shot_unit_q;
  logic [15:0] shot_seed_q;
  logic [15:0] settle_q;
  logic shot_reseed_q;
  logic short_words_q;
  logic [SRAM_NUM-1:0] enable_q;

  always_comb begin
    error_event = '0;
    error_event[dtof_registers_pkg::ERROR_UNDERRUN_LSB] = underrun_i;
    error_event[dtof_registers_pkg::ERROR_START_IGNORED_LSB] = start_ignored_i;
    error_event[dtof_registers_pkg::ERROR_ILLEGAL_SCHEDULE_LSB] = illegal_schedule_i;
    error_event[dtof_registers_pkg::ERROR_OVERRUN_LSB] = overrun_i;
    error_event[dtof_registers_pkg::ERROR_MISFRAMED_LSB] = short_i || long_i;
    error_event[dtof_registers_pkg::ERROR_TIMEOUT_LSB] = timeout_i;
    error_event[dtof_registers_pkg::ERROR_STALLED_LSB] = stalled_i;
    error_event[dtof_registers_pkg::ERROR_FLUSH_IGNORED_LSB] = flush_ignored_i;
    error_event[dtof_registers_pkg::ERROR_PARITY_LSB] = parity_error_i;
    error_event[dtof_registers_pkg::ERROR_SELF_TEST_LSB] = self_test_failed_i;
    warning_event = '0;
    warning_event[dtof_registers_pkg::WARNING_COUNTER_FULL_LSB] = counter_full_i;
    warning_event[dtof_registers_pkg::WARNING_ABORTED_LSB] = aborted_i;
    warning_event[dtof_registers_pkg::WARNING_SHORT_LSB] = short_i;
    warning_event[dtof_registers_pkg::WARNING_LONG_LSB] = long_i;
    cause_event = '0;
    cause_event[dtof_registers_pkg::IRQ_STATUS_FRAME_LSB] = frame_i;
    cause_event[dtof_registers_pkg::IRQ_STATUS_ERROR_LSB] = |error_event_q;
  end

  assign error_cleared = (write && offset == dtof_registers_pkg::ERROR) ? written[ERRORS-1:0] : '0;
  assign cause_cleared = (write && offset == dtof_registers_pkg::IRQ_STATUS) ? written[CAUSES-1:0] : '0;

  assign warning_cleared = (write && offset == dtof_registers_pkg::WARNING) ? written[WARNINGS-1:0] : '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      start_q <= 1'b0;
      flush_q <= 1'b0;
      abort_q <= 1'b0;
      continuous_q <= 1'b0;
      error_q <= '0;
      error_event_q <= '0;
      cause_q <= '0;
      warning_q <= '0;
      watchdog_q <= 24'(dtof_registers_pkg::WATCHDOG_RESET);
      cause_enable_q <= '0;
      acquisitions_q <= '0;
      release_q <= 16'(MOST_RELEASE);
      weak_below_q <= '0;
      shot_bits_q <= dtof_registers_pkg::SHOT_RESET[dtof_registers_pkg::SHOT_BITS_LSB+:3];
      shot_unit_q <= dtof_registers_pkg::SHOT_RESET[dtof_registers_pkg::SHOT_UNIT_LSB+:8];
      shot_seed_q <= 16'(dtof_registers_pkg::SHOT_SEED_RESET);
      shot_reseed_q <= 1'b0;
      settle_q <= '0;
      short_words_q <= 1'b0;
    end else begin
      start_q <= starts;
      flush_q <= write && (offset == dtof_registers_pkg::CONTROL) && written[dtof_registers_pkg::CONTROL_FLUSH_LSB];
      abort_q <= write && (offset == dtof_registers_pkg::CONTROL) && written[dtof_registers_pkg::CONTROL_ABORT_LSB];
      shot_reseed_q <= write && (offset == dtof_registers_pkg::SHOT_SEED) && (pstrb_i[1:0] != '0);
      error_q <= (error_q & ~error_cleared) | error_event;
      error_event_q <= error_event;
      cause_q <= (cause_q & ~cause_cleared) | cause_event;
      warning_q <= (warning_q & ~warning_cleared) | warning_event;
      if (illegal_schedule_i) begin
        continuous_q <= 1'b0;
      end
      if (write) begin
        case (offset)
          dtof_registers_pkg::CONTROL:
          if (mask[dtof_registers_pkg::CONTROL_CONTINUOUS_LSB]) begin
            continuous_q <= written[dtof_registers_pkg::CONTROL_CONTINUOUS_LSB];
          end
          dtof_registers_pkg::IRQ_ENABLE:
          cause_enable_q <= (cause_enable_q & ~mask[CAUSES-1:0]) | written[CAUSES-1:0];
          dtof_registers_pkg::WATCHDOG: watchdog_q <= (watchdog_q & ~mask[23:0]) | written[23:0];
          dtof_registers_pkg::ACQUISITIONS:
          acquisitions_q <= (acquisitions_q & ~mask[ACQ_WIDTH-1:0]) | written[ACQ_WIDTH-1:0];
          dtof_registers_pkg::RELEASE:
          release_q <= (release_q & ~mask[15:0]) | written[15:0];
          dtof_registers_pkg::WEAK_BELOW:
          weak_below_q <= (weak_below_q & ~mask[WEAK_WIDTH-1:0]) | written[WEAK_WIDTH-1:0];
          dtof_registers_pkg::SHOT: begin
            shot_bits_q <= (shot_bits_q & ~mask[dtof_registers_pkg::SHOT_BITS_LSB+:3])
                | written[dtof_registers_pkg::SHOT_BITS_LSB+:3];
            shot_unit_q <= (shot_unit_q & ~mask[dtof_registers_pkg::SHOT_UNIT_LSB+:8])
                | written[dtof_registers_pkg::SHOT_UNIT_LSB+:8];
          end
          dtof_registers_pkg::SHOT_SEED: shot_seed_q <= (shot_seed_q & ~mask[15:0]) | written[15:0];
          dtof_registers_pkg::SETTLE: settle_q <= (settle_q & ~mask[15:0]) | written[15:0];
          dtof_registers_pkg::OUTPUT:
          if (mask[dtof_registers_pkg::OUTPUT_SHORT_WORDS_LSB]) begin
            short_words_q <= written[dtof_registers_pkg::OUTPUT_SHORT_WORDS_LSB];
          end
          default: begin
          end
        endcase
      end
    end
  end

  assign start_o = start_q;
  assign flush_o = flush_q;
  assign abort_o = abort_q;
  assign continuous_o = continuous_q;
  assign watchdog_o = watchdog_q;
  assign shot_seed_o = shot_seed_q;
  assign shot_reseed_o = shot_reseed_q;
  assign irq_o = |(cause_q & cause_enable_q);

  // Settings that not every configuration has.

  logic second, amplitude, raw, smooth, prior;
  logic [11:0] raw_first, raw_last;
  logic [ACQ_WIDTH-1:0] coarse_end, track_end;
  logic [NP-1:0] gate_begin, gate_end;

  generate
    if (HAS_SCHEDULE != 0) begin : g_schedule
      logic [ACQ_WIDTH-1:0] coarse_end_q, track_end_q;
      logic smooth_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          coarse_end_q <= '0;
          track_end_q <= '0;
          smooth_q <= 1'b1;
        end else if (write) begin
          case (offset)
            dtof_registers_pkg::COARSE_END:
            coarse_end_q <= (coarse_end_q & ~mask[ACQ_WIDTH-1:0]) | written[ACQ_WIDTH-1:0];
            dtof_registers_pkg::TRACK_END:
            track_end_q <= (track_end_q & ~mask[ACQ_WIDTH-1:0]) | written[ACQ_WIDTH-1:0];
            dtof_registers_pkg::OUTPUT:
            if (mask[dtof_registers_pkg::OUTPUT_SMOOTH_LSB]) begin
              smooth_q <= written[dtof_registers_pkg::OUTPUT_SMOOTH_LSB];
            end
            default: begin
            end
          endcase
        end
      end
      assign coarse_end = coarse_end_q;
      assign track_end = track_end_q;
      assign smooth = smooth_q;
    end else begin : g_no_schedule
      assign coarse_end = '0;
      assign track_end = '0;
      assign smooth = 1'b0;
    end

    if (TIME_GATE != 0) begin : g_gate
      localparam int BEGIN_LSB = dtof_registers_pkg::GATE_BEGIN_LSB;
      localparam int END_LSB = dtof_registers_pkg::GATE_END_LSB;
      logic [NP-1:0] gate_begin_q, gate_end_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          gate_begin_q <= '0;
          gate_end_q <= {NP{1'b1}};
        end else if (write && offset == dtof_registers_pkg::GATE) begin
          gate_begin_q <= (gate_begin_q & ~mask[BEGIN_LSB+:NP]) | written[BEGIN_LSB+:NP];
          gate_end_q <= (gate_end_q & ~mask[END_LSB+:NP]) | written[END_LSB+:NP];
        end
      end
      assign gate_begin = gate_begin_q;
      assign gate_end = gate_end_q;
    end else begin : g_no_gate
      assign gate_begin = '0;
      assign gate_end = '0;
    end

    if (SELF_TEST != 0) begin : g_self_test
      logic self_test_q;
      logic [31:0] seed_q, expected_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          self_test_q <= 1'b0;
          seed_q <= 32'd1;
          expected_q <= '0;
        end else begin
          self_test_q <= starts && written[dtof_registers_pkg::CONTROL_SELF_TEST_LSB];
          if (write && offset == dtof_registers_pkg::SELF_TEST_SEED) begin
            seed_q <= (seed_q & ~mask) | written;
          end
          if (write && offset == dtof_registers_pkg::SELF_TEST_EXPECTED) begin
            expected_q <= (expected_q & ~mask) | written;
          end
        end
      end
      assign self_test_o = self_test_q;
      assign self_test_seed_o = seed_q;
      assign self_test_expected_o = expected_q;
    end else begin : g_no_self_test
      assign self_test_o = 1'b0;
      assign self_test_seed_o = '0;
      assign self_test_expected_o = '0;
    end

    if (SECOND_TARGET != 0) begin : g_second_target
      logic second_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          second_q <= 1'b0;
        end else if (write && offset == dtof_registers_pkg::OUTPUT
                     && mask[dtof_registers_pkg::OUTPUT_SECOND_TARGET_LSB]) begin
          second_q <= written[dtof_registers_pkg::OUTPUT_SECOND_TARGET_LSB];
        end
      end
      assign second = second_q;
    end else begin : g_one_target
      assign second = 1'b0;
    end

    if (AMPLITUDE != 0) begin : g_amplitude
      logic amplitude_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          amplitude_q <= 1'b0;
        end else if (write && offset == dtof_registers_pkg::OUTPUT && mask[dtof_registers_pkg::OUTPUT_AMPLITUDE_LSB]) begin
          amplitude_q <= written[dtof_registers_pkg::OUTPUT_AMPLITUDE_LSB];
        end
      end
      assign amplitude = amplitude_q;
    end else begin : g_no_amplitude
      assign amplitude = 1'b0;
    end

    if (PRIOR != 0) begin : g_prior
      logic prior_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          prior_q <= 1'b0;
        end else if (write && offset == dtof_registers_pkg::OUTPUT && mask[dtof_registers_pkg::OUTPUT_PRIOR_LSB]) begin
          prior_q <= written[dtof_registers_pkg::OUTPUT_PRIOR_LSB];
        end
      end
      assign prior = prior_q;
    end else begin : g_no_prior
      assign prior = 1'b0;
    end

    if (RAW_HISTOGRAM != 0) begin : g_raw_histogram
      localparam int FIRST_LSB = dtof_registers_pkg::RAW_ROWS_FIRST_LSB;
      localparam int LAST_LSB = dtof_registers_pkg::RAW_ROWS_LAST_LSB;
      logic raw_q;
      logic [11:0] raw_first_q, raw_last_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          raw_q <= 1'b0;
          raw_first_q <= '0;
          raw_last_q <= '0;
        end else if (write && offset == dtof_registers_pkg::OUTPUT && mask[dtof_registers_pkg::OUTPUT_RAW_LSB]) begin
          raw_q <= written[dtof_registers_pkg::OUTPUT_RAW_LSB];
        end else if (write && offset == dtof_registers_pkg::RAW_ROWS) begin
          raw_first_q <= (raw_first_q & ~mask[FIRST_LSB+:12]) | written[FIRST_LSB+:12];
          raw_last_q <= (raw_last_q & ~mask[LAST_LSB+:12]) | written[LAST_LSB+:12];
        end
      end
      assign raw = raw_q;
      assign raw_first = raw_first_q;
      assign raw_last = raw_last_q;
    end else begin : g_no_raw_histogram
      assign raw = 1'b0;
      assign raw_first = '0;
      assign raw_last = '0;
    end
  endgenerate

  // The register at TEMPLATE + 4 k has entries 4 k to 4 k + 3.

  localparam int TEMPLATE_WORDS = 8;
  logic is_template;
  assign is_template = (offset >= dtof_registers_pkg::TEMPLATE)
      && (offset < dtof_registers_pkg::TEMPLATE + 12'(4 * TEMPLATE_WORDS));

  genvar w;
  generate
    for (w = 0; w < TEMPLATE_WORDS; w = w + 1) begin : g_template
      localparam logic [11:0] OFFSET = dtof_registers_pkg::TEMPLATE + 12'(4 * w);
      if (HAS_SCHEDULE != 0) begin : g_word
        logic [31:0] word_q;
        always_ff @(posedge clk_i or negedge rst_ni) begin
          if (!rst_ni) begin
            word_q <= '0;
          end else if (write && offset == OFFSET) begin
            word_q <= (word_q & ~mask) | written;
          end
        end
        assign template_o[32*w+:32] = word_q;
      end else begin : g_no_word
        assign template_o[32*w+:32] = '0;
      end
    end
  endgenerate

  localparam logic [2:0] FIRST_TEMPLATE_WORD = 3'(dtof_registers_pkg::TEMPLATE >> 2);
  logic [2:0] template_index;
  logic [31:0] template_word;
  assign template_index = offset[4:2] - FIRST_TEMPLATE_WORD;
  assign template_word = template_o[32*template_index+:32];

  // Columns: the register at COLUMN_ENABLE + 4 k has columns from 32 k on.

  localparam int ENABLE_WORDS = (SRAM_NUM + 31) / 32;
  logic [32*ENABLE_WORDS-1:0] enable_words;
  assign enable_words = (32 * ENABLE_WORDS)'(enable_q);

  generate
    for (w = 0; w < ENABLE_WORDS; w = w + 1) begin : g_enable
      localparam int FIRST = 32 * w;
      localparam int BITS = dtof_pkg::min_of(32, SRAM_NUM - FIRST);
      localparam logic [11:0] OFFSET = dtof_registers_pkg::COLUMN_ENABLE + 12'(4 * w);
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          enable_q[FIRST+:BITS] <= {BITS{1'b1}};
        end else if (write && offset == OFFSET) begin
          enable_q[FIRST+:BITS] <= (enable_q[FIRST+:BITS] & ~mask[BITS-1:0]) | written[BITS-1:0];
        end
      end
    end
  endgenerate

  localparam int ENABLE_INDEX_WIDTH = dtof_pkg::index_width(ENABLE_WORDS);
  logic [9:0] enable_index;
  logic [31:0] enable_word;
  assign enable_index = offset[11:2] - 10'(dtof_registers_pkg::COLUMN_ENABLE >> 2);
  assign enable_word = (32'(enable_index) < ENABLE_WORDS)
      ? enable_words[32*enable_index[ENABLE_INDEX_WIDTH-1:0]+:32] : '0;

  // Committed settings. They need no reset, because no frame begins before START, which commits.

  always_ff @(posedge clk_i) begin
    if (commit) begin
      acquisitions_o <= acquisitions_q;
      coarse_end_o <= coarse_end;
      track_end_o <= track_end;
      smooth_o <= smooth;
      prior_o <= prior;
      second_o <= second;
      amplitude_o <= amplitude;
      raw_o <= raw;
      raw_first_o <= raw_first;
      raw_last_o <= raw_last;
      gate_begin_o <= gate_begin;
      gate_end_o <= gate_end;
      release_o <= release_q;
      weak_below_o <= 16'(weak_below_q);
      enable_o <= enable_q;
      shot_bits_o <= shot_bits_q;
      shot_unit_o <= shot_unit_q;
      short_words_o <= short_words_q;
      settle_o <= settle_q;
    end
  end

  // Bits that can be written.

  localparam logic [31:0] ACQ_BITS = 32'hffffffff >> (32 - ACQ_WIDTH);
  localparam logic [31:0] NP_BITS = 32'hffffffff >> (32 - NP);
  localparam logic [31:0] ROWS_BITS = (32'hfff << dtof_registers_pkg::RAW_ROWS_FIRST_LSB)
      | (32'hfff << dtof_registers_pkg::RAW_ROWS_LAST_LSB);
  localparam logic [31:0] SHOT_FIELDS = (32'h7 << dtof_registers_pkg::SHOT_BITS_LSB) | (32'hff << dtof_registers_pkg::SHOT_UNIT_LSB);
  localparam logic [31:0] CONTROL_BITS = (32'd1 << dtof_registers_pkg::CONTROL_START_LSB)
      | (32'd1 << dtof_registers_pkg::CONTROL_CONTINUOUS_LSB) | (32'd1 << dtof_registers_pkg::CONTROL_FLUSH_LSB)
      | (32'd1 << dtof_registers_pkg::CONTROL_ABORT_LSB)
      | (((SELF_TEST != 0) ? 32'd1 : 32'd0) << dtof_registers_pkg::CONTROL_SELF_TEST_LSB);
  localparam logic [31:0] OUTPUT_BITS =
      (((SECOND_TARGET != 0) ? 32'd1 : 32'd0) << dtof_registers_pkg::OUTPUT_SECOND_TARGET_LSB)
      | (((RAW_HISTOGRAM != 0) ? 32'd1 : 32'd0) << dtof_registers_pkg::OUTPUT_RAW_LSB)
      | (((HAS_SCHEDULE != 0) ? 32'd1 : 32'd0) << dtof_registers_pkg::OUTPUT_SMOOTH_LSB)
      | (((AMPLITUDE != 0) ? 32'd1 : 32'd0) << dtof_registers_pkg::OUTPUT_AMPLITUDE_LSB)
      | (((PRIOR != 0) ? 32'd1 : 32'd0) << dtof_registers_pkg::OUTPUT_PRIOR_LSB)
      | (32'd1 << dtof_registers_pkg::OUTPUT_SHORT_WORDS_LSB);
  localparam logic [31:0] LAST_COLUMNS = 32'hffffffff >> (32 * ENABLE_WORDS - SRAM_NUM);

  always_comb begin
    there = 32'hffffffff;
    case (offset)
      dtof_registers_pkg::CONTROL: there = CONTROL_BITS;
      dtof_registers_pkg::IRQ_ENABLE: there = 32'hffffffff >> (32 - CAUSES);
      dtof_registers_pkg::ACQUISITIONS: there = ACQ_BITS;
      dtof_registers_pkg::COARSE_END, dtof_registers_pkg::TRACK_END: there = (HAS_SCHEDULE != 0) ? ACQ_BITS : '0;
      dtof_registers_pkg::WATCHDOG: there = 32'h00ffffff;
      dtof_registers_pkg::GATE:
      there = (TIME_GATE == 0) ? '0
          : (NP_BITS << dtof_registers_pkg::GATE_BEGIN_LSB) | (NP_BITS << dtof_registers_pkg::GATE_END_LSB);
      dtof_registers_pkg::RELEASE: there = 32'h0000ffff;
      dtof_registers_pkg::WEAK_BELOW: there = 32'hffffffff >> (32 - WEAK_WIDTH);
      dtof_registers_pkg::OUTPUT: there = OUTPUT_BITS;
      dtof_registers_pkg::RAW_ROWS: there = (RAW_HISTOGRAM != 0) ? ROWS_BITS : '0;
      dtof_registers_pkg::SHOT: there = SHOT_FIELDS;
      dtof_registers_pkg::SHOT_SEED: there = 32'h0000ffff;
      dtof_registers_pkg::SETTLE: there = 32'h0000ffff;
      dtof_registers_pkg::SELF_TEST_SEED, dtof_registers_pkg::SELF_TEST_EXPECTED: there = (SELF_TEST != 0) ? 32'hffffffff : '0;
      dtof_registers_pkg::COMMIT: there = 32'd1 << dtof_registers_pkg::COMMIT_SETTINGS_LSB;
      default:
      if (is_template) begin
        there = (HAS_SCHEDULE != 0 && !busy_i) ? 32'hffffffff : '0;
      end else if (offset >= dtof_registers_pkg::COLUMN_ENABLE) begin
        there = (32'(enable_index) == ENABLE_WORDS - 1) ? LAST_COLUMNS
            : (32'(enable_index) >= ENABLE_WORDS) ? '0 : 32'hffffffff;
      end
    endcase
  end

  // Read data.

  always_comb begin
    read_data = '0;
    case (offset)
      dtof_registers_pkg::ID: read_data = dtof_registers_pkg::ID_VALUE;
      dtof_registers_pkg::VERSION: read_data = dtof_registers_pkg::VERSION_VALUE;
      dtof_registers_pkg::READOUT: begin
        read_data[dtof_registers_pkg::READOUT_NUMBER_LSB+:8] = 8'(READOUT);
        read_data[dtof_registers_pkg::READOUT_SCHEDULE_LSB] = (HAS_SCHEDULE != 0);
        read_data[dtof_registers_pkg::READOUT_TIME_GATE_LSB] = (TIME_GATE != 0);
        read_data[dtof_registers_pkg::READOUT_RASTER_ORDER_LSB] = (RASTER_ORDER != 0);
        read_data[dtof_registers_pkg::READOUT_SECOND_TARGET_LSB] = (SECOND_TARGET != 0);
        read_data[dtof_registers_pkg::READOUT_PRIOR_LSB] = (PRIOR != 0);
        read_data[dtof_registers_pkg::READOUT_AMPLITUDE_LSB] = (AMPLITUDE != 0);
        read_data[dtof_registers_pkg::READOUT_PARITY_LSB] = (PARITY != 0);
        read_data[dtof_registers_pkg::READOUT_SELF_TEST_LSB] = (SELF_TEST != 0);
        read_data[dtof_registers_pkg::READOUT_CLOCK_WAITS_LSB] = (CLOCK_WAITS != 0);
        read_data[dtof_registers_pkg::READOUT_SOURCE_WAITS_LSB] = (SOURCE_WAITS != 0);
        read_data[dtof_registers_pkg::READOUT_RAW_HISTOGRAM_LSB] = (RAW_HISTOGRAM != 0);
      end
      dtof_registers_pkg::SIZE: begin
        read_data[dtof_registers_pkg::SIZE_COLUMNS_LSB+:16] = 16'(SRAM_NUM);
        read_data[dtof_registers_pkg::SIZE_ROWS_LSB+:16] = 16'(PIXELS_PER_SRAM);
      end
      dtof_registers_pkg::WIDTHS: begin
        read_data[dtof_registers_pkg::WIDTHS_TIMESTAMP_LSB+:8] = 8'(NP);
        read_data[dtof_registers_pkg::WIDTHS_FRACTION_LSB+:8] = 8'(FRACTION_WIDTH);
        read_data[dtof_registers_pkg::WIDTHS_CONFIDENCE_LSB+:8] = 8'(CONFIDENCE_WIDTH);
        read_data[dtof_registers_pkg::WIDTHS_ACQUISITIONS_LSB+:8] = 8'(ACQ_WIDTH);
      end
      dtof_registers_pkg::LINES: begin
        read_data[dtof_registers_pkg::LINES_ACQUISITION_LSB+:16] = 16'(PIXELS_PER_SRAM * SLOTS);
        read_data[dtof_registers_pkg::LINES_BUFFER_LSB+:16] = 16'(BUFFER_LINES);
      end
      dtof_registers_pkg::SLOTS: read_data[dtof_registers_pkg::SLOTS_VALUE_LSB+:8] = 8'(SLOTS);
      dtof_registers_pkg::RAW_BINS: read_data[dtof_registers_pkg::RAW_BINS_VALUE_LSB+:17] = 17'(RAW_BINS);
      dtof_registers_pkg::HISTOGRAM: begin
        read_data[dtof_registers_pkg::HISTOGRAM_COUNT_WIDTH_LSB+:8] = 8'(COUNT_WIDTH);
        read_data[dtof_registers_pkg::HISTOGRAM_NB_LSB+:8] = 8'(NB);
        read_data[dtof_registers_pkg::HISTOGRAM_WINDOW_CENTRED_LSB] = (WINDOW_CENTRED != 0);
      end
      dtof_registers_pkg::POINTER: begin
        read_data[dtof_registers_pkg::POINTER_STEP_LSB+:15] = 15'(POINTER_STEP);
        read_data[dtof_registers_pkg::POINTER_GUARD_LSB+:17] = 17'(GUARD);
      end
      dtof_registers_pkg::POOL:
      if (HAS_SCHEDULE != 0) begin
        read_data[dtof_registers_pkg::POOL_GROUP_SIZE_LSB+:8] = 8'(GROUP_SIZE);
        read_data[dtof_registers_pkg::POOL_LABELS_LSB+:4] = 4'(LABELS);
        read_data[dtof_registers_pkg::POOL_SCORE_BITS_LSB+:4] = 4'(SCORE_BITS);
        read_data[dtof_registers_pkg::POOL_OFFSET_BITS_LSB+:4] = 4'(OFFSET_BITS);
        read_data[dtof_registers_pkg::POOL_ADVANTAGE_WIDTH_LSB+:4] = 4'(ADVANTAGE_WIDTH);
        read_data[dtof_registers_pkg::POOL_POINTER_SHIFT_LSB+:4] = 4'(POINTER_SHIFT);
        read_data[dtof_registers_pkg::POOL_CELL_SHIFT_LSB+:4] = 4'(CELL_SHIFT);
      end
      dtof_registers_pkg::ENGINES:
      if (HAS_SCHEDULE != 0) begin
        read_data[dtof_registers_pkg::ENGINES_COLUMNS_LSB+:16] = 16'(ENGINE_COLUMNS);
        read_data[dtof_registers_pkg::ENGINES_RIVAL_MOVES_LSB] = (RIVAL_MOVES != 0);
      end
      dtof_registers_pkg::SHARES:
      if (HAS_SCHEDULE != 0) begin
        read_data[dtof_registers_pkg::SHARES_COARSE_LSB+:8] = 8'(COARSE_SHARE);
        read_data[dtof_registers_pkg::SHARES_TRACK_LSB+:8] = 8'(TRACK_SHARE);
      end
      dtof_registers_pkg::CONTROL: read_data[dtof_registers_pkg::CONTROL_CONTINUOUS_LSB] = continuous_q;
      dtof_registers_pkg::STATUS: begin
        read_data[dtof_registers_pkg::STATUS_BUSY_LSB] = busy_i;
        read_data[dtof_registers_pkg::STATUS_STATE_LSB+:3] = state_i;
        read_data[dtof_registers_pkg::STATUS_SELF_TEST_LSB] = self_test_busy_i;
        read_data[dtof_registers_pkg::STATUS_PASSED_LSB] = self_test_passed_i;
        read_data[dtof_registers_pkg::STATUS_LEVEL_LSB+:16] = level_i;
      end
      dtof_registers_pkg::ERROR: read_data = 32'(error_q);
      dtof_registers_pkg::IRQ_ENABLE: read_data = 32'(cause_enable_q);
      dtof_registers_pkg::IRQ_STATUS: read_data = 32'(cause_q);
      dtof_registers_pkg::FRAME_COUNT: read_data = frame_count_i;
      dtof_registers_pkg::FRAME_CYCLES: read_data = frame_cycles_i;
      dtof_registers_pkg::FRAME_CRC: read_data = frame_crc_i;
      dtof_registers_pkg::WARNING: read_data = 32'(warning_q);
      dtof_registers_pkg::WATCHDOG: read_data = 32'(watchdog_q);
      dtof_registers_pkg::LOST_LINES: read_data = lost_lines_i;
      dtof_registers_pkg::LOST_ACQUISITIONS: read_data = lost_acquisitions_i;
      dtof_registers_pkg::COMMIT: read_data = '0;
      dtof_registers_pkg::SHOT: begin
        read_data[dtof_registers_pkg::SHOT_BITS_LSB+:3] = shot_bits_q;
        read_data[dtof_registers_pkg::SHOT_UNIT_LSB+:8] = shot_unit_q;
      end
      dtof_registers_pkg::SHOT_SEED: read_data = 32'(shot_seed_q);
      dtof_registers_pkg::SETTLE: read_data = 32'(settle_q);
      dtof_registers_pkg::SELF_TEST_SEED: read_data = self_test_seed_o;
      dtof_registers_pkg::SELF_TEST_EXPECTED: read_data = self_test_expected_o;
      dtof_registers_pkg::PARITY_ERRORS: read_data = parity_errors_i;
      dtof_registers_pkg::SHOT_STATE: read_data = 32'(shot_state_i);
      dtof_registers_pkg::ACQUISITIONS: read_data = 32'(acquisitions_q);
      dtof_registers_pkg::COARSE_END: read_data = 32'(coarse_end);
      dtof_registers_pkg::TRACK_END: read_data = 32'(track_end);
      dtof_registers_pkg::GATE: begin
        read_data[dtof_registers_pkg::GATE_BEGIN_LSB+:16] = 16'(gate_begin);
        read_data[dtof_registers_pkg::GATE_END_LSB+:16] = 16'(gate_end);
      end
      dtof_registers_pkg::RELEASE: read_data = 32'(release_q);
      dtof_registers_pkg::WEAK_BELOW: read_data = 32'(weak_below_q);
      dtof_registers_pkg::OUTPUT: begin
        read_data[dtof_registers_pkg::OUTPUT_SECOND_TARGET_LSB] = second;
        read_data[dtof_registers_pkg::OUTPUT_RAW_LSB] = raw;
        read_data[dtof_registers_pkg::OUTPUT_SMOOTH_LSB] = smooth;
        read_data[dtof_registers_pkg::OUTPUT_PRIOR_LSB] = prior;
        read_data[dtof_registers_pkg::OUTPUT_AMPLITUDE_LSB] = amplitude;
        read_data[dtof_registers_pkg::OUTPUT_SHORT_WORDS_LSB] = short_words_q;
      end
      dtof_registers_pkg::RAW_ROWS: begin
        read_data[dtof_registers_pkg::RAW_ROWS_FIRST_LSB+:12] = raw_first;
        read_data[dtof_registers_pkg::RAW_ROWS_LAST_LSB+:12] = raw_last;
      end
      default:
      if (is_template) begin
        read_data = template_word;
      end else if (offset >= dtof_registers_pkg::COLUMN_ENABLE) begin
        read_data = enable_word;
      end
    endcase
  end

endmodule

`default_nettype wire
