// SPDX-License-Identifier: Apache-2.0
// The registers that software only reads: constants (identity, options and parameters of the configuration, on which results and software
// depend) and the status of frames and lines. Combinational. POOL, ENGINES and SHARES read as 0 without HAS_SCHEDULE.
//
// Latency: none.
// Cost: a multiplexer.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_read_only_registers #(
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
    parameter int BUFFER_LINES = 324
) (
    input  logic [11:0] offset_i,
    output logic [31:0] data_o,              // 0 at an offset of another register
    // status
    input  logic        busy_i,
    input  logic [ 2:0] state_i,
    input  logic [15:0] level_i,
    input  logic [31:0] frame_count_i,
    input  logic [31:0] frame_cycles_i,
    input  logic [31:0] frame_crc_i,
    input  logic [31:0] lost_lines_i,
    input  logic [31:0] lost_acquisitions_i,
    input  logic [15:0] shot_state_i,
    input  logic [31:0] parity_errors_i,
    input  logic        self_test_busy_i,
    input  logic        self_test_passed_i
);

  always_comb begin
    data_o = '0;
    case (offset_i)
      dtof_registers_pkg::ID: data_o = dtof_registers_pkg::ID_VALUE;
      dtof_registers_pkg::VERSION: data_o = dtof_registers_pkg::VERSION_VALUE;
      dtof_registers_pkg::READOUT: begin
        data_o[dtof_registers_pkg::READOUT_NUMBER_LSB+:8] = 8'(READOUT);
        data_o[dtof_registers_pkg::READOUT_SCHEDULE_LSB] = (HAS_SCHEDULE != 0);
        data_o[dtof_registers_pkg::READOUT_TIME_GATE_LSB] = (TIME_GATE != 0);
        data_o[dtof_registers_pkg::READOUT_RASTER_ORDER_LSB] = (RASTER_ORDER != 0);
        data_o[dtof_registers_pkg::READOUT_SECOND_TARGET_LSB] = (SECOND_TARGET != 0);
        data_o[dtof_registers_pkg::READOUT_PRIOR_LSB] = (PRIOR != 0);
        data_o[dtof_registers_pkg::READOUT_AMPLITUDE_LSB] = (AMPLITUDE != 0);
        data_o[dtof_registers_pkg::READOUT_PARITY_LSB] = (PARITY != 0);
        data_o[dtof_registers_pkg::READOUT_SELF_TEST_LSB] = (SELF_TEST != 0);
        data_o[dtof_registers_pkg::READOUT_CLOCK_WAITS_LSB] = (CLOCK_WAITS != 0);
        data_o[dtof_registers_pkg::READOUT_SOURCE_WAITS_LSB] = (SOURCE_WAITS != 0);
        data_o[dtof_registers_pkg::READOUT_RAW_HISTOGRAM_LSB] = (RAW_HISTOGRAM != 0);
      end
      dtof_registers_pkg::SIZE: begin
        data_o[dtof_registers_pkg::SIZE_COLUMNS_LSB+:16] = 16'(SRAM_NUM);
        data_o[dtof_registers_pkg::SIZE_ROWS_LSB+:16] = 16'(PIXELS_PER_SRAM);
      end
      dtof_registers_pkg::WIDTHS: begin
        data_o[dtof_registers_pkg::WIDTHS_TIMESTAMP_LSB+:8] = 8'(NP);
        data_o[dtof_registers_pkg::WIDTHS_FRACTION_LSB+:8] = 8'(FRACTION_WIDTH);
        data_o[dtof_registers_pkg::WIDTHS_CONFIDENCE_LSB+:8] = 8'(CONFIDENCE_WIDTH);
        data_o[dtof_registers_pkg::WIDTHS_ACQUISITIONS_LSB+:8] = 8'(ACQ_WIDTH);
      end
      dtof_registers_pkg::LINES: begin
        data_o[dtof_registers_pkg::LINES_ACQUISITION_LSB+:16] = 16'(PIXELS_PER_SRAM * SLOTS);
        data_o[dtof_registers_pkg::LINES_BUFFER_LSB+:16] = 16'(BUFFER_LINES);
      end
      dtof_registers_pkg::SLOTS: data_o[dtof_registers_pkg::SLOTS_VALUE_LSB+:8] = 8'(SLOTS);
      dtof_registers_pkg::RAW_BINS: data_o[dtof_registers_pkg::RAW_BINS_VALUE_LSB+:17] = 17'(RAW_BINS);
      dtof_registers_pkg::HISTOGRAM: begin
        data_o[dtof_registers_pkg::HISTOGRAM_COUNT_WIDTH_LSB+:8] = 8'(COUNT_WIDTH);
        data_o[dtof_registers_pkg::HISTOGRAM_NB_LSB+:8] = 8'(NB);
        data_o[dtof_registers_pkg::HISTOGRAM_WINDOW_CENTRED_LSB] = (WINDOW_CENTRED != 0);
      end
      dtof_registers_pkg::POINTER: begin
        data_o[dtof_registers_pkg::POINTER_STEP_LSB+:15] = 15'(POINTER_STEP);
        data_o[dtof_registers_pkg::POINTER_GUARD_LSB+:17] = 17'(GUARD);
      end
      dtof_registers_pkg::POOL:
      if (HAS_SCHEDULE != 0) begin
        data_o[dtof_registers_pkg::POOL_GROUP_SIZE_LSB+:8] = 8'(GROUP_SIZE);
        data_o[dtof_registers_pkg::POOL_LABELS_LSB+:4] = 4'(LABELS);
        data_o[dtof_registers_pkg::POOL_SCORE_BITS_LSB+:4] = 4'(SCORE_BITS);
        data_o[dtof_registers_pkg::POOL_OFFSET_BITS_LSB+:4] = 4'(OFFSET_BITS);
        data_o[dtof_registers_pkg::POOL_ADVANTAGE_WIDTH_LSB+:4] = 4'(ADVANTAGE_WIDTH);
        data_o[dtof_registers_pkg::POOL_POINTER_SHIFT_LSB+:4] = 4'(POINTER_SHIFT);
        data_o[dtof_registers_pkg::POOL_CELL_SHIFT_LSB+:4] = 4'(CELL_SHIFT);
      end
      dtof_registers_pkg::ENGINES:
      if (HAS_SCHEDULE != 0) begin
        data_o[dtof_registers_pkg::ENGINES_COLUMNS_LSB+:16] = 16'(ENGINE_COLUMNS);
        data_o[dtof_registers_pkg::ENGINES_RIVAL_MOVES_LSB] = (RIVAL_MOVES != 0);
      end
      dtof_registers_pkg::SHARES:
      if (HAS_SCHEDULE != 0) begin
        data_o[dtof_registers_pkg::SHARES_COARSE_LSB+:8] = 8'(COARSE_SHARE);
        data_o[dtof_registers_pkg::SHARES_TRACK_LSB+:8] = 8'(TRACK_SHARE);
      end
      dtof_registers_pkg::STATUS: begin
        data_o[dtof_registers_pkg::STATUS_BUSY_LSB] = busy_i;
        data_o[dtof_registers_pkg::STATUS_STATE_LSB+:3] = state_i;
        data_o[dtof_registers_pkg::STATUS_SELF_TEST_LSB] = self_test_busy_i;
        data_o[dtof_registers_pkg::STATUS_PASSED_LSB] = self_test_passed_i;
        data_o[dtof_registers_pkg::STATUS_LEVEL_LSB+:16] = level_i;
      end
      dtof_registers_pkg::FRAME_COUNT: data_o = frame_count_i;
      dtof_registers_pkg::FRAME_CYCLES: data_o = frame_cycles_i;
      dtof_registers_pkg::FRAME_CRC: data_o = frame_crc_i;
      dtof_registers_pkg::LOST_LINES: data_o = lost_lines_i;
      dtof_registers_pkg::LOST_ACQUISITIONS: data_o = lost_acquisitions_i;
      dtof_registers_pkg::PARITY_ERRORS: data_o = parity_errors_i;
      dtof_registers_pkg::SHOT_STATE: data_o = 32'(shot_state_i);
      default: begin
      end
    endcase
  end

endmodule

`default_nettype wire
