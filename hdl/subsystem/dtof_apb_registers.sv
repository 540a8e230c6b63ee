// SPDX-License-Identifier: Apache-2.0
// The registers of dtof_subsystem behind an APB4 port (hdl/subsystem/registers.toml; table in docs/user/integration.md).
//
// dtof_apb_port has the rules of the transfers, dtof_writable_bits the bits that exist. Settings become valid together, with COMMIT, START or a
// self-test (dtof_setting_registers). CONTROL, WATCHDOG, SHOT_SEED, SELF_TEST_SEED and SELF_TEST_EXPECTED (dtof_command_registers), IRQ_ENABLE
// (dtof_event_registers) and TEMPLATE (dtof_template_registers) are valid at once. dtof_read_only_registers has constants and status. If software clears a bit in the clock of a new event, the bit
// stays set. A read is the OR of what the parts have at its offset.
// Schedule: that of dtof_apb_port. irq_o shows an error one clock after ERROR.
// Latency: a command is a pulse in the clock after its write; a committed setting is at its output in the clock after the commit.
// Cost: two flip-flops per bit of a setting, SRAM_NUM such bits for the columns, and the read multiplexer.

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
  localparam int CAUSES = 2;  // causes of an interrupt
  localparam int WEAK_WIDTH = dtof_pkg::min_of(CONFIDENCE_WIDTH + 1, 16);

  logic write, starts, start_ignored, commit;
  logic [11:0] offset;
  logic [31:0] mask, written, there;
  logic [31:0] read_only, command, setting, template_word, event_flags;  // what the parts have at the offset

  dtof_apb_port u_port (
      .clk_i     (clk_i),
      .rst_ni    (rst_ni),
      .psel_i    (psel_i),
      .penable_i (penable_i),
      .pwrite_i  (pwrite_i),
      .paddr_i   (paddr_i),
      .pwdata_i  (pwdata_i),
      .pstrb_i   (pstrb_i),
      .pready_o  (pready_o),
      .prdata_o  (prdata_o),
      .pslverr_o (pslverr_o),
      .starting_i(starting_i),
      .pending_i (frame_crc_pending_i),
      .offset_o  (offset),
      .write_o   (write),
      .mask_o    (mask),
      .written_o (written),
      .there_i   (there),
      .data_i    (read_only | command | setting | template_word | event_flags)
  );

  assign commit = starts || (write && offset == dtof_registers_pkg::COMMIT && written[dtof_registers_pkg::COMMIT_SETTINGS_LSB]);

  dtof_writable_bits #(
      .HAS_SCHEDULE (HAS_SCHEDULE),
      .TIME_GATE    (TIME_GATE),
      .SELF_TEST    (SELF_TEST),
      .SECOND_TARGET(SECOND_TARGET),
      .AMPLITUDE    (AMPLITUDE),
      .PRIOR        (PRIOR),
      .RAW_HISTOGRAM(RAW_HISTOGRAM),
      .NP           (NP),
      .SRAM_NUM     (SRAM_NUM),
      .ACQ_WIDTH    (ACQ_WIDTH),
      .WEAK_WIDTH   (WEAK_WIDTH),
      .CAUSES       (CAUSES)
  ) u_writable_bits (
      .offset_i(offset),
      .busy_i  (busy_i),
      .there_o (there)
  );

  dtof_read_only_registers #(
      .READOUT         (READOUT),
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
      .RAW_BINS        (RAW_BINS),
      .NP              (NP),
      .SRAM_NUM        (SRAM_NUM),
      .PIXELS_PER_SRAM (PIXELS_PER_SRAM),
      .SLOTS           (SLOTS),
      .FRACTION_WIDTH  (FRACTION_WIDTH),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .ACQ_WIDTH       (ACQ_WIDTH),
      .COUNT_WIDTH     (COUNT_WIDTH),
      .NB              (NB),
      .WINDOW_CENTRED  (WINDOW_CENTRED),
      .POINTER_STEP    (POINTER_STEP),
      .GUARD           (GUARD),
      .GROUP_SIZE      (GROUP_SIZE),
      .LABELS          (LABELS),
      .SCORE_BITS      (SCORE_BITS),
      .OFFSET_BITS     (OFFSET_BITS),
      .ADVANTAGE_WIDTH (ADVANTAGE_WIDTH),
      .POINTER_SHIFT   (POINTER_SHIFT),
      .CELL_SHIFT      (CELL_SHIFT),
      .RIVAL_MOVES     (RIVAL_MOVES),
      .ENGINE_COLUMNS  (ENGINE_COLUMNS),
      .COARSE_SHARE    (COARSE_SHARE),
      .TRACK_SHARE     (TRACK_SHARE),
      .BUFFER_LINES    (BUFFER_LINES)
  ) u_read_only (
      .offset_i           (offset),
      .data_o             (read_only),
      .busy_i             (busy_i),
      .state_i            (state_i),
      .level_i            (level_i),
      .frame_count_i      (frame_count_i),
      .frame_cycles_i     (frame_cycles_i),
      .frame_crc_i        (frame_crc_i),
      .lost_lines_i       (lost_lines_i),
      .lost_acquisitions_i(lost_acquisitions_i),
      .shot_state_i       (shot_state_i),
      .parity_errors_i    (parity_errors_i),
      .self_test_busy_i   (self_test_busy_i),
      .self_test_passed_i (self_test_passed_i)
  );

  dtof_command_registers #(
      .SELF_TEST(SELF_TEST)
  ) u_commands (
      .clk_i               (clk_i),
      .rst_ni              (rst_ni),
      .offset_i            (offset),
      .write_i             (write),
      .mask_i              (mask),
      .written_i           (written),
      .data_o              (command),
      .busy_i              (busy_i),
      .starts_o            (starts),
      .start_ignored_o     (start_ignored),
      .illegal_schedule_i  (illegal_schedule_i),
      .start_o             (start_o),
      .self_test_o         (self_test_o),
      .flush_o             (flush_o),
      .abort_o             (abort_o),
      .continuous_o        (continuous_o),
      .watchdog_o          (watchdog_o),
      .shot_seed_o         (shot_seed_o),
      .shot_reseed_o       (shot_reseed_o),
      .self_test_seed_o    (self_test_seed_o),
      .self_test_expected_o(self_test_expected_o)
  );

  dtof_setting_registers #(
      .HAS_SCHEDULE (HAS_SCHEDULE),
      .TIME_GATE    (TIME_GATE),
      .SECOND_TARGET(SECOND_TARGET),
      .AMPLITUDE    (AMPLITUDE),
      .PRIOR        (PRIOR),
      .RAW_HISTOGRAM(RAW_HISTOGRAM),
      .NP           (NP),
      .SRAM_NUM     (SRAM_NUM),
      .ACQ_WIDTH    (ACQ_WIDTH),
      .WEAK_WIDTH   (WEAK_WIDTH),
      .MOST_RELEASE (MOST_RELEASE)
  ) u_settings (
      .clk_i         (clk_i),
      .rst_ni        (rst_ni),
      .offset_i      (offset),
      .write_i       (write),
      .mask_i        (mask),
      .written_i     (written),
      .commit_i      (commit),
      .data_o        (setting),
      .second_o      (second_o),
      .amplitude_o   (amplitude_o),
      .raw_o         (raw_o),
      .raw_first_o   (raw_first_o),
      .raw_last_o    (raw_last_o),
      .acquisitions_o(acquisitions_o),
      .coarse_end_o  (coarse_end_o),
      .track_end_o   (track_end_o),
      .smooth_o      (smooth_o),
      .prior_o       (prior_o),
      .short_words_o (short_words_o),
      .gate_begin_o  (gate_begin_o),
      .gate_end_o    (gate_end_o),
      .release_o     (release_o),
      .weak_below_o  (weak_below_o),
      .enable_o      (enable_o),
      .shot_bits_o   (shot_bits_o),
      .shot_unit_o   (shot_unit_o),
      .settle_o      (settle_o)
  );

  dtof_template_registers #(
      .HAS_SCHEDULE(HAS_SCHEDULE)
  ) u_template (
      .clk_i     (clk_i),
      .rst_ni    (rst_ni),
      .offset_i  (offset),
      .write_i   (write),
      .mask_i    (mask),
      .written_i (written),
      .data_o    (template_word),
      .template_o(template_o)
  );

  dtof_event_registers #(
      .ERRORS(ERRORS),
      .CAUSES(CAUSES)
  ) u_events (
      .clk_i             (clk_i),
      .rst_ni            (rst_ni),
      .offset_i          (offset),
      .write_i           (write),
      .mask_i            (mask[CAUSES-1:0]),
      .written_i         (written[ERRORS-1:0]),
      .data_o            (event_flags),
      .frame_i           (frame_i),
      .underrun_i        (underrun_i),
      .start_ignored_i   (start_ignored_i || start_ignored),
      .illegal_schedule_i(illegal_schedule_i),
      .overrun_i         (overrun_i),
      .short_i           (short_i),
      .long_i            (long_i),
      .timeout_i         (timeout_i),
      .stalled_i         (stalled_i),
      .flush_ignored_i   (flush_ignored_i),
      .parity_error_i    (parity_error_i),
      .self_test_failed_i(self_test_failed_i),
      .aborted_i         (aborted_i),
      .counter_full_i    (counter_full_i),
      .irq_o             (irq_o)
  );

endmodule

`default_nettype wire
