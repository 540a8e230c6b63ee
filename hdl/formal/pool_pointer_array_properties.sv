// SPDX-License-Identifier: Apache-2.0
// The assertions of the RTL in the composition in which they must hold: pool_pointer_array with everything free at its
// ports but the contract of the TDC stream and of the schedule.
`include "properties.svh"

module pool_pointer_array_properties #(
    parameter int PIXELS = 2,
    parameter int SRAM_NUM = 2,
    parameter int ACQ_WIDTH = 4,
    localparam int NP = 8,
    localparam int SLOTS = 2,
    localparam int TDATA_WIDTH = dtof_pkg::index_width(SRAM_NUM) + dtof_pkg::index_width(PIXELS) + 16
        + dtof_pkg::pool_confidence_width(4)
) (
    input logic                   clk_i,
    input logic                   start_i,
    input logic [  ACQ_WIDTH-1:0] acq_num_i,
    input logic [  ACQ_WIDTH-1:0] coarse_end_i,
    input logic [  ACQ_WIDTH-1:0] track_end_i,
    input logic [  ACQ_WIDTH-1:0] late_begin_i,
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

  pool_pointer_array #(
      .NP               (NP),
      .PIXELS_PER_SRAM  (PIXELS),
      .SRAM_NUM         (SRAM_NUM),
      .SLOTS            (SLOTS),
      .COUNT_WIDTH      (4),
      .GROUP_SIZE       (8),
      .DARK_LABELS      (2),
      .DARK_SCORE_BITS  (1),
      .BRIGHT_LABELS    (2),
      .BRIGHT_SCORE_BITS(1),
      .BRIGHT_FROM      (6),
      .OFFSET_BITS      (0),
      .ADVANTAGE_WIDTH  (4),
      .POINTER_SHIFT    (0),
      .RIVAL_MOVES      (1),
      .ENGINE_COLUMNS   (2),
      .ACQ_WIDTH        (ACQ_WIDTH)
  ) u_dut (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .start_i        (start_i),
      .acq_num_i      (acq_num_i),
      .coarse_end_i   (coarse_end_i),
      .track_end_i    (track_end_i),
      .late_begin_i   (late_begin_i),
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
  `ASSUME(m_schedule, coarse_end_i <= track_end_i && track_end_i <= late_begin_i && late_begin_i <= acq_num_i)
  `PROVE(a_idle_or_busy, busy || state == dtof_pkg::STATE_IDLE)
  `GOAL(busy && ready)

endmodule
