// SPDX-License-Identifier: Apache-2.0
// Packs the results of any array into words of 64 bits, with a status for each pixel. The module stores two words, so no path
// leads from the sink's ready to the array.
//
// Word: {status, column, row, confidence, position}, with the bits of dtof_registers_pkg. Status bits: `second` marks a pixel's
// second target; `weak`: confidence < weak_below_i; `empty`: confidence = 0, if the read-out has a confidence; `masked`: the column
// is not enabled; `valid`: neither weak nor empty nor masked; `saturated`: the counter of COUNTER_WIDTH bits (raw frame:
// RAW_COUNTER_WIDTH) has its largest value. Counts of a raw frame are neither weak nor empty.
// With amplitude_i words have amplitude and ambient in place of row and column.
// tuser marks a frame's first word, tlast its last word. m_axis_short_o is short_i at the frame's results.
// cut_i ends the frame: the word at the port stays until the sink takes it, and the second word is deleted. If words of the frame, but
// not its last, have been at the port, a word in which only `aborted` is set, with tlast, ends the frame. While unfinished_o is high,
// cut_i would cut off a frame in this way that no earlier cut_i has cut off.
// Latency: one clock. One word per clock while tready stays high. tvalid never falls before tready.
// Cost: two words, a comparator, a multiplexer of SRAM_NUM bits.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_stream_output #(
    parameter int SRAM_NUM = 200,
    parameter int ROW_WIDTH = 8,
    parameter int POSITION_WIDTH = 10,    // code and fraction, at most 16
    parameter int CONFIDENCE_WIDTH = 4,   // at most 16; 0: none
    parameter int HAS_CONFIDENCE = (CONFIDENCE_WIDTH > 0) ? 1 : 0,  // 0: the field has counts of raw frames only
    parameter int COUNTER_WIDTH = CONFIDENCE_WIDTH,      // bits of the counter that the confidence shows; 0: the confidence is no counter
    parameter int RAW_COUNTER_WIDTH = CONFIDENCE_WIDTH,  // bits of a bin in a raw frame
    parameter int AMPLITUDE_WIDTH = 0,  // bits of an amplitude, at most 12; 0: results have neither amplitude nor ambient
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int AMBIENT_WIDTH = (AMPLITUDE_WIDTH > 0) ? dtof_pkg::POOL_BACKGROUND_WIDTH : 0,
    localparam int TDATA_WIDTH = COLUMN_WIDTH + ROW_WIDTH + AMBIENT_WIDTH + AMPLITUDE_WIDTH + POSITION_WIDTH + CONFIDENCE_WIDTH,
    localparam int WORD_WIDTH = dtof_registers_pkg::RESULT_WIDTH
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic [           15:0] weak_below_i,   // weak_below_i, enable_i, raw_i, amplitude_i and short_i are stable during a frame
    input  logic [   SRAM_NUM-1:0] enable_i,
    input  logic                   raw_i,          // the frame's results are counts
    input  logic                   amplitude_i,    // 0 if AMPLITUDE_WIDTH is 0
    input  logic                   short_i,        // the frame leaves as short words (dtof_word_packer)
    input  logic                   cut_i,          // ends the present frame; the next result is of another frame
    // from the array
    input  logic                   result_tvalid_i,
    output logic                   result_tready_o,
    input  logic [TDATA_WIDTH-1:0] result_tdata_i,  // {column, row, ambient, amplitude, code, fraction, confidence}
    input  logic                   result_second_i, // second target of a pixel
    input  logic                   result_tlast_i,  // last result of the frame
    // AXI4-Stream
    output logic                   m_axis_tvalid_o,
    input  logic                   m_axis_tready_i,
    output logic [ WORD_WIDTH-1:0] m_axis_tdata_o,
    output logic                   m_axis_tuser_o,  // first word of the frame
    output logic                   m_axis_tlast_o,
    output logic                   m_axis_short_o,  // of the word at the port
    output logic                   unfinished_o     // see cut_i above
);

  logic [COLUMN_WIDTH-1:0] column;
  logic [ROW_WIDTH-1:0] row;
  logic [POSITION_WIDTH-1:0] position;
  logic [15:0] confidence;
  logic low, empty, masked, saturated;

  assign column = result_tdata_i[TDATA_WIDTH-1-:COLUMN_WIDTH];
  assign row = result_tdata_i[TDATA_WIDTH-1-COLUMN_WIDTH-:ROW_WIDTH];
  assign position = result_tdata_i[CONFIDENCE_WIDTH+:POSITION_WIDTH];

  generate
    if (CONFIDENCE_WIDTH > 0) begin : g_confidence
      assign confidence = 16'(result_tdata_i[CONFIDENCE_WIDTH-1:0]);
      assign low = (HAS_CONFIDENCE != 0) && !raw_i && (confidence < weak_below_i);
      assign empty = (HAS_CONFIDENCE != 0) && !raw_i && (confidence == '0);
      assign saturated = raw_i ? (confidence == 16'((32'd1 << RAW_COUNTER_WIDTH) - 1))
          : ((COUNTER_WIDTH != 0) && (confidence == 16'((32'd1 << COUNTER_WIDTH) - 1)));
    end else begin : g_no_confidence
      logic unused_weak_below;
      assign unused_weak_below = ^weak_below_i;
      assign confidence = '0;
      assign low = 1'b0;
      assign empty = 1'b0;
      assign saturated = 1'b0;
    end
  endgenerate

  assign masked = !enable_i[column];

  logic [dtof_registers_pkg::AMPLITUDE_RESULT_AMPLITUDE_WIDTH-1:0] amplitude;
  logic [dtof_registers_pkg::AMPLITUDE_RESULT_AMBIENT_WIDTH-1:0] ambient;
  logic shows_amplitude;

  generate
    if (AMPLITUDE_WIDTH > 0) begin : g_amplitude
      assign amplitude = dtof_registers_pkg::AMPLITUDE_RESULT_AMPLITUDE_WIDTH'(
          result_tdata_i[POSITION_WIDTH+CONFIDENCE_WIDTH+:AMPLITUDE_WIDTH]);
      assign ambient = dtof_registers_pkg::AMPLITUDE_RESULT_AMBIENT_WIDTH'(
          result_tdata_i[POSITION_WIDTH+CONFIDENCE_WIDTH+AMPLITUDE_WIDTH+:AMBIENT_WIDTH]);
      assign shows_amplitude = amplitude_i;
    end else begin : g_no_amplitude
      logic unused_amplitude;
      assign unused_amplitude = amplitude_i;
      assign amplitude = '0;
      assign ambient = '0;
      assign shows_amplitude = 1'b0;
    end
  endgenerate

  logic [WORD_WIDTH-1:0] word;

  always_comb begin
    word = '0;
    word[dtof_registers_pkg::RESULT_POSITION_LSB+:POSITION_WIDTH] = position;
    word[dtof_registers_pkg::RESULT_CONFIDENCE_LSB+:16] = confidence;
    word[dtof_registers_pkg::RESULT_ROW_LSB+:ROW_WIDTH] = row;
    word[dtof_registers_pkg::RESULT_COLUMN_LSB+:COLUMN_WIDTH] = column;
    if (shows_amplitude) begin
      word[dtof_registers_pkg::AMPLITUDE_RESULT_AMPLITUDE_LSB+:dtof_registers_pkg::AMPLITUDE_RESULT_AMPLITUDE_WIDTH] = amplitude;
      word[dtof_registers_pkg::AMPLITUDE_RESULT_AMBIENT_LSB+:dtof_registers_pkg::AMPLITUDE_RESULT_AMBIENT_WIDTH] = ambient;
    end
    word[dtof_registers_pkg::RESULT_VALID_LSB] = !low && !empty && !masked;
    word[dtof_registers_pkg::RESULT_WEAK_LSB] = low;
    word[dtof_registers_pkg::RESULT_EMPTY_LSB] = empty;
    word[dtof_registers_pkg::RESULT_MASKED_LSB] = masked;
    word[dtof_registers_pkg::RESULT_SATURATED_LSB] = saturated;
    word[dtof_registers_pkg::RESULT_SECOND_LSB] = result_second_i;
    word[dtof_registers_pkg::RESULT_RAW_LSB] = raw_i;
  end

  // Bits that a word of this configuration can set. The others are constants at the port, not registers that hold 0.
  localparam logic [WORD_WIDTH-1:0] ONE = WORD_WIDTH'(1);
  localparam logic [WORD_WIDTH-1:0] USED = (((ONE << POSITION_WIDTH) - ONE) << dtof_registers_pkg::RESULT_POSITION_LSB)
      | (((ONE << CONFIDENCE_WIDTH) - ONE) << dtof_registers_pkg::RESULT_CONFIDENCE_LSB)
      | (((ONE << ROW_WIDTH) - ONE) << dtof_registers_pkg::RESULT_ROW_LSB)
      | (((ONE << COLUMN_WIDTH) - ONE) << dtof_registers_pkg::RESULT_COLUMN_LSB)
      | (((ONE << AMPLITUDE_WIDTH) - ONE) << dtof_registers_pkg::AMPLITUDE_RESULT_AMPLITUDE_LSB)
      | (((ONE << AMBIENT_WIDTH) - ONE) << dtof_registers_pkg::AMPLITUDE_RESULT_AMBIENT_LSB)
      | (ONE << dtof_registers_pkg::RESULT_VALID_LSB) | (ONE << dtof_registers_pkg::RESULT_WEAK_LSB)
      | (ONE << dtof_registers_pkg::RESULT_EMPTY_LSB) | (ONE << dtof_registers_pkg::RESULT_MASKED_LSB)
      | (ONE << dtof_registers_pkg::RESULT_SATURATED_LSB) | (ONE << dtof_registers_pkg::RESULT_SECOND_LSB)
      | (ONE << dtof_registers_pkg::RESULT_RAW_LSB) | (ONE << dtof_registers_pkg::RESULT_ABORTED_LSB);

  // The word at the port, and a second word for the clock before result_tready_o follows a sink that is not ready.

  logic valid_q, last_q, first_q, short_q, behind_q, behind_last_q, behind_first_q, behind_short_q, begins_q;
  logic open_q;  // the last word at the port was not the last of its frame
  logic [WORD_WIDTH-1:0] word_q, behind_word_q, enters_word;
  logic accepted, aborts, enters, enters_last, enters_first, enters_short, waits, moves;

  assign accepted = result_tvalid_i && result_tready_o;
  assign aborts = cut_i && open_q;
  assign enters = accepted || aborts;
  assign enters_last = aborts || result_tlast_i;
  assign enters_first = !aborts && begins_q;
  assign enters_short = aborts ? short_q : short_i;  // an aborted word is of the frame that was at the port last
  assign waits = behind_q && !cut_i;
  assign moves = !valid_q || m_axis_tready_i;

  always_comb begin
    enters_word = word;
    if (aborts) begin
      enters_word = '0;
      enters_word[dtof_registers_pkg::RESULT_ABORTED_LSB] = 1'b1;
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q <= 1'b0;
      behind_q <= 1'b0;
      begins_q <= 1'b1;
      open_q <= 1'b0;
    end else begin
      if (cut_i) begin
        begins_q <= 1'b1;
      end else if (accepted) begin
        begins_q <= result_tlast_i;
      end
      if (moves) begin
        valid_q <= waits || enters;
        behind_q <= 1'b0;
        if (waits || enters) begin
          open_q <= waits ? !behind_last_q : !enters_last;
        end
      end else begin
        behind_q <= waits || enters;
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (enters) begin
      behind_word_q <= enters_word;
      behind_last_q <= enters_last;
      behind_first_q <= enters_first;
      behind_short_q <= enters_short;
    end
    if (moves) begin
      word_q <= waits ? behind_word_q : enters_word;
      last_q <= waits ? behind_last_q : enters_last;
      first_q <= waits ? behind_first_q : enters_first;
    end
    if (moves && (waits || enters)) begin
      short_q <= waits ? behind_short_q : enters_short;
    end
  end

  assign result_tready_o = !behind_q && !cut_i;
  assign m_axis_tvalid_o = valid_q;
  assign m_axis_tdata_o = word_q & USED;
  assign m_axis_tuser_o = first_q;
  assign m_axis_tlast_o = last_q;
  assign m_axis_short_o = short_q;
  assign unfinished_o = open_q && !(behind_q && behind_word_q[dtof_registers_pkg::RESULT_ABORTED_LSB]);

`ifndef SYNTHESIS
  dtof_stream_rules #(
      .WIDTH(WORD_WIDTH + 2)
  ) u_stream_rules (
      .clk_i   (clk_i),
      .rst_ni  (rst_ni),
      .tvalid_i(m_axis_tvalid_o),
      .tready_i(m_axis_tready_i),
      .tdata_i ({m_axis_short_o, m_axis_tuser_o, m_axis_tdata_o}),
      .tlast_i (m_axis_tlast_o)
  );
`endif

endmodule

`default_nettype wire
