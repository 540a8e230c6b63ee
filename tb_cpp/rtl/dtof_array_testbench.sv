// SPDX-License-Identifier: Apache-2.0

`include "dtof_macros.svh"

/// dtof_array behind ports whose C++ types are the same for every configuration, so that one driver runs
/// them all: 16 bits per column of timestamp on a bus of at least 128 bits (an array of words in C++), each
/// field of the result on its own 16-bit port. PROBE = 1 shows the writes to column 0's histogram or pointer
/// SRAM, for tests that follow the thesis's examples word by word.
module dtof_array_testbench #(
    parameter READOUT = 0,
    parameter NP = 10,
    parameter NB = 5,
    parameter PIXELS_PER_SRAM = 160,
    parameter SRAM_NUM = 8,
    parameter SLOTS = 2,
    parameter COUNT_WIDTH = 10,
    parameter POINTER_STEP = 1,
    parameter FRACTION_BITS = 0,
    parameter CONFIDENCE_WIDTH = 4,
    parameter GUARD = 46,
    parameter WINDOW_CENTRED = 0,
    parameter POINTER_PORTS = 2,
    parameter SIGNALLED_CLEAR = 0,
    parameter PARITY = 0,
    parameter TIME_GATE = 0,
    parameter RAW_HISTOGRAM = 0,
    parameter BROADCAST_STAGES = 2,
    parameter PROBE = 0,
    localparam BUS_WIDTH = SRAM_NUM > 8 ? 16 * SRAM_NUM : 128
) (
    input  logic                 clk_i,
    input  logic                 rst_ni,
    input  logic                 start_i,
    input  logic [         15:0] acq_num_i,
    input  logic [         15:0] gate_begin_i,
    input  logic [         15:0] gate_end_i,
    input  logic                 raw_i,
    input  logic [         15:0] raw_first_row_i,
    input  logic [         15:0] raw_last_row_i,
    output logic                 busy_o,
    output logic                 done_o,
    output logic [          2:0] state_o,
    output logic [          2:0] error_o,
    output logic                 parity_error_o,
    output logic                 counter_full_o,
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
    output logic [         15:0] result_confidence_o,
    output logic                 probe_write_o,
    output logic [         15:0] probe_address_o,
    output logic [         15:0] probe_data_o
);

  localparam COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM);
  localparam ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM);
  localparam FRACTION_WIDTH = dtof_pkg::fraction_width(READOUT, FRACTION_BITS);
  localparam RESULT_CONFIDENCE_WIDTH = dtof_pkg::confidence_width(READOUT, COUNT_WIDTH,
      dtof_pkg::kept_confidence_width(CONFIDENCE_WIDTH, COUNT_WIDTH, RAW_HISTOGRAM));
  localparam RESULT_WIDTH = COLUMN_WIDTH + ROW_WIDTH + NP + FRACTION_WIDTH + RESULT_CONFIDENCE_WIDTH;

  localparam FRACTION_LSB = RESULT_CONFIDENCE_WIDTH;
  localparam CODE_LSB = FRACTION_LSB + FRACTION_WIDTH;
  localparam ROW_LSB = CODE_LSB + NP;
  localparam COLUMN_LSB = ROW_LSB + ROW_WIDTH;

  logic [SRAM_NUM*NP-1:0] timestamp;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg, sram_cfg_answer;
  logic [RESULT_WIDTH-1:0] result;

  for (genvar column = 0; column < SRAM_NUM; ++column) begin : gen_timestamp
    assign timestamp[column*NP+:NP] = tdc_timestamp_i[column*16+:NP];
  end

  dtof_array #(
      .READOUT(READOUT),
      .NP(NP),
      .NB(NB),
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .SRAM_NUM(SRAM_NUM),
      .SLOTS(SLOTS),
      .COUNT_WIDTH(COUNT_WIDTH),
      .POINTER_STEP(POINTER_STEP),
      .FRACTION_BITS(FRACTION_BITS),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .GUARD(GUARD),
      .WINDOW_CENTRED(WINDOW_CENTRED),
      .POINTER_PORTS(POINTER_PORTS),
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR),
      .PARITY(PARITY),
      .TIME_GATE(TIME_GATE),
      .RAW_HISTOGRAM(RAW_HISTOGRAM),
      .ACQ_WIDTH(16),
      .BROADCAST_STAGES(BROADCAST_STAGES)
  ) u_array (
      .clk_i,
      .rst_ni,
      .sram_cfg_i(sram_cfg),
      .sram_cfg_o(sram_cfg_answer),
      .start_i,
      .acq_num_i,
      .gate_begin_i(gate_begin_i[NP-1:0]),
      .gate_end_i(gate_end_i[NP-1:0]),
      .raw_i,
      .raw_first_row_i(raw_first_row_i[ROW_WIDTH-1:0]),
      .raw_last_row_i(raw_last_row_i[ROW_WIDTH-1:0]),
      .busy_o,
      .done_o,
      .state_o,
      .error_o,
      .parity_error_o,
      .counter_full_o,
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
  if (FRACTION_WIDTH > 0) begin : gen_fraction
    assign result_fraction_o = 16'(result[FRACTION_LSB+:FRACTION_WIDTH]);
  end else begin : gen_no_fraction
    assign result_fraction_o = '0;
  end
  if (RESULT_CONFIDENCE_WIDTH > 0) begin : gen_confidence
    assign result_confidence_o = 16'(result[0+:RESULT_CONFIDENCE_WIDTH]);
  end else begin : gen_no_confidence
    assign result_confidence_o = '0;
  end

  `define DTOF_PROBE(SRAM) \
    assign probe_write_o = SRAM.write_en_i; \
    assign probe_address_o = 16'(SRAM.write_addr_i); \
    assign probe_data_o = 16'(SRAM.write_data_i);

  if (PROBE == 0) begin : gen_no_probe
    assign probe_write_o = 1'b0;
    assign probe_address_o = '0;
    assign probe_data_o = '0;
  end else if (READOUT == dtof_pkg::READOUT_EZPOINTER) begin : gen_pointer_probe
    `DTOF_PROBE(u_array.g_column[0].g_ez_pointer.u_column.u_pointer_builder.u_word_builder.u_word_sram)
  end else begin : gen_histogram_probe
    `DTOF_PROBE(u_array.g_column[0].g_interframe_histogram.u_column.u_peak_histogram.u_histogram_builder.u_histogram_sram)
  end

  // Every SRAM's side band: the stand-ins answer what they are told, which is another value in every frame.
  always_ff @(posedge clk_i) begin
    if (start_i) begin
      sram_cfg <= ~sram_cfg;
    end
  end
  `DTOF_ASSERT(a_side_band, sram_cfg_answer == sram_cfg, "an SRAM does not hear its side band")

  // The padding of the timestamp bus, of the gate and of the rows.
  logic unused;
  assign unused = &{1'b0, tdc_timestamp_i, gate_begin_i, gate_end_i, raw_first_row_i, raw_last_row_i};

endmodule
