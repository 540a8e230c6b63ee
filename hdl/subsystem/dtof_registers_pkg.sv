// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from hdl/subsystem/registers.toml.
// Offsets of the registers, their values behind a reset (0 where the parameters decide), and for each field its lowest bit and
// its number of bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

package dtof_registers_pkg;

  localparam logic [31:0] ID_VALUE = 32'h444f4650;
  localparam logic [31:0] VERSION_VALUE = 32'h00030006;

  // identifies the subsystem
  localparam logic [11:0] ID = 12'h000;
  localparam logic [31:0] ID_RESET = 32'h444f4650;
  localparam int ID_VALUE_LSB = 0;
  localparam int ID_VALUE_WIDTH = 32;

  // version of the registers and the result stream
  localparam logic [11:0] VERSION = 12'h004;
  localparam logic [31:0] VERSION_RESET = 32'h00030006;
  localparam int VERSION_MINOR_LSB = 0;
  localparam int VERSION_MINOR_WIDTH = 16;
  localparam int VERSION_MAJOR_LSB = 16;
  localparam int VERSION_MAJOR_WIDTH = 16;

  // read-out and parameters of the array
  localparam logic [11:0] READOUT = 12'h008;
  localparam logic [31:0] READOUT_RESET = 32'h00000000;
  localparam int READOUT_NUMBER_LSB = 0;
  localparam int READOUT_NUMBER_WIDTH = 8;
  localparam int READOUT_SCHEDULE_LSB = 8;
  localparam int READOUT_SCHEDULE_WIDTH = 1;
  localparam int READOUT_TIME_GATE_LSB = 9;
  localparam int READOUT_TIME_GATE_WIDTH = 1;
  localparam int READOUT_RASTER_ORDER_LSB = 10;
  localparam int READOUT_RASTER_ORDER_WIDTH = 1;
  localparam int READOUT_SECOND_TARGET_LSB = 11;
  localparam int READOUT_SECOND_TARGET_WIDTH = 1;
  localparam int READOUT_RAW_HISTOGRAM_LSB = 12;
  localparam int READOUT_RAW_HISTOGRAM_WIDTH = 1;
  localparam int READOUT_PRIOR_LSB = 13;
  localparam int READOUT_PRIOR_WIDTH = 1;
  localparam int READOUT_PARITY_LSB = 14;
  localparam int READOUT_PARITY_WIDTH = 1;
  localparam int READOUT_CLOCK_WAITS_LSB = 15;
  localparam int READOUT_CLOCK_WAITS_WIDTH = 1;
  localparam int READOUT_SOURCE_WAITS_LSB = 16;
  localparam int READOUT_SOURCE_WAITS_WIDTH = 1;
  localparam int READOUT_SELF_TEST_LSB = 17;
  localparam int READOUT_SELF_TEST_WIDTH = 1;
  localparam int READOUT_AMPLITUDE_LSB = 18;
  localparam int READOUT_AMPLITUDE_WIDTH = 1;

  // size of the array
  localparam logic [11:0] SIZE = 12'h00c;
  localparam logic [31:0] SIZE_RESET = 32'h00000000;
  localparam int SIZE_COLUMNS_LSB = 0;
  localparam int SIZE_COLUMNS_WIDTH = 16;
  localparam int SIZE_ROWS_LSB = 16;
  localparam int SIZE_ROWS_WIDTH = 16;

  // bits of timestamps, results and the number of acquisitions
  localparam logic [11:0] WIDTHS = 12'h010;
  localparam logic [31:0] WIDTHS_RESET = 32'h00000000;
  localparam int WIDTHS_TIMESTAMP_LSB = 0;
  localparam int WIDTHS_TIMESTAMP_WIDTH = 8;
  localparam int WIDTHS_FRACTION_LSB = 8;
  localparam int WIDTHS_FRACTION_WIDTH = 8;
  localparam int WIDTHS_CONFIDENCE_LSB = 16;
  localparam int WIDTHS_CONFIDENCE_WIDTH = 8;
  localparam int WIDTHS_ACQUISITIONS_LSB = 24;
  localparam int WIDTHS_ACQUISITIONS_WIDTH = 8;

  // lines of timestamps
  localparam logic [11:0] LINES = 12'h014;
  localparam logic [31:0] LINES_RESET = 32'h00000000;
  localparam int LINES_ACQUISITION_LSB = 0;
  localparam int LINES_ACQUISITION_WIDTH = 16;
  localparam int LINES_BUFFER_LSB = 16;
  localparam int LINES_BUFFER_WIDTH = 16;

  // timestamps of a pixel in an acquisition
  localparam logic [11:0] SLOTS = 12'h018;
  localparam logic [31:0] SLOTS_RESET = 32'h00000000;
  localparam int SLOTS_VALUE_LSB = 0;
  localparam int SLOTS_VALUE_WIDTH = 8;

  // size of a raw histogram
  localparam logic [11:0] RAW_BINS = 12'h01c;
  localparam logic [31:0] RAW_BINS_RESET = 32'h00000000;
  localparam int RAW_BINS_VALUE_LSB = 0;
  localparam int RAW_BINS_VALUE_WIDTH = 17;

  // parameters of the histograms
  localparam logic [11:0] HISTOGRAM = 12'h020;
  localparam logic [31:0] HISTOGRAM_RESET = 32'h00000000;
  localparam int HISTOGRAM_COUNT_WIDTH_LSB = 0;
  localparam int HISTOGRAM_COUNT_WIDTH_WIDTH = 8;
  localparam int HISTOGRAM_NB_LSB = 8;
  localparam int HISTOGRAM_NB_WIDTH = 8;
  localparam int HISTOGRAM_WINDOW_CENTRED_LSB = 16;
  localparam int HISTOGRAM_WINDOW_CENTRED_WIDTH = 1;

  // parameters of a pointer read-out
  localparam logic [11:0] POINTER = 12'h024;
  localparam logic [31:0] POINTER_RESET = 32'h00000000;
  localparam int POINTER_STEP_LSB = 0;
  localparam int POINTER_STEP_WIDTH = 15;
  localparam int POINTER_GUARD_LSB = 15;
  localparam int POINTER_GUARD_WIDTH = 17;

  // parameters of poolPointer, which differ from those of poolPointer lean; 0 without READOUT.SCHEDULE
  localparam logic [11:0] POOL = 12'h028;
  localparam logic [31:0] POOL_RESET = 32'h00000000;
  localparam int POOL_GROUP_SIZE_LSB = 0;
  localparam int POOL_GROUP_SIZE_WIDTH = 8;
  localparam int POOL_LABELS_LSB = 8;
  localparam int POOL_LABELS_WIDTH = 4;
  localparam int POOL_SCORE_BITS_LSB = 12;
  localparam int POOL_SCORE_BITS_WIDTH = 4;
  localparam int POOL_OFFSET_BITS_LSB = 16;
  localparam int POOL_OFFSET_BITS_WIDTH = 4;
  localparam int POOL_ADVANTAGE_WIDTH_LSB = 20;
  localparam int POOL_ADVANTAGE_WIDTH_WIDTH = 4;
  localparam int POOL_POINTER_SHIFT_LSB = 24;
  localparam int POOL_POINTER_SHIFT_WIDTH = 4;
  localparam int POOL_CELL_SHIFT_LSB = 28;
  localparam int POOL_CELL_SHIFT_WIDTH = 4;

  // more parameters of poolPointer; 0 without READOUT.SCHEDULE
  localparam logic [11:0] ENGINES = 12'h02c;
  localparam logic [31:0] ENGINES_RESET = 32'h00000000;
  localparam int ENGINES_COLUMNS_LSB = 0;
  localparam int ENGINES_COLUMNS_WIDTH = 16;
  localparam int ENGINES_RIVAL_MOVES_LSB = 16;
  localparam int ENGINES_RIVAL_MOVES_WIDTH = 1;

  // the recommended schedule of poolPointer in 64ths of a frame; 0 without READOUT.SCHEDULE
  localparam logic [11:0] SHARES = 12'h030;
  localparam logic [31:0] SHARES_RESET = 32'h00000000;
  localparam int SHARES_COARSE_LSB = 0;
  localparam int SHARES_COARSE_WIDTH = 8;
  localparam int SHARES_TRACK_LSB = 8;
  localparam int SHARES_TRACK_WIDTH = 8;

  // begins and ends frames
  localparam logic [11:0] CONTROL = 12'h040;
  localparam logic [31:0] CONTROL_RESET = 32'h00000000;
  localparam int CONTROL_START_LSB = 0;
  localparam int CONTROL_START_WIDTH = 1;
  localparam int CONTROL_CONTINUOUS_LSB = 1;
  localparam int CONTROL_CONTINUOUS_WIDTH = 1;
  localparam int CONTROL_FLUSH_LSB = 2;
  localparam int CONTROL_FLUSH_WIDTH = 1;
  localparam int CONTROL_ABORT_LSB = 3;
  localparam int CONTROL_ABORT_WIDTH = 1;
  localparam int CONTROL_SELF_TEST_LSB = 4;
  localparam int CONTROL_SELF_TEST_WIDTH = 1;

  // state of the subsystem
  localparam logic [11:0] STATUS = 12'h044;
  localparam logic [31:0] STATUS_RESET = 32'h00000000;
  localparam int STATUS_BUSY_LSB = 0;
  localparam int STATUS_BUSY_WIDTH = 1;
  localparam int STATUS_STATE_LSB = 4;
  localparam int STATUS_STATE_WIDTH = 3;
  localparam int STATUS_SELF_TEST_LSB = 8;
  localparam int STATUS_SELF_TEST_WIDTH = 1;
  localparam int STATUS_PASSED_LSB = 9;
  localparam int STATUS_PASSED_WIDTH = 1;
  localparam int STATUS_LEVEL_LSB = 16;
  localparam int STATUS_LEVEL_WIDTH = 16;

  // errors since the bits were last cleared
  localparam logic [11:0] ERROR = 12'h048;
  localparam logic [31:0] ERROR_RESET = 32'h00000000;
  localparam int ERROR_UNDERRUN_LSB = 0;
  localparam int ERROR_UNDERRUN_WIDTH = 1;
  localparam int ERROR_START_IGNORED_LSB = 1;
  localparam int ERROR_START_IGNORED_WIDTH = 1;
  localparam int ERROR_ILLEGAL_SCHEDULE_LSB = 2;
  localparam int ERROR_ILLEGAL_SCHEDULE_WIDTH = 1;
  localparam int ERROR_OVERRUN_LSB = 3;
  localparam int ERROR_OVERRUN_WIDTH = 1;
  localparam int ERROR_MISFRAMED_LSB = 4;
  localparam int ERROR_MISFRAMED_WIDTH = 1;
  localparam int ERROR_TIMEOUT_LSB = 5;
  localparam int ERROR_TIMEOUT_WIDTH = 1;
  localparam int ERROR_STALLED_LSB = 6;
  localparam int ERROR_STALLED_WIDTH = 1;
  localparam int ERROR_FLUSH_IGNORED_LSB = 7;
  localparam int ERROR_FLUSH_IGNORED_WIDTH = 1;
  localparam int ERROR_PARITY_LSB = 8;
  localparam int ERROR_PARITY_WIDTH = 1;
  localparam int ERROR_SELF_TEST_LSB = 9;
  localparam int ERROR_SELF_TEST_WIDTH = 1;

  // enables causes of `irq_o`; valid at once
  localparam logic [11:0] IRQ_ENABLE = 12'h04c;
  localparam logic [31:0] IRQ_ENABLE_RESET = 32'h00000000;
  localparam int IRQ_ENABLE_FRAME_LSB = 0;
  localparam int IRQ_ENABLE_FRAME_WIDTH = 1;
  localparam int IRQ_ENABLE_ERROR_LSB = 1;
  localparam int IRQ_ENABLE_ERROR_WIDTH = 1;

  // causes of the interrupt; `irq_o` is high while an enabled bit is set
  localparam logic [11:0] IRQ_STATUS = 12'h050;
  localparam logic [31:0] IRQ_STATUS_RESET = 32'h00000000;
  localparam int IRQ_STATUS_FRAME_LSB = 0;
  localparam int IRQ_STATUS_FRAME_WIDTH = 1;
  localparam int IRQ_STATUS_ERROR_LSB = 1;
  localparam int IRQ_STATUS_ERROR_WIDTH = 1;

  // frames since reset whose last result was taken; 0 follows 2^32 - 1
  localparam logic [11:0] FRAME_COUNT = 12'h054;
  localparam logic [31:0] FRAME_COUNT_RESET = 32'h00000000;
  localparam int FRAME_COUNT_VALUE_LSB = 0;
  localparam int FRAME_COUNT_VALUE_WIDTH = 32;

  // duration of the last frame, from the clock of its start to the clock of the array's `done_o`
  localparam logic [11:0] FRAME_CYCLES = 12'h058;
  localparam logic [31:0] FRAME_CYCLES_RESET = 32'h00000000;
  localparam int FRAME_CYCLES_VALUE_LSB = 0;
  localparam int FRAME_CYCLES_VALUE_WIDTH = 32;

  // warnings about results since the bits were last cleared; they raise no interrupt
  localparam logic [11:0] WARNING = 12'h05c;
  localparam logic [31:0] WARNING_RESET = 32'h00000000;
  localparam int WARNING_COUNTER_FULL_LSB = 0;
  localparam int WARNING_COUNTER_FULL_WIDTH = 1;
  localparam int WARNING_ABORTED_LSB = 1;
  localparam int WARNING_ABORTED_WIDTH = 1;
  localparam int WARNING_SHORT_LSB = 2;
  localparam int WARNING_SHORT_WIDTH = 1;
  localparam int WARNING_LONG_LSB = 3;
  localparam int WARNING_LONG_WIDTH = 1;

  // acquisitions of a frame; 0 is legal
  localparam logic [11:0] ACQUISITIONS = 12'h060;
  localparam logic [31:0] ACQUISITIONS_RESET = 32'h00000000;
  localparam int ACQUISITIONS_VALUE_LSB = 0;
  localparam int ACQUISITIONS_VALUE_WIDTH = 24;

  // poolPointer: the coarse phase ends before this acquisition
  localparam logic [11:0] COARSE_END = 12'h064;
  localparam logic [31:0] COARSE_END_RESET = 32'h00000000;
  localparam int COARSE_END_VALUE_LSB = 0;
  localparam int COARSE_END_VALUE_WIDTH = 24;

  // poolPointer: the track phase ends before this acquisition
  localparam logic [11:0] TRACK_END = 12'h068;
  localparam logic [31:0] TRACK_END_RESET = 32'h00000000;
  localparam int TRACK_END_VALUE_LSB = 0;
  localparam int TRACK_END_VALUE_WIDTH = 24;

  // longest wait of a frame for lines, and of a result for the sink, before a bit of ERROR is set; valid at once
  localparam logic [11:0] WATCHDOG = 12'h06c;
  localparam logic [31:0] WATCHDOG_RESET = 32'h00ffffff;
  localparam int WATCHDOG_CLOCKS_LSB = 0;
  localparam int WATCHDOG_CLOCKS_WIDTH = 24;

  // with TIME_GATE = 1: a timestamp from BEGIN to below END counts; at reset all timestamps count
  localparam logic [11:0] GATE = 12'h070;
  localparam logic [31:0] GATE_RESET = 32'h00000000;
  localparam int GATE_BEGIN_LSB = 0;
  localparam int GATE_BEGIN_WIDTH = 16;
  localparam int GATE_END_LSB = 16;
  localparam int GATE_END_WIDTH = 16;

  // READOUT.CLOCK_WAITS = 1: lines of an acquisition that must have arrived before the next shot; 0: lines that must be in the buffer before an acquisition begins
  localparam logic [11:0] RELEASE = 12'h074;
  localparam logic [31:0] RELEASE_RESET = 32'h00000000;
  localparam int RELEASE_VALUE_LSB = 0;
  localparam int RELEASE_VALUE_WIDTH = 16;

  // a result whose confidence is below this value is weak
  localparam logic [11:0] WEAK_BELOW = 12'h078;
  localparam logic [31:0] WEAK_BELOW_RESET = 32'h00000000;
  localparam int WEAK_BELOW_VALUE_LSB = 0;
  localparam int WEAK_BELOW_VALUE_WIDTH = 16;

  // selects the words of a frame
  localparam logic [11:0] OUTPUT = 12'h07c;
  localparam logic [31:0] OUTPUT_RESET = 32'h00000000;
  localparam int OUTPUT_SECOND_TARGET_LSB = 0;
  localparam int OUTPUT_SECOND_TARGET_WIDTH = 1;
  localparam int OUTPUT_RAW_LSB = 1;
  localparam int OUTPUT_RAW_WIDTH = 1;
  localparam int OUTPUT_SMOOTH_LSB = 2;
  localparam int OUTPUT_SMOOTH_WIDTH = 1;
  localparam int OUTPUT_PRIOR_LSB = 3;
  localparam int OUTPUT_PRIOR_WIDTH = 1;
  localparam int OUTPUT_SHORT_WORDS_LSB = 4;
  localparam int OUTPUT_SHORT_WORDS_WIDTH = 1;
  localparam int OUTPUT_AMPLITUDE_LSB = 5;
  localparam int OUTPUT_AMPLITUDE_WIDTH = 1;

  // register k: columns 32 k and up; at reset all are enabled
  localparam logic [11:0] COLUMN_ENABLE = 12'h080;
  localparam int COLUMN_ENABLE_NUMBER = 32;
  localparam logic [31:0] COLUMN_ENABLE_RESET = 32'h00000000;
  localparam int COLUMN_ENABLE_MASK_LSB = 0;
  localparam int COLUMN_ENABLE_MASK_WIDTH = 32;

  // with OUTPUT.RAW: rows whose histograms a frame sends
  localparam logic [11:0] RAW_ROWS = 12'h100;
  localparam logic [31:0] RAW_ROWS_RESET = 32'h00000000;
  localparam int RAW_ROWS_FIRST_LSB = 0;
  localparam int RAW_ROWS_FIRST_WIDTH = 12;
  localparam int RAW_ROWS_LAST_LSB = 16;
  localparam int RAW_ROWS_LAST_WIDTH = 12;

  // ignored lines since reset: late lines after an underrun or a timeout, surplus lines of a long acquisition, lines of a dropped acquisition; without the lines that FLUSH and ABORT remove
  localparam logic [11:0] LOST_LINES = 12'h104;
  localparam logic [31:0] LOST_LINES_RESET = 32'h00000000;
  localparam int LOST_LINES_VALUE_LSB = 0;
  localparam int LOST_LINES_VALUE_WIDTH = 32;

  // acquisitions since reset in which a missing line counted as no detection, and dropped acquisitions
  localparam logic [11:0] LOST_ACQUISITIONS = 12'h108;
  localparam logic [31:0] LOST_ACQUISITIONS_RESET = 32'h00000000;
  localparam int LOST_ACQUISITIONS_VALUE_LSB = 0;
  localparam int LOST_ACQUISITIONS_VALUE_WIDTH = 32;

  // makes all written settings valid together, for the frames that begin after this write
  localparam logic [11:0] COMMIT = 12'h10c;
  localparam logic [31:0] COMMIT_RESET = 32'h00000000;
  localparam int COMMIT_SETTINGS_LSB = 0;
  localparam int COMMIT_SETTINGS_WIDTH = 1;

  // start dither: delay of `shot_o` after the request for an acquisition
  localparam logic [11:0] SHOT = 12'h110;
  localparam logic [31:0] SHOT_RESET = 32'h00000100;
  localparam int SHOT_BITS_LSB = 0;
  localparam int SHOT_BITS_WIDTH = 3;
  localparam int SHOT_UNIT_LSB = 8;
  localparam int SHOT_UNIT_WIDTH = 8;

  // start of the sequence of delays; write another value in each sensor; valid at once
  localparam logic [11:0] SHOT_SEED = 12'h114;
  localparam logic [31:0] SHOT_SEED_RESET = 32'h00000001;
  localparam int SHOT_SEED_VALUE_LSB = 0;
  localparam int SHOT_SEED_VALUE_WIDTH = 16;

  // state from which the last frame's delays follow
  localparam logic [11:0] SHOT_STATE = 12'h118;
  localparam logic [31:0] SHOT_STATE_RESET = 32'h00000001;
  localparam int SHOT_STATE_VALUE_LSB = 0;
  localparam int SHOT_STATE_VALUE_WIDTH = 16;

  // checksum of the words of the last frame that FRAME_COUNT counts, or of the last self-test
  localparam logic [11:0] FRAME_CRC = 12'h11c;
  localparam logic [31:0] FRAME_CRC_RESET = 32'h00000000;
  localparam int FRAME_CRC_VALUE_LSB = 0;
  localparam int FRAME_CRC_VALUE_WIDTH = 32;

  // reads since reset of words with a wrong parity; errors of an array that meet on their way along the columns count once
  localparam logic [11:0] PARITY_ERRORS = 12'h120;
  localparam logic [31:0] PARITY_ERRORS_RESET = 32'h00000000;
  localparam int PARITY_ERRORS_VALUE_LSB = 0;
  localparam int PARITY_ERRORS_VALUE_WIDTH = 32;

  // poolPointer: amount that decode subtracts from each of the 32 coarse bins, for light of cover glass and fog; valid at once; a write while STATUS.BUSY is a bus error
  localparam logic [11:0] TEMPLATE = 12'h124;
  localparam int TEMPLATE_NUMBER = 8;
  localparam logic [31:0] TEMPLATE_RESET = 32'h00000000;
  localparam int TEMPLATE_ENTRY0_LSB = 0;
  localparam int TEMPLATE_ENTRY0_WIDTH = 8;
  localparam int TEMPLATE_ENTRY1_LSB = 8;
  localparam int TEMPLATE_ENTRY1_WIDTH = 8;
  localparam int TEMPLATE_ENTRY2_LSB = 16;
  localparam int TEMPLATE_ENTRY2_WIDTH = 8;
  localparam int TEMPLATE_ENTRY3_LSB = 24;
  localparam int TEMPLATE_ENTRY3_WIDTH = 8;

  // acquisitions to drop while the laser settles
  localparam logic [11:0] SETTLE = 12'h144;
  localparam logic [31:0] SETTLE_RESET = 32'h00000000;
  localparam int SETTLE_VALUE_LSB = 0;
  localparam int SETTLE_VALUE_WIDTH = 16;

  // start of a self-test's pseudo-random timestamps; valid at once
  localparam logic [11:0] SELF_TEST_SEED = 12'h148;
  localparam logic [31:0] SELF_TEST_SEED_RESET = 32'h00000000;
  localparam int SELF_TEST_SEED_VALUE_LSB = 0;
  localparam int SELF_TEST_SEED_VALUE_WIDTH = 32;

  // what a self-test's FRAME_CRC must be; valid at once
  localparam logic [11:0] SELF_TEST_EXPECTED = 12'h14c;
  localparam logic [31:0] SELF_TEST_EXPECTED_RESET = 32'h00000000;
  localparam int SELF_TEST_EXPECTED_VALUE_LSB = 0;
  localparam int SELF_TEST_EXPECTED_VALUE_WIDTH = 32;

  // A result.
  localparam int RESULT_WIDTH = 64;
  localparam int RESULT_POSITION_LSB = 0;
  localparam int RESULT_POSITION_WIDTH = 16;
  localparam int RESULT_CONFIDENCE_LSB = 16;
  localparam int RESULT_CONFIDENCE_WIDTH = 16;
  localparam int RESULT_ROW_LSB = 32;
  localparam int RESULT_ROW_WIDTH = 12;
  localparam int RESULT_COLUMN_LSB = 44;
  localparam int RESULT_COLUMN_WIDTH = 12;
  localparam int RESULT_VALID_LSB = 56;
  localparam int RESULT_VALID_WIDTH = 1;
  localparam int RESULT_WEAK_LSB = 57;
  localparam int RESULT_WEAK_WIDTH = 1;
  localparam int RESULT_EMPTY_LSB = 58;
  localparam int RESULT_EMPTY_WIDTH = 1;
  localparam int RESULT_MASKED_LSB = 59;
  localparam int RESULT_MASKED_WIDTH = 1;
  localparam int RESULT_SATURATED_LSB = 60;
  localparam int RESULT_SATURATED_WIDTH = 1;
  localparam int RESULT_SECOND_LSB = 61;
  localparam int RESULT_SECOND_WIDTH = 1;
  localparam int RESULT_RAW_LSB = 62;
  localparam int RESULT_RAW_WIDTH = 1;
  localparam int RESULT_ABORTED_LSB = 63;
  localparam int RESULT_ABORTED_WIDTH = 1;

  // Fields of a result with amplitude.
  localparam int AMPLITUDE_RESULT_WIDTH = 64;
  localparam int AMPLITUDE_RESULT_AMPLITUDE_LSB = 32;
  localparam int AMPLITUDE_RESULT_AMPLITUDE_WIDTH = 12;
  localparam int AMPLITUDE_RESULT_AMBIENT_LSB = 44;
  localparam int AMPLITUDE_RESULT_AMBIENT_WIDTH = 12;

  // A short result.
  localparam int SHORT_RESULT_WIDTH = 32;
  localparam int SHORT_RESULT_POSITION_LSB = 0;
  localparam int SHORT_RESULT_POSITION_WIDTH = 16;
  localparam int SHORT_RESULT_CONFIDENCE_LSB = 16;
  localparam int SHORT_RESULT_CONFIDENCE_WIDTH = 9;
  localparam int SHORT_RESULT_VALID_LSB = 25;
  localparam int SHORT_RESULT_VALID_WIDTH = 1;
  localparam int SHORT_RESULT_WEAK_LSB = 26;
  localparam int SHORT_RESULT_WEAK_WIDTH = 1;
  localparam int SHORT_RESULT_EMPTY_LSB = 27;
  localparam int SHORT_RESULT_EMPTY_WIDTH = 1;
  localparam int SHORT_RESULT_MASKED_LSB = 28;
  localparam int SHORT_RESULT_MASKED_WIDTH = 1;
  localparam int SHORT_RESULT_SATURATED_LSB = 29;
  localparam int SHORT_RESULT_SATURATED_WIDTH = 1;
  localparam int SHORT_RESULT_SECOND_LSB = 30;
  localparam int SHORT_RESULT_SECOND_WIDTH = 1;
  localparam int SHORT_RESULT_ABORTED_LSB = 31;
  localparam int SHORT_RESULT_ABORTED_WIDTH = 1;

  function automatic bit is_register(input logic [11:0] offset);
    is_register = (offset <= 12'h030)
        || (offset >= 12'h040 && offset <= 12'h14c);
  endfunction

  function automatic bit is_writable(input logic [11:0] offset);
    is_writable = offset == 12'h040
        || (offset >= 12'h048 && offset <= 12'h050)
        || (offset >= 12'h05c && offset <= 12'h100)
        || (offset >= 12'h10c && offset <= 12'h114)
        || (offset >= 12'h124 && offset <= 12'h14c);
  endfunction

endpackage

`default_nettype wire
