// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_subsystem, from reset through the writes of its registers and two continuous frames: every result word at the sink is
// the word that the read-out's rule gives for the lines at the source, for any timestamps, any gaps of the source and any waits of the sink.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module subsystem_properties #(
    parameter int READOUT = 0,
    parameter int NP = 3,
    parameter int NB = 1,
    parameter int COLUMNS = 2,
    parameter int ROWS = 1,
    parameter int SLOTS = 2,
    parameter int ACQUISITIONS = 2,
    parameter int COUNT_WIDTH = 2,
    parameter int FRACTION_BITS = 0,
    parameter int CONFIDENCE_WIDTH = 2,
    parameter int POINTER_PORTS = 2,
    parameter int CLOCK_WAITS = 1,
    parameter int BUFFER_LINES = 2,
    parameter int MOST_CLOCKS = 62,  // from the first write to the end of two frames, without any waits
    parameter int MOST_WAITS = 4,
    localparam int TDATA_WIDTH = 8 * ((COLUMNS * NP + 7) / 8)
) (
    input logic                   clk_i,
    input logic                   s_tvalid_i,
    input logic [TDATA_WIDTH-1:0] s_tdata_i,
    input logic                   m_tready_i
);

  localparam int SIDE_BAND = (1 << (NB - 1)) + 1;  // of hisPointer, with the default of NP = 3
  localparam int FRAMES = 2;
  localparam int ACQUISITION_LINES = ROWS * SLOTS;

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  // Writes of the registers after reset, two clocks each, which the first one's wait states precede. The last one starts continuous frames.
  localparam int WRITES = 2;
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
      paddr = dtof_registers_pkg::ACQUISITIONS;
      pwdata = 32'(ACQUISITIONS);
    end
  end

  // Clocks in which source or sink let the subsystem wait: any MOST_WAITS clocks.
  logic s_tvalid, s_tready, m_tvalid, m_tready;
  logic [7:0] waits_q;
  logic may_wait;

  assign may_wait = (32'(waits_q) < MOST_WAITS);
  assign s_tvalid = s_tvalid_i || !may_wait;
  assign m_tready = m_tready_i || !may_wait;

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      waits_q <= '0;
    end else if ((s_tready && !s_tvalid) || (m_tvalid && !m_tready)) begin
      waits_q <= waits_q + 1'b1;
    end
  end

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
      .READOUT         (READOUT),
      .NP              (NP),
      .NB              (NB),
      .PIXELS_PER_SRAM (ROWS),
      .SRAM_NUM        (COLUMNS),
      .SLOTS           (SLOTS),
      .COUNT_WIDTH     (COUNT_WIDTH),
      .FRACTION_BITS   (FRACTION_BITS),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .POINTER_PORTS   (POINTER_PORTS),
      .ACQ_WIDTH       (2),
      .BROADCAST_STAGES(1),
      .CLOCK_WAITS     (CLOCK_WAITS),
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
      .s_axis_tdata_i (s_tdata_i),
      .s_axis_tlast_i (s_tlast),
      .m_axis_tvalid_o(m_tvalid),
      .m_axis_tready_i(m_tready),
      .m_axis_tdata_o (m_tdata),
      .m_axis_tuser_o (m_tuser),
      .m_axis_tlast_o (m_tlast)
  );

  // Words are counted when the sink takes them, row by row.
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
      sink_column_q <= last_column ? '0 : sink_column_q + 1'b1;
      if (last_column) begin
        sink_row_q <= last_row ? '0 : sink_row_q + 1'b1;
      end
    end
  end

  // The words of both frames that the rule gives for the lines at the source.
  genvar f, r, c;
  generate
    for (f = 0; f < FRAMES; f = f + 1) begin : g_frame
      for (r = 0; r < ROWS; r = r + 1) begin : g_row
        for (c = 0; c < COLUMNS; c = c + 1) begin : g_column
          localparam int PLACE = (f * ROWS + r) * COLUMNS + c;
          logic mine;
          logic [31:0] position, confidence;
          assign mine = taken && 32'(source_frame_q) == f && 32'(line_q) >= r * SLOTS && 32'(line_q) < (r + 1) * SLOTS;
          if (READOUT == dtof_pkg::READOUT_EZPOINTER) begin : g_ez_pointer
            ez_pointer_reference #(
                .NP              (NP),
                .FRACTION_BITS   (FRACTION_BITS),
                .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
                .ACQUISITIONS    (ACQUISITIONS)
            ) u_reference (
                .clk_i        (clk_i),
                .rst_ni       (checking),
                .take_i       (mine),
                .acquisition_i(32'(acquisition_q)),
                .timestamp_i  (32'(s_tdata_i[c*NP+:NP])),
                .position_o   (position),
                .confidence_o (confidence)
            );
          end else if (READOUT == dtof_pkg::READOUT_HISPOINTER) begin : g_his_pointer
            his_pointer_reference #(
                .NP              (NP),
                .NB              (NB),
                .COUNT_WIDTH     (COUNT_WIDTH),
                .FRACTION_BITS   (FRACTION_BITS),
                .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
                .ACQUISITIONS    (ACQUISITIONS)
            ) u_reference (
                .clk_i        (clk_i),
                .rst_ni       (checking),
                .take_i       (mine),
                .acquisition_i(32'(acquisition_q)),
                .timestamp_i  (32'(s_tdata_i[c*NP+:NP])),
                .position_o   (position),
                .confidence_o (confidence)
            );
          end

          result_word_rules #(
              .COLUMN          (c),
              .ROW             (r),
              .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH)
          ) u_rules (
              .checking    (checking),
              .here_i      (m_tvalid && 32'(sink_word_q) == PLACE),
              .tdata_i     (m_tdata),
              .position_i  (position),
              .confidence_i(confidence)
          );
        end
      end
    end
  endgenerate

  logic two_frames;
  assign two_frames = (32'(sink_frame_q) >= FRAMES);

  `PROVE(a_place, !m_tvalid || (m_tdata[dtof_registers_pkg::RESULT_COLUMN_LSB+:12] == 12'(sink_column_q)
                                && m_tdata[dtof_registers_pkg::RESULT_ROW_LSB+:12] == 12'(sink_row_q)
                                && m_tdata[63:61] == 3'b000))
  `PROVE(a_first, !m_tvalid || m_tuser == sink_first)
  `PROVE(a_last, !m_tvalid || m_tlast == sink_last)
  `PROVE(a_not_early, !m_tvalid || 32'(source_frame_q) > 32'(sink_frame_q) || 32'(source_frame_q) > FRAMES)
  `PROVE(a_ends, two_frames || 32'(clock_q) < MOST_CLOCKS + 32'(waits_q))
  `GOAL(two_frames)

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
  assign unused = ^{pslverr, prdata, irq, shot, cfg};

endmodule

`default_nettype wire
