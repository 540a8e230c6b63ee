// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pool_pointer_array with two columns: every result word is the word that poolPointer's rule gives for the timestamps, for a frame
// (FRAMES = 2: a second one with PRIOR) with an acquisition in each phase. Source and sink never wait. A timestamp is one of three codes, or
// no detection.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_pointer_rule_properties #(
    parameter int NP = 8,
    parameter int ROWS = 2,
    parameter int LABELS = 2,
    parameter int COUNT_WIDTH = 7,
    parameter int ACQUISITIONS = 3,
    parameter int COARSE_END = 1,
    parameter int TRACK_END = 2,
    parameter int FRAMES = 1,
    parameter int FIRST_TIME = 100,
    parameter int SECOND_TIME = 107,
    parameter int THIRD_TIME = 240,
    localparam int ACQ_WIDTH = 4,
    localparam int SLOTS = 2,
    localparam int WORDS = 2 * ROWS,
    localparam int W = 18,
    localparam int LINES = ROWS * SLOTS,
    localparam int CONFIDENCE_WIDTH = dtof_pkg::pool_confidence_width(7),
    localparam int RESULT_WIDTH = 16 + CONFIDENCE_WIDTH,
    localparam int TDATA_WIDTH = 1 + dtof_pkg::index_width(ROWS) + RESULT_WIDTH
) (
    input logic       clk_i,
    input logic [3:0] choices_i  // two bits a column
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic [2*NP-1:0] line;
  genvar t;
  generate
    for (t = 0; t < 2; t = t + 1) begin : g_timestamp
      assign line[t*NP+:NP] = (choices_i[2*t+:2] == 2'd0) ? {NP{1'b1}} : (choices_i[2*t+:2] == 2'd1) ? NP'(FIRST_TIME)
          : (choices_i[2*t+:2] == 2'd2) ? NP'(SECOND_TIME) : NP'(THIRD_TIME);
    end
  endgenerate

  logic busy, done, ready, tvalid, tlast, start;
  logic [TDATA_WIDTH-1:0] tdata;
  logic [7:0] frame_q, acquisition_q, line_q, word_q;

  assign start = checking && !busy && 32'(frame_q) < FRAMES;

  dtof_pool_pointer_array #(
      .NP              (NP),
      .PIXELS_PER_SRAM (ROWS),
      .SRAM_NUM        (2),
      .SLOTS           (SLOTS),
      .COUNT_WIDTH     (COUNT_WIDTH),
      .LABELS          (LABELS),
      .PRIOR           (1),
      .ENGINE_COLUMNS  (2),
      .ACQ_WIDTH       (ACQ_WIDTH),
      .BROADCAST_STAGES(1)
  ) u_dut (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .sram_cfg_i     ('0),
      .start_i        (start),
      .acq_num_i      (ACQ_WIDTH'(ACQUISITIONS)),
      .gate_begin_i   ('0),
      .gate_end_i     ('0),
      .coarse_end_i   (ACQ_WIDTH'(COARSE_END)),
      .track_end_i    (ACQ_WIDTH'(TRACK_END)),
      .smooth_i       (1'b1),
      .template_i     ('0),
      .prior_i        (1'b1),
      .busy_o         (busy),
      .done_o         (done),
      .tdc_valid_i    (1'b1),
      .tdc_ready_o    (ready),
      .tdc_timestamp_i(line),
      .result_tvalid_o(tvalid),
      .result_tready_i(1'b1),
      .result_tdata_o (tdata),
      .result_tlast_o (tlast)
  );

  // The rule needs whole acquisitions: the lines before are kept until the last one comes.
  logic [(LINES-1)*2*NP-1:0] before_q;
  logic [LINES*2*NP-1:0] lines;
  logic [WORDS*SLOTS*NP-1:0] timestamps;
  logic last_line;

  assign last_line = 32'(line_q) == LINES - 1;
  assign lines = {line, before_q};

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      {frame_q, acquisition_q, line_q, word_q} <= '0;
    end else begin
      if (ready) begin
        before_q <= lines[2*NP+:(LINES-1)*2*NP];
        line_q <= last_line ? '0 : line_q + 1'b1;
        if (last_line) acquisition_q <= (32'(acquisition_q) == ACQUISITIONS - 1) ? '0 : acquisition_q + 1'b1;
      end
      if (tvalid) word_q <= word_q + 1'b1;
      if (done) frame_q <= frame_q + 1'b1;
    end
  end

  logic [(FRAMES+1)*LABELS-1:0] used;
  logic [(FRAMES+1)*LABELS*W-1:0] cells;
  assign used[0+:LABELS] = '0;  // no prior in the first frame after reset
  assign cells[0+:LABELS*W] = '0;

  genvar c, l, f;
  generate
    for (c = 0; c < 2; c = c + 1) begin : g_column
      for (l = 0; l < LINES; l = l + 1) begin : g_line
        assign timestamps[(c*LINES+l)*NP+:NP] = lines[(l*2+c)*NP+:NP];
      end
    end

    for (f = 0; f < FRAMES; f = f + 1) begin : g_frame
      logic [WORDS*W-1:0] positions, confidences;

      pool_pointer_reference #(
          .W           (W),
          .NP          (NP),
          .ROWS        (ROWS),
          .COUNT_WIDTH (COUNT_WIDTH),
          .LABELS      (LABELS),
          .STORED_BITS ((LABELS == 5) ? 2 : 3),
          .ACQUISITIONS(ACQUISITIONS),
          .COARSE_END  (COARSE_END),
          .TRACK_END   (TRACK_END)
      ) u_reference (
          .clk_i        (clk_i),
          .rst_ni       (checking),
          .take_i       (ready && last_line && 32'(frame_q) == f),
          .acquisition_i(W'(acquisition_q)),
          .timestamps_i (timestamps),
          .used_i       (used[f*LABELS+:LABELS]),
          .used_cells_i (cells[f*LABELS*W+:LABELS*W]),
          .positions_o  (positions),
          .confidences_o(confidences),
          .used_o       (used[(f+1)*LABELS+:LABELS]),
          .cells_o      (cells[(f+1)*LABELS*W+:LABELS*W])
      );

      for (l = 0; l < WORDS; l = l + 1) begin : g_word
        `PROVE(a_word, !(tvalid && 32'(word_q) == f * WORDS + l)
               || tdata[RESULT_WIDTH-1:0] == {positions[l*W+:16], confidences[l*W+:CONFIDENCE_WIDTH]})
      end
    end
  endgenerate

  `GOAL(32'(frame_q) == FRAMES && 32'(word_q) == FRAMES * WORDS)

  logic unused;
  assign unused = ^{tlast, tdata};

endmodule

`default_nettype wire
