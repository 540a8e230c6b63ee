// SPDX-License-Identifier: Apache-2.0
// The way of the results from the array to the sink: words of 64 bits with a status, in the array's order or row by row, or short words of 32
// bits, two in each beat. While the sink waits, the array waits.
//
// 1. dtof_target_words (SECOND_TARGET = 1) makes a word of each of a pixel's targets, dtof_stream_output adds the status, dtof_raster_buffer
//    (RASTER_ORDER = 1) sorts the words, dtof_word_packer makes short words.
// 2. Words are stored for a slow sink at one place only, which keeps the rules of the stream when a frame is cut off by abort_i: in
//    dtof_stream_output, or in raster order in dtof_raster_buffer.
// 3. The words of a self-test (test_frame_i) stay inside.
// 4. dtof_frame_crc has the checksum of a frame's words, and a watchdog reports a sink that waits too long.
//
// Latency: one clock from a result of the array to the sink; in raster order, a frame.
// Cost: two words, a checksum, and the modules of the options.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_result_path #(
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SRAM_NUM = 200,
    parameter int PARITY = 0,
    parameter int RASTER_ORDER = 0,
    parameter int SECOND_TARGET = 0,
    parameter int AMPLITUDE = 0,
    parameter int RAW_HISTOGRAM = 0,
    parameter int POSITION_WIDTH = 10,
    parameter int CONFIDENCE_WIDTH = 4,       // 0: the read-out has no confidence
    parameter int KEPT_CONFIDENCE_WIDTH = 4,  // in a raw frame the field of the confidence has a count
    parameter int COUNTER_WIDTH = 0,          // of the confidence, if it is a counter
    parameter int RAW_COUNTER_WIDTH = 10,
    parameter int AMPLITUDE_WIDTH = 0,
    parameter int PLACE_WIDTH = 16,           // column and row, with AMPLITUDE = 1 also ambient and amplitude
    localparam int TARGETS = (SECOND_TARGET != 0) ? 2 : 1,
    localparam int TARGET_WIDTH = PLACE_WIDTH + POSITION_WIDTH + KEPT_CONFIDENCE_WIDTH,
    localparam int RESULT_WIDTH = TARGET_WIDTH + (TARGETS - 1) * POSITION_WIDTH,
    localparam int M_TDATA_WIDTH = dtof_registers_pkg::RESULT_WIDTH
) (
    input  logic                     clk_i,
    input  logic                     rst_ni,
    input  logic                     stream_rst_ni,    // falls with abort_i, too
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // frame
    input  logic                     begin_i,          // a frame begins, with the settings below
    input  logic                     abort_i,
    input  logic                     resetting_i,      // the array is in reset
    input  logic                     test_frame_i,     // the frame that began last is a self-test
    // settings
    input  logic [             15:0] weak_below_i,
    input  logic                     short_words_i,
    input  logic                     second_i,
    input  logic                     amplitude_i,
    input  logic                     raw_i,
    input  logic [     SRAM_NUM-1:0] enable_i,         // of the present frame, while its results come
    input  logic [             23:0] watchdog_i,       // at any time
    // results of the array
    input  logic                     result_tvalid_i,
    output logic                     result_tready_o,
    input  logic [ RESULT_WIDTH-1:0] result_tdata_i,
    input  logic                     result_tlast_i,
    // sink
    output logic                     m_axis_tvalid_o,
    input  logic                     m_axis_tready_i,
    output logic [M_TDATA_WIDTH-1:0] m_axis_tdata_o,
    output logic                     m_axis_tuser_o,
    output logic                     m_axis_tlast_o,
    // status and events
    output logic                     words_left_o,     // words are inside
    output logic                     unfinished_o,     // the array's frame is over, and abort_i would cut off words of the frame
    output logic                     word_ends_o,      // a frame's last word leaves, which did not end by abort_i
    output logic [             31:0] crc_o,
    output logic                     crc_pending_o,
    output logic                     stalled_o,
    output logic                     parity_error_o
);

  localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM);
  localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM);

  // Settings of the present frame; those of options follow.

  logic [15:0] frame_weak_below_q;
  logic frame_short_q;  // a raw frame has no short words

  always_ff @(posedge clk_i) begin
    if (begin_i) begin
      frame_weak_below_q <= weak_below_i;
      frame_short_q <= short_words_i && !raw_i;
    end
  end

  // Results: one word per target.

  logic target_tvalid, target_tready, target_second, target_tlast;
  logic [TARGET_WIDTH-1:0] target_tdata;

  generate
    if (SECOND_TARGET != 0) begin : g_second_target
      logic frame_second_q;
      always_ff @(posedge clk_i) begin
        if (begin_i) begin
          frame_second_q <= second_i;
        end
      end

      dtof_target_words #(
          .PLACE_WIDTH     (PLACE_WIDTH),
          .POSITION_WIDTH  (POSITION_WIDTH),
          .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH)
      ) u_target_words (
          .clk_i     (clk_i),
          .rst_ni    (stream_rst_ni),
          .both_i    (frame_second_q),
          .s_tvalid_i(result_tvalid_i),
          .s_tready_o(result_tready_o),
          .s_tdata_i (result_tdata_i),
          .s_tlast_i (result_tlast_i),
          .m_tvalid_o(target_tvalid),
          .m_tready_i(target_tready),
          .m_tdata_o (target_tdata),
          .m_second_o(target_second),
          .m_tlast_o (target_tlast)
      );
    end else begin : g_one_target
      logic unused_here;
      assign unused_here = ^{second_i, stream_rst_ni};
      assign result_tready_o = target_tready;
      assign target_tvalid = result_tvalid_i;
      assign target_tdata = result_tdata_i;
      assign target_second = 1'b0;
      assign target_tlast = result_tlast_i;
    end
  endgenerate

  logic frame_amplitude;

  generate
    if (AMPLITUDE != 0) begin : g_amplitude
      logic frame_amplitude_q;
      always_ff @(posedge clk_i) begin
        if (begin_i) begin
          frame_amplitude_q <= amplitude_i;
        end
      end
      assign frame_amplitude = frame_amplitude_q;
    end else begin : g_no_amplitude
      logic unused_amplitude;
      assign unused_amplitude = amplitude_i;
      assign frame_amplitude = 1'b0;
    end
  endgenerate

  logic frame_raw;

  generate
    if (RAW_HISTOGRAM != 0) begin : g_raw_histogram
      logic frame_raw_q;
      always_ff @(posedge clk_i) begin
        if (begin_i) begin
          frame_raw_q <= raw_i;
        end
      end
      assign frame_raw = frame_raw_q;
    end else begin : g_results_alone
      assign frame_raw = 1'b0;
    end
  endgenerate

  // Words.

  logic word_tvalid, word_tready, word_tuser, word_tlast, word_short, output_rst_n, output_cut, aborted_word, output_unfinished;
  logic out_tvalid, out_tready, out_taken;  // of the port, and of words of a self-test, which stay inside

  assign m_axis_tvalid_o = out_tvalid && !test_frame_i;
  assign out_tready = m_axis_tready_i || test_frame_i;
  assign out_taken = out_tvalid && out_tready;
  assign word_ends_o = out_taken && m_axis_tlast_o && !aborted_word;
  logic [M_TDATA_WIDTH-1:0] word_tdata;
  logic ordered_tvalid, ordered_tready, ordered_tuser, ordered_tlast, ordered_short;  // in the order in which the words leave
  logic [M_TDATA_WIDTH-1:0] ordered_tdata;

  dtof_stream_output #(
      .SRAM_NUM         (SRAM_NUM),
      .ROW_WIDTH        (ROW_WIDTH),
      .POSITION_WIDTH   (POSITION_WIDTH),
      .CONFIDENCE_WIDTH (KEPT_CONFIDENCE_WIDTH),
      .HAS_CONFIDENCE   ((CONFIDENCE_WIDTH > 0) ? 1 : 0),
      .COUNTER_WIDTH    (COUNTER_WIDTH),
      .RAW_COUNTER_WIDTH(RAW_COUNTER_WIDTH),
      .AMPLITUDE_WIDTH  (AMPLITUDE_WIDTH)
  ) u_stream_output (
      .clk_i          (clk_i),
      .rst_ni         (output_rst_n),
      .weak_below_i   (frame_weak_below_q),
      .enable_i       (enable_i),
      .raw_i          (frame_raw),
      .amplitude_i    (frame_amplitude),
      .short_i        (frame_short_q),
      .cut_i          (output_cut),
      .result_tvalid_i(target_tvalid && !resetting_i),
      .result_tready_o(target_tready),
      .result_tdata_i (target_tdata),
      .result_second_i(target_second),
      .result_tlast_i (target_tlast),
      .m_axis_tvalid_o(word_tvalid),
      .m_axis_tready_i(word_tready),
      .m_axis_tdata_o (word_tdata),
      .m_axis_tuser_o (word_tuser),
      .m_axis_tlast_o (word_tlast),
      .m_axis_short_o (word_short),
      .unfinished_o   (output_unfinished)
  );

  generate
    if (RASTER_ORDER != 0) begin : g_raster_order
      localparam int COLUMN_LSB = dtof_registers_pkg::RESULT_COLUMN_LSB;
      localparam int ROW_LSB = dtof_registers_pkg::RESULT_ROW_LSB;
      localparam int STATUS_LSB = dtof_registers_pkg::RESULT_VALID_LSB;
      localparam int STATUS_WIDTH = dtof_registers_pkg::RESULT_SATURATED_LSB + 1 - STATUS_LSB;
      localparam int CONFIDENCE_LSB = dtof_registers_pkg::RESULT_CONFIDENCE_LSB;
      localparam int KEPT_CONFIDENCE = dtof_pkg::max_of(CONFIDENCE_WIDTH, 1);
      localparam int KEPT_WIDTH = STATUS_WIDTH + KEPT_CONFIDENCE + POSITION_WIDTH;

      logic [STATUS_WIDTH-1:0] status;
      logic [KEPT_CONFIDENCE-1:0] confidence;
      logic [POSITION_WIDTH-1:0] position;
      logic [COLUMN_WIDTH-1:0] column;
      logic [ROW_WIDTH-1:0] row;
      logic second_word, words_left_in_front, buffer_unfinished;

      assign words_left_in_front = word_tvalid || (target_tvalid && !resetting_i);
      assign output_rst_n = stream_rst_ni;
      assign output_cut = 1'b0;
      assign words_left_o = word_tvalid || !word_tready;
      assign unfinished_o = !test_frame_i && (words_left_in_front || buffer_unfinished);

      dtof_raster_buffer #(
          .SRAM_NUM       (SRAM_NUM),
          .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
          .WIDTH          (KEPT_WIDTH),
          .PARITY         (PARITY),
          .TARGETS        (TARGETS)
      ) u_raster_buffer (
          .clk_i     (clk_i),
          .rst_ni    (rst_ni),
          .sram_cfg_i(sram_cfg_i),
          .sram_cfg_o(sram_cfg_o),
          .parity_error_o(parity_error_o),
          .cut_i     (abort_i),
          .s_tvalid_i(word_tvalid),
          .s_tready_o(word_tready),
          .s_result_i({word_tdata[STATUS_LSB+:STATUS_WIDTH], word_tdata[CONFIDENCE_LSB+:KEPT_CONFIDENCE],
                       word_tdata[dtof_registers_pkg::RESULT_POSITION_LSB+:POSITION_WIDTH]}),
          .s_column_i(word_tdata[COLUMN_LSB+:COLUMN_WIDTH]),
          .s_row_i   (word_tdata[ROW_LSB+:ROW_WIDTH]),
          .s_second_i(word_tdata[dtof_registers_pkg::RESULT_SECOND_LSB]),
          .s_tlast_i (word_tlast),
          .m_tvalid_o(ordered_tvalid),
          .m_tready_i(ordered_tready),
          .m_result_o({status, confidence, position}),
          .m_column_o(column),
          .m_row_o   (row),
          .m_second_o(second_word),
          .m_aborted_o(aborted_word),
          .unfinished_o(buffer_unfinished),
          .m_tlast_o (ordered_tlast)
      );

      // The frame that leaves the buffer: the next frame's words are not accepted before its end.
      logic short_q;
      always_ff @(posedge clk_i) begin
        if (word_tvalid && word_tready) begin
          short_q <= word_short;
        end
      end
      assign ordered_short = short_q;

      always_comb begin
        ordered_tdata = '0;
        if (aborted_word) begin
          ordered_tdata[dtof_registers_pkg::RESULT_ABORTED_LSB] = 1'b1;
        end else begin
          ordered_tdata[STATUS_LSB+:STATUS_WIDTH] = status;
          ordered_tdata[CONFIDENCE_LSB+:KEPT_CONFIDENCE] = confidence;
          ordered_tdata[dtof_registers_pkg::RESULT_POSITION_LSB+:POSITION_WIDTH] = position;
          ordered_tdata[COLUMN_LSB+:COLUMN_WIDTH] = column;
          ordered_tdata[ROW_LSB+:ROW_WIDTH] = row;
          ordered_tdata[dtof_registers_pkg::RESULT_SECOND_LSB] = second_word;
        end
      end
      assign ordered_tuser = (column == '0) && (row == '0) && !second_word && !aborted_word;

      logic unused_word;
      assign unused_word = ^{word_tuser, word_tdata, output_unfinished};
    end else begin : g_array_order
      assign output_rst_n = rst_ni;
      assign output_cut = abort_i;
      assign aborted_word = word_tdata[dtof_registers_pkg::RESULT_ABORTED_LSB];
      logic unused_cfg;
      assign unused_cfg = ^sram_cfg_i;
      assign sram_cfg_o = '1;
      assign parity_error_o = 1'b0;
      assign words_left_o = word_tvalid;
      assign unfinished_o = !test_frame_i && output_unfinished;
      assign word_tready = ordered_tready;
      assign ordered_tvalid = word_tvalid;
      assign ordered_tdata = word_tdata;
      assign ordered_tuser = word_tuser;
      assign ordered_tlast = word_tlast;
      assign ordered_short = word_short;
    end
  endgenerate

  dtof_word_packer u_word_packer (
      .clk_i     (clk_i),
      .rst_ni    (rst_ni),
      .short_i   (ordered_short),
      .s_tvalid_i(ordered_tvalid),
      .s_tready_o(ordered_tready),
      .s_tdata_i (ordered_tdata),
      .s_tuser_i (ordered_tuser),
      .s_tlast_i (ordered_tlast),
      .m_tvalid_o(out_tvalid),
      .m_tready_i(out_tready),
      .m_tdata_o (m_axis_tdata_o),
      .m_tuser_o (m_axis_tuser_o),
      .m_tlast_o (m_axis_tlast_o)
  );

  dtof_watchdog #(
      .WIDTH(24)
  ) u_result_watchdog (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .limit_i  (watchdog_i),
      .waits_i  (m_axis_tvalid_o && !m_axis_tready_i),
      .expired_o(stalled_o)
  );

  dtof_frame_crc #(
      .WIDTH(M_TDATA_WIDTH)
  ) u_frame_crc (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .taken_i  (out_taken),
      .word_i   (m_axis_tdata_o),
      .first_i  (m_axis_tuser_o),
      .last_i   (m_axis_tlast_o),
      .aborted_i(aborted_word),
      .pending_o(crc_pending_o),
      .crc_o    (crc_o)
  );

endmodule

`default_nettype wire
