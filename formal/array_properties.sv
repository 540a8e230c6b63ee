// SPDX-License-Identifier: Apache-2.0
// Proves the assertions of the RTL in the composition in which they must hold: dtof_array with free ports, except for the contract of
// the TDC stream.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module array_properties #(
    parameter int READOUT = 3,
    parameter int NP = 3,
    parameter int NB = 2,
    parameter int PIXELS = 1,
    parameter int SRAM_NUM = 1,
    parameter int SLOTS = 1,
    parameter int COUNT_WIDTH = 1,
    parameter int CONFIDENCE_WIDTH = 1,
    parameter int POINTER_PORTS = 2,
    parameter int SIGNALLED_CLEAR = 0,
    parameter int ACQ_WIDTH = 2,
    parameter int RAW_HISTOGRAM = 0,
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS),
    localparam int TDATA_WIDTH = dtof_pkg::index_width(SRAM_NUM) + dtof_pkg::index_width(PIXELS)
        + dtof_pkg::result_width(READOUT, NP, COUNT_WIDTH, 0,
                                 dtof_pkg::kept_confidence_width(CONFIDENCE_WIDTH, COUNT_WIDTH, RAW_HISTOGRAM))
) (
    input logic                   clk_i,
    input logic                   start_i,
    input logic [  ACQ_WIDTH-1:0] acq_num_i,
    input logic                   raw_i,
    input logic [  ROW_WIDTH-1:0] raw_first_row_i,
    input logic [  ROW_WIDTH-1:0] raw_last_row_i,
    input logic                   tdc_valid_i,
    input logic [SRAM_NUM*NP-1:0] tdc_timestamp_i,
    input logic                   tready_i
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic busy, done, ready, tvalid, tlast;
  logic [2:0] state;
  logic [TDATA_WIDTH-1:0] tdata;

  dtof_array #(
      .READOUT         (READOUT),
      .NP              (NP),
      .NB              (NB),
      .PIXELS_PER_SRAM (PIXELS),
      .SRAM_NUM        (SRAM_NUM),
      .SLOTS           (SLOTS),
      .COUNT_WIDTH     (COUNT_WIDTH),
      .POINTER_STEP    (1),
      .FRACTION_BITS   (0),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .GUARD           (1),
      .WINDOW_CENTRED  (0),
      .POINTER_PORTS   (POINTER_PORTS),
      .SIGNALLED_CLEAR (SIGNALLED_CLEAR),
      .TIME_GATE       (0),
      .RAW_HISTOGRAM   (RAW_HISTOGRAM),
      .ACQ_WIDTH       (ACQ_WIDTH)
  ) u_dut (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .start_i        (start_i),
      .acq_num_i      (acq_num_i),
      .gate_begin_i   ('0),
      .gate_end_i     ('0),
      .raw_i          (raw_i),
      .raw_first_row_i(raw_first_row_i),
      .raw_last_row_i (raw_last_row_i),
      .busy_o         (busy),
      .done_o         (done),
      .state_o        (state),
      .tdc_valid_i    (tdc_valid_i),
      .tdc_ready_o    (ready),
      .tdc_timestamp_i(tdc_timestamp_i),
      .result_tvalid_o(tvalid),
      .result_tready_i(tready_i),
      .result_tdata_o (tdata),
      .result_tlast_o (tlast)
  );

  logic [7:0] place_q;
  always_ff @(posedge clk_i) begin
    if (!checking) begin
      place_q <= '0;
    end else if (ready && tdc_valid_i) begin
      place_q <= (32'(place_q) == PIXELS * SLOTS - 1) ? '0 : place_q + 1'b1;
    end
  end

  `ASSUME(m_contiguous, place_q == '0 || tdc_valid_i)
  `ASSUME(m_raw_rows, raw_first_row_i <= raw_last_row_i && 32'(raw_last_row_i) < PIXELS)
  `PROVE(a_idle_or_busy, busy || state == dtof_pkg::STATE_IDLE)
  `GOAL(done)

endmodule

`default_nettype wire
