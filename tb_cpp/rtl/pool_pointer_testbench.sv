// SPDX-License-Identifier: Apache-2.0

`include "dtof_macros.svh"

/// dtof_pool_pointer_array behind the ports of dtof_array_testbench and the schedule's: 16 bits per column of timestamp
/// on a bus of at least 128 bits, each field of the result on its own 16-bit port.
module pool_pointer_testbench #(
    parameter NP = 10,
    parameter PIXELS_PER_SRAM = 160,
    parameter SRAM_NUM = 8,
    parameter SLOTS = 2,
    parameter COUNT_WIDTH = 7,
    parameter GROUP_SIZE = 4,
    parameter LABELS = 5,
    parameter SCORE_BITS = 4,
    parameter OFFSET_BITS = 6,
    parameter ADVANTAGE_WIDTH = 7,
    parameter POINTER_SHIFT = 1,
    parameter RIVAL_MOVES = 1,
    parameter CELL_SHIFT = 9,
    parameter PARITY = 0,
    parameter TIME_GATE = 0,
    parameter SECOND_TARGET = 0,
    parameter AMPLITUDE = 0,
    parameter PRIOR = 0,
    parameter ENGINE_COLUMNS = 34,
    parameter BROADCAST_STAGES = 2,
    localparam BUS_WIDTH = SRAM_NUM > 8 ? 16 * SRAM_NUM : 128
) (
    input  logic                 clk_i,
    input  logic                 rst_ni,
    input  logic                 start_i,
    input  logic [         15:0] acq_num_i,
    input  logic [         15:0] gate_begin_i,
    input  logic [         15:0] gate_end_i,
    input  logic [         15:0] coarse_end_i,
    input  logic [         15:0] track_end_i,
    input  logic                 smooth_i,
    input  logic                 prior_i,
    input  logic [        255:0] template_i,
    output logic                 busy_o,
    output logic                 done_o,
    output logic [          2:0] state_o,
    output logic [          2:0] error_o,
    output logic                 parity_error_o,
    input  logic                 tdc_valid_i,
    output logic                 tdc_ready_o,
    input  logic [BUS_WIDTH-1:0] tdc_timestamp_i,
    output logic                 result_tvalid_o,
    input  logic                 result_tready_i,
    output logic                 result_tlast_o,
    output logic [         15:0] result_column_o,
    output logic [         15:0] result_row_o,
    output logic [         15:0] result_code_o,
    output logic [         15:0] result_fraction_o,
    output logic [         15:0] result_second_o,
    output logic [         15:0] result_amplitude_o,
    output logic [         15:0] result_ambient_o,
    output logic [         15:0] result_confidence_o,
    output logic                 probe_write_o,
    output logic [         15:0] probe_address_o,
    output logic [         15:0] probe_data_o
);

  localparam COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM);
  localparam ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM);
  localparam POSITION_WIDTH = 16;  // code and fraction
  localparam CONFIDENCE_WIDTH = dtof_pkg::pool_confidence_width(ADVANTAGE_WIDTH);
  localparam SECOND_WIDTH = SECOND_TARGET != 0 ? POSITION_WIDTH : 0;
  localparam AMPLITUDE_WIDTH = AMPLITUDE != 0 ? dtof_pkg::pool_amplitude_width(ADVANTAGE_WIDTH) : 0;
  localparam AMBIENT_WIDTH = AMPLITUDE != 0 ? dtof_pkg::POOL_BACKGROUND_WIDTH : 0;

  localparam POSITION_LSB = CONFIDENCE_WIDTH;
  localparam CODE_LSB = POSITION_LSB + POSITION_WIDTH - NP;
  localparam SECOND_LSB = POSITION_LSB + POSITION_WIDTH;
  localparam AMPLITUDE_LSB = SECOND_LSB + SECOND_WIDTH;
  localparam AMBIENT_LSB = AMPLITUDE_LSB + AMPLITUDE_WIDTH;
  localparam ROW_LSB = AMBIENT_LSB + AMBIENT_WIDTH;
  localparam COLUMN_LSB = ROW_LSB + ROW_WIDTH;
  localparam RESULT_WIDTH = COLUMN_LSB + COLUMN_WIDTH;

  logic [SRAM_NUM*NP-1:0] timestamp;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg, sram_cfg_answer;
  logic [RESULT_WIDTH-1:0] result;

  for (genvar column = 0; column < SRAM_NUM; ++column) begin : gen_timestamp
    assign timestamp[column*NP+:NP] = tdc_timestamp_i[column*16+:NP];
  end

  dtof_pool_pointer_array #(
      .NP(NP),
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .SRAM_NUM(SRAM_NUM),
      .SLOTS(SLOTS),
      .COUNT_WIDTH(COUNT_WIDTH),
      .GROUP_SIZE(GROUP_SIZE),
      .LABELS(LABELS),
      .SCORE_BITS(SCORE_BITS),
      .OFFSET_BITS(OFFSET_BITS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT(POINTER_SHIFT),
      .RIVAL_MOVES(RIVAL_MOVES),
      .CELL_SHIFT(CELL_SHIFT),
      .PARITY(PARITY),
      .TIME_GATE(TIME_GATE),
      .SECOND_TARGET(SECOND_TARGET),
      .AMPLITUDE(AMPLITUDE),
      .PRIOR(PRIOR),
      .ENGINE_COLUMNS(ENGINE_COLUMNS),
      .BROADCAST_STAGES(BROADCAST_STAGES),
      .ACQ_WIDTH(16)
  ) u_array (
      .clk_i,
      .rst_ni,
      .sram_cfg_i(sram_cfg),
      .sram_cfg_o(sram_cfg_answer),
      .start_i,
      .acq_num_i,
      .gate_begin_i(gate_begin_i[NP-1:0]),
      .gate_end_i(gate_end_i[NP-1:0]),
      .coarse_end_i,
      .track_end_i,
      .smooth_i,
      .prior_i,
      .template_i,
      .busy_o,
      .done_o,
      .state_o,
      .error_o,
      .parity_error_o,
      .tdc_valid_i,
      .tdc_ready_o,
      .tdc_timestamp_i(timestamp),
      .result_tvalid_o,
      .result_tready_i,
      .result_tdata_o(result),
      .result_tlast_o
  );

  assign result_column_o = 16'(result[COLUMN_LSB+:COLUMN_WIDTH]);
  assign result_row_o = 16'(result[ROW_LSB+:ROW_WIDTH]);
  assign result_code_o = 16'(result[CODE_LSB+:NP]);
  if (NP < POSITION_WIDTH) begin : gen_fraction
    assign result_fraction_o = 16'(result[POSITION_LSB+:POSITION_WIDTH-NP]);
  end else begin : gen_no_fraction
    assign result_fraction_o = '0;
  end
  if (SECOND_TARGET != 0) begin : gen_second
    assign result_second_o = result[SECOND_LSB+:POSITION_WIDTH];
  end else begin : gen_no_second
    assign result_second_o = '0;
  end
  if (AMPLITUDE != 0) begin : gen_amplitude
    assign result_amplitude_o = 16'(result[AMPLITUDE_LSB+:AMPLITUDE_WIDTH]);
    assign result_ambient_o = 16'(result[AMBIENT_LSB+:AMBIENT_WIDTH]);
  end else begin : gen_no_amplitude
    assign result_amplitude_o = '0;
    assign result_ambient_o = '0;
  end
  assign result_confidence_o = 16'(result[0+:CONFIDENCE_WIDTH]);

  assign probe_write_o = 1'b0;
  assign probe_address_o = '0;
  assign probe_data_o = '0;

  // Every SRAM's side band: the stand-ins answer what they are told, which is another value in every frame.
  always_ff @(posedge clk_i) begin
    if (start_i) begin
      sram_cfg <= ~sram_cfg;
    end
  end
  `DTOF_ASSERT(a_side_band, sram_cfg_answer == sram_cfg, "an SRAM does not hear its side band")

  // The padding of the timestamp bus and of the gate.
  logic unused;
  assign unused = &{1'b0, tdc_timestamp_i, gate_begin_i, gate_end_i};

endmodule
