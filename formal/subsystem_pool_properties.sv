// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_subsystem with poolPointer, from reset through the writes of its registers and two continuous frames, the second with PRIOR:
// every result word at the sink is the word that a second array gives for the lines at the source. The second array has none of the subsystem
// around it. Each timestamp is one of two codes. The clocks in which source and sink wait are fixed, so all control is constant.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module subsystem_pool_properties #(
    parameter int NP = 8,
    parameter int COLUMNS = 2,
    parameter int ROWS = 2,
    parameter int SLOTS = 2,
    parameter int ACQUISITIONS = 3,
    parameter int COUNT_WIDTH = 4,
    parameter int LABELS = 2,
    parameter int PRIOR = 1,
    parameter int GAPS = 0,  // 0: source and sink never wait; else the seed of the clocks in which they wait
    parameter int FIRST_TIME = 100,   // a timestamp is one of two codes
    parameter int SECOND_TIME = 240,
    parameter int BUFFER_LINES = 2,
    parameter int MOST_CLOCKS = 1400,  // from the first write to the end of two frames
    localparam int TDATA_WIDTH = 8 * ((COLUMNS * NP + 7) / 8)
) (
    input logic               clk_i,
    input logic [COLUMNS-1:0] second_i  // the timestamp of a column is SECOND_TIME
);

  localparam int COARSE_END = 1;
  localparam int TRACK_END = 2;
  localparam int FRAMES = 2;
  localparam int ACQUISITION_LINES = ROWS * SLOTS;
  localparam int FRAME_LINES = ACQUISITIONS * ACQUISITION_LINES;

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  // Writes of the registers after reset, two clocks each, which the first one's wait states precede. The last one starts continuous frames.
  localparam int WRITES = 5;
  logic [11:0] clock_q;
  logic psel, penable, pready;
  logic [11:0] paddr;
  logic [31:0] pwdata;

  always_ff @(posedge clk_i) begin
    clock_q <= !checking ? '0 : clock_q + 12'(!(psel && penable) || pready);
  end

  assign psel = (32'(clock_q) < 2 * WRITES);
  assign penable = clock_q[0];

  always_comb begin
    paddr = dtof_registers_pkg::CONTROL;
    pwdata = (32'd1 << dtof_registers_pkg::CONTROL_START_LSB) | (32'd1 << dtof_registers_pkg::CONTROL_CONTINUOUS_LSB);
    if (32'(clock_q) < 2 * WRITES - 2) begin
      case (clock_q[3:1])
        3'd0: begin
          paddr = dtof_registers_pkg::ACQUISITIONS;
          pwdata = 32'(ACQUISITIONS);
        end
        3'd1: begin
          paddr = dtof_registers_pkg::COARSE_END;
          pwdata = 32'(COARSE_END);
        end
        3'd2: begin
          paddr = dtof_registers_pkg::TRACK_END;
          pwdata = 32'(TRACK_END);
        end
        default: begin
          paddr = dtof_registers_pkg::OUTPUT;
          pwdata = (32'(PRIOR) << dtof_registers_pkg::OUTPUT_PRIOR_LSB) | (32'd1 << dtof_registers_pkg::OUTPUT_SMOOTH_LSB);
        end
      endcase
    end
  end

  // Clocks in which source and sink wait: with GAPS about a quarter of the clocks each.
  logic s_tvalid, s_tready, m_tvalid, m_tready;
  logic [15:0] gaps_q;

  always_ff @(posedge clk_i) begin
    gaps_q <= !checking ? 16'(GAPS) : {gaps_q[14:0], gaps_q[15] ^ gaps_q[13] ^ gaps_q[12] ^ gaps_q[10]};
  end

  assign s_tvalid = GAPS == 0 || gaps_q[1:0] != 2'd0;
  assign m_tready = GAPS == 0 || gaps_q[9:8] != 2'd0;

  logic [TDATA_WIDTH-1:0] line;
  genvar c;
  generate
    for (c = 0; c < COLUMNS; c = c + 1) begin : g_timestamp
      assign line[c*NP+:NP] = second_i[c] ? NP'(SECOND_TIME) : NP'(FIRST_TIME);
    end
  endgenerate

  // Lines are counted when the source delivers them.
  logic s_tlast, taken;
  logic [1:0] source_frame_q;  // counts to FRAMES + 1
  logic [7:0] acquisition_q, line_q;

  assign taken = s_tvalid && s_tready;
  assign s_tlast = (32'(line_q) == ACQUISITION_LINES - 1);

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      source_frame_q <= '0;
      acquisition_q <= '0;
      line_q <= '0;
    end else if (taken) begin
      line_q <= s_tlast ? '0 : line_q + 1'b1;
      if (s_tlast) begin
        acquisition_q <= (32'(acquisition_q) == ACQUISITIONS - 1) ? '0 : acquisition_q + 1'b1;
        if (32'(acquisition_q) == ACQUISITIONS - 1 && 32'(source_frame_q) <= FRAMES) begin
          source_frame_q <= source_frame_q + 1'b1;
        end
      end
    end
  end

  logic m_tuser, m_tlast;
  logic [63:0] m_tdata;
  logic pslverr, irq, shot;
  logic [31:0] prdata;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] cfg;

  dtof_subsystem #(
      .READOUT         (dtof_pkg::READOUT_POOLPOINTER),
      .NP              (NP),
      .PIXELS_PER_SRAM (ROWS),
      .SRAM_NUM        (COLUMNS),
      .SLOTS           (SLOTS),
      .COUNT_WIDTH     (COUNT_WIDTH),
      .ACQ_WIDTH       (4),
      .LABELS          (LABELS),
      .SCORE_BITS      (1),
      .OFFSET_BITS     (0),
      .ADVANTAGE_WIDTH (4),
      .POINTER_SHIFT   (0),
      .PRIOR           (PRIOR),
      .ENGINE_COLUMNS  (2),
      .BROADCAST_STAGES(1),
      .CLOCK_WAITS     (1),
      .BUFFER_LINES    (BUFFER_LINES)
  ) u_dut (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .scan_mode_i    (1'b0),
      .sram_cfg_i     ('0),
      .sram_cfg_o     (cfg),
      .psel_i         (psel),
      .penable_i      (penable),
      .pwrite_i       (1'b1),
      .paddr_i        (paddr),
      .pwdata_i       (pwdata),
      .pstrb_i        (4'hf),
      .pready_o       (pready),
      .prdata_o       (prdata),
      .pslverr_o      (pslverr),
      .irq_o          (irq),
      .shot_o         (shot),
      .s_axis_tvalid_i(s_tvalid),
      .s_axis_tready_o(s_tready),
      .s_axis_tdata_i (line),
      .s_axis_tlast_i (s_tlast),
      .m_axis_tvalid_o(m_tvalid),
      .m_axis_tready_i(m_tready),
      .m_axis_tdata_o (m_tdata),
      .m_axis_tuser_o (m_tuser),
      .m_axis_tlast_o (m_tlast)
  );

  // Words are counted when the sink takes them: column by column.
  logic [7:0] sink_word_q, sink_frame_q, sink_row_q, sink_column_q;
  logic sink_first, sink_last, last_row, last_column;

  assign last_row = (32'(sink_row_q) == ROWS - 1);
  assign last_column = (32'(sink_column_q) == COLUMNS - 1);
  assign sink_first = (sink_row_q == '0) && (sink_column_q == '0);
  assign sink_last = last_row && last_column;

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      sink_word_q <= '0;
      sink_frame_q <= '0;
      sink_row_q <= '0;
      sink_column_q <= '0;
    end else if (m_tvalid && m_tready) begin
      sink_word_q <= sink_word_q + 1'b1;
      if (sink_last) begin
        sink_frame_q <= sink_frame_q + 1'b1;
      end
      if (last_row) begin
        sink_column_q <= last_column ? '0 : sink_column_q + 1'b1;
      end
      sink_row_q <= last_row ? '0 : sink_row_q + 1'b1;
    end
  end

  // The second array is the reference: its settings are constants, it takes the lines of an acquisition one after the other as soon as the
  // source has delivered all of them, and nothing waits for its words.
  localparam int WORDS = ROWS * COLUMNS;
  localparam int CONFIDENCE_WIDTH = dtof_pkg::pool_confidence_width(4);
  localparam int RESULT_WIDTH = 16 + CONFIDENCE_WIDTH;
  localparam int PLACE_WIDTH = dtof_pkg::index_width(COLUMNS) + dtof_pkg::index_width(ROWS);
  localparam int LINE_WIDTH = COLUMNS * NP;
  logic [FRAMES*FRAME_LINES*LINE_WIDTH-1:0] lines_q;
  logic [7:0] delivered_q, played_q, result_q, frame_q;
  logic start, busy, done, valid, ready, tvalid, tlast;
  logic [PLACE_WIDTH+RESULT_WIDTH-1:0] tdata;
  logic [FRAMES*WORDS*RESULT_WIDTH-1:0] results_q;
  logic [FRAMES*WORDS*64-1:0] words_q;
  integer i;

  assign start = checking && !busy && 32'(frame_q) < FRAMES;
  assign valid = 32'(delivered_q) >= (32'(played_q) / ACQUISITION_LINES + 1) * ACQUISITION_LINES;

  dtof_pool_pointer_array #(
      .NP              (NP),
      .PIXELS_PER_SRAM (ROWS),
      .SRAM_NUM        (COLUMNS),
      .SLOTS           (SLOTS),
      .COUNT_WIDTH     (COUNT_WIDTH),
      .LABELS          (LABELS),
      .SCORE_BITS      (1),
      .OFFSET_BITS     (0),
      .ADVANTAGE_WIDTH (4),
      .POINTER_SHIFT   (0),
      .PRIOR           (PRIOR),
      .ENGINE_COLUMNS  (2),
      .ACQ_WIDTH       (4),
      .BROADCAST_STAGES(1)
  ) u_reference (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .sram_cfg_i     ('0),
      .start_i        (start),
      .acq_num_i      (4'(ACQUISITIONS)),
      .gate_begin_i   ('0),
      .gate_end_i     ('0),
      .coarse_end_i   (4'(COARSE_END)),
      .track_end_i    (4'(TRACK_END)),
      .smooth_i       (1'b1),
      .template_i     ('0),
      .prior_i        (PRIOR != 0),
      .busy_o         (busy),
      .done_o         (done),
      .tdc_valid_i    (valid),
      .tdc_ready_o    (ready),
      .tdc_timestamp_i(lines_q[32'(played_q)*LINE_WIDTH+:LINE_WIDTH]),
      .result_tvalid_o(tvalid),
      .result_tready_i(1'b1),
      .result_tdata_o (tdata),
      .result_tlast_o (tlast)
  );

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      {delivered_q, played_q, result_q, frame_q} <= '0;
    end else begin
      if (taken && 32'(delivered_q) < FRAMES * FRAME_LINES) delivered_q <= delivered_q + 1'b1;
      if (valid && ready) played_q <= played_q + 1'b1;
      if (tvalid) result_q <= result_q + 1'b1;
      if (done) frame_q <= frame_q + 1'b1;
    end
    for (i = 0; i < FRAMES * FRAME_LINES; i = i + 1) begin
      if (taken && 32'(delivered_q) == i) lines_q[i*LINE_WIDTH+:LINE_WIDTH] <= line[LINE_WIDTH-1:0];
    end
    for (i = 0; i < FRAMES * WORDS; i = i + 1) begin
      if (tvalid && 32'(result_q) == i) results_q[i*RESULT_WIDTH+:RESULT_WIDTH] <= tdata[RESULT_WIDTH-1:0];
      if (m_tvalid && m_tready && 32'(sink_word_q) == i) words_q[i*64+:64] <= m_tdata;
    end
  end

  genvar k;
  generate
    for (k = 0; k < FRAMES * WORDS; k = k + 1) begin : g_word
      result_word_rules #(
          .COLUMN          (k % WORDS / ROWS),
          .ROW             (k % ROWS),
          .CONFIDENCE_WIDTH(16)
      ) u_rules (
          .checking    (checking),
          .here_i      (32'(sink_word_q) > k && 32'(result_q) > k),
          .tdata_i     (words_q[k*64+:64]),
          .position_i  (32'(results_q[k*RESULT_WIDTH+CONFIDENCE_WIDTH+:16])),
          .confidence_i(32'(results_q[k*RESULT_WIDTH+:CONFIDENCE_WIDTH]))
      );
    end
  endgenerate

  logic two_frames, reference_done;
  assign reference_done = 32'(frame_q) >= FRAMES && 32'(result_q) == FRAMES * WORDS;
  assign two_frames = (32'(sink_frame_q) >= FRAMES);

  `PROVE(a_place, !m_tvalid || (m_tdata[dtof_registers_pkg::RESULT_COLUMN_LSB+:12] == 12'(sink_column_q)
                                && m_tdata[dtof_registers_pkg::RESULT_ROW_LSB+:12] == 12'(sink_row_q)
                                && m_tdata[63:61] == 3'b000))
  `PROVE(a_first, !m_tvalid || m_tuser == sink_first)
  `PROVE(a_last, !m_tvalid || m_tlast == sink_last)
  `PROVE(a_not_early, !m_tvalid || 32'(source_frame_q) > 32'(sink_frame_q) || 32'(source_frame_q) > FRAMES)
  `PROVE(a_ends, two_frames || 32'(clock_q) < MOST_CLOCKS)
  `GOAL(two_frames && reference_done)

  axi_stream_rules #(
      .WIDTH(66)
  ) u_rules (
      .clk_i   (clk_i),
      .rst_ni  (checking),
      .checking(checking),
      .tvalid_i(m_tvalid),
      .tready_i(m_tready),
      .tdata_i ({m_tuser, m_tlast, m_tdata})
  );

  logic unused;
  assign unused = ^{pslverr, prdata, irq, shot, cfg, tlast};

endmodule

`default_nettype wire
