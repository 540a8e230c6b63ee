// SPDX-License-Identifier: Apache-2.0
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_pointer_array_properties #(
    parameter int COLUMNS = 2,
    parameter int PIXELS = 2,
    parameter int FREE = 1,
    localparam int NP = 8,
    localparam int ACQ_WIDTH = 4,
    localparam int DEPTH_WIDTH = dtof_pkg::pool_result_width(4, 0),
    localparam int TDATA_WIDTH = dtof_pkg::index_width(COLUMNS) + dtof_pkg::index_width(PIXELS) + DEPTH_WIDTH
) (
    input logic                  clk_i,
    input logic                  start_i,
    input logic                  tdc_valid_i,
    input logic [COLUMNS*NP-1:0] timestamp_i,
    input logic                  tready_i
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic busy, done, ready, tvalid, tlast;
  logic [TDATA_WIDTH-1:0] tdata;
  logic [7:0] place_q;

  dtof_pool_pointer_array #(
      .NP              (NP),
      .PIXELS_PER_SRAM (PIXELS),
      .SRAM_NUM        (COLUMNS),
      .SLOTS           (2),
      .COUNT_WIDTH     (4),
      .LABELS          (2),
      .SCORE_BITS      (1),
      .OFFSET_BITS     (0),
      .ADVANTAGE_WIDTH (4),
      .POINTER_SHIFT   (0),
      .PRIOR           (1),
      .ENGINE_COLUMNS  (2),
      .ACQ_WIDTH       (ACQ_WIDTH),
      .BROADCAST_STAGES(1)
  ) u_dut (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .sram_cfg_i     ('0),
      .start_i        (FREE != 0 ? start_i : 1'b1),
      .acq_num_i      (ACQ_WIDTH'(3)),
      .gate_begin_i   ('0),
      .gate_end_i     ('0),
      .coarse_end_i   (ACQ_WIDTH'(1)),
      .track_end_i    (ACQ_WIDTH'(2)),
      .smooth_i       (1'b1),
      .template_i     ('0),
      .prior_i        (1'b1),
      .busy_o         (busy),
      .done_o         (done),
      .tdc_valid_i    (FREE != 0 ? tdc_valid_i : 1'b1),
      .tdc_ready_o    (ready),
      .tdc_timestamp_i(timestamp_i),
      .result_tvalid_o(tvalid),
      .result_tready_i(FREE != 0 ? tready_i : 1'b1),
      .result_tdata_o (tdata),
      .result_tlast_o (tlast)
  );

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      place_q <= '0;
    end else if (ready && (tdc_valid_i || FREE == 0)) begin
      place_q <= (32'(place_q) == PIXELS * 2 - 1) ? '0 : place_q + 1'b1;
    end
  end
  `ASSUME(m_contiguous, place_q == '0 || tdc_valid_i)
  `PROVE(a_busy, !done || busy)
  `GOAL(done)

endmodule

`default_nettype wire
