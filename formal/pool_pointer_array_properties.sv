// SPDX-License-Identifier: Apache-2.0
// Proves the assertions of the RTL in the composition in which they must hold: dtof_pool_pointer_array with its engine, with free ports,
// except for the contract of the TDC stream. The words come in order. Each frame has three acquisitions, one in each phase.
//
// With FIXED = 1 source and sink never wait and frames follow each other without a pause. All control is then constant, and a bounded proof
// covers whole frames: each has each pixel's word once, after its last acquisition and before done.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_pointer_array_properties #(
    parameter int COLUMNS = 2,
    parameter int PIXELS = 2,
    parameter int LABELS = 2,
    parameter int PRIOR = 1,
    parameter int SECOND_TARGET = 0,
    parameter int FIXED = 0,
    localparam int NP = 8,
    localparam int SLOTS = 2,
    localparam int ACQ_WIDTH = 4,
    localparam int WORDS = COLUMNS * PIXELS,
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(COLUMNS),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS),
    localparam int DEPTH_WIDTH = dtof_pkg::pool_result_width(4, SECOND_TARGET),
    localparam int TDATA_WIDTH = COLUMN_WIDTH + ROW_WIDTH + DEPTH_WIDTH
) (
    input logic                  clk_i,
    input logic                  start_i,
    input logic                  smooth_i,
    input logic                  prior_i,
    input logic                  tdc_valid_i,
    input logic [COLUMNS*NP-1:0] timestamp_i,
    input logic                  tready_i
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic start, valid, ready, tvalid, tready, tlast, busy, done;
  logic [TDATA_WIDTH-1:0] tdata;

  assign start = start_i || FIXED != 0;
  assign valid = tdc_valid_i || FIXED != 0;
  assign tready = tready_i || FIXED != 0;

  dtof_pool_pointer_array #(
      .NP              (NP),
      .PIXELS_PER_SRAM (PIXELS),
      .SRAM_NUM        (COLUMNS),
      .SLOTS           (SLOTS),
      .COUNT_WIDTH     (4),
      .LABELS          (LABELS),
      .SCORE_BITS      (1),
      .OFFSET_BITS     (0),
      .ADVANTAGE_WIDTH (4),
      .POINTER_SHIFT   (0),
      .SECOND_TARGET   (SECOND_TARGET),
      .PRIOR           (PRIOR),
      .ENGINE_COLUMNS  (2),
      .ACQ_WIDTH       (ACQ_WIDTH),
      .BROADCAST_STAGES(1)
  ) u_dut (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .sram_cfg_i     ('0),
      .start_i        (start),
      .acq_num_i      (ACQ_WIDTH'(3)),
      .gate_begin_i   ('0),
      .gate_end_i     ('0),
      .coarse_end_i   (ACQ_WIDTH'(1)),
      .track_end_i    (ACQ_WIDTH'(2)),
      .smooth_i       (smooth_i),
      .template_i     ('0),
      .prior_i        (prior_i),
      .busy_o         (busy),
      .done_o         (done),
      .tdc_valid_i    (valid),
      .tdc_ready_o    (ready),
      .tdc_timestamp_i(timestamp_i),
      .result_tvalid_o(tvalid),
      .result_tready_i(tready),
      .result_tdata_o (tdata),
      .result_tlast_o (tlast)
  );

  // A frame: its acquisitions at the source, its words at the sink.
  logic frame_q;
  logic [1:0] frames_q;  // counts to 2
  logic [ACQ_WIDTH-1:0] acquisitions_q;
  logic [7:0] place_q, column_q, row_q;
  logic all_words_q, taken, sent, last_word;

  assign taken = ready && valid;
  assign sent = tvalid && tready;
  assign last_word = 32'(column_q) == COLUMNS - 1 && 32'(row_q) == PIXELS - 1;

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      frame_q <= 1'b0;
      frames_q <= '0;
      acquisitions_q <= '0;
      {place_q, column_q, row_q} <= '0;
      all_words_q <= 1'b0;
    end else begin
      frame_q <= (start && !frame_q) || (frame_q && !done);
      if (done && frames_q != 2'd2) frames_q <= frames_q + 1'b1;
      if (start && !frame_q) begin
        acquisitions_q <= '0;
        all_words_q <= 1'b0;
      end else begin
        if (taken && 32'(place_q) == PIXELS * SLOTS - 1) acquisitions_q <= acquisitions_q + 1'b1;
        if (sent && last_word) all_words_q <= 1'b1;
      end
      if (taken) place_q <= (32'(place_q) == PIXELS * SLOTS - 1) ? '0 : place_q + 1'b1;
      if (sent) begin
        row_q <= (32'(row_q) == PIXELS - 1) ? '0 : row_q + 1'b1;
        if (32'(row_q) == PIXELS - 1) column_q <= last_word ? '0 : column_q + 1'b1;
      end
    end
  end

  `ASSUME(m_contiguous, place_q == '0 || valid)
  `PROVE(a_busy, !done || busy)
  `PROVE(a_place, !tvalid || tdata[DEPTH_WIDTH+:COLUMN_WIDTH+ROW_WIDTH] == {COLUMN_WIDTH'(column_q), ROW_WIDTH'(row_q)})
  `PROVE(a_last, !tvalid || tlast == last_word)
  generate
    if (FIXED != 0) begin : g_whole_frames
      `PROVE(a_busy_for_a_frame, busy == frame_q)
      `PROVE(a_words_of_a_frame, !tvalid || (frame_q && !all_words_q && acquisitions_q == ACQ_WIDTH'(3)))
      `PROVE(a_done_behind_all, !done || (frame_q && all_words_q && acquisitions_q == ACQ_WIDTH'(3)))
    end
  endgenerate
  `GOAL(frames_q == 2'd2)

endmodule

`default_nettype wire
