// SPDX-License-Identifier: Apache-2.0
// Packs the words of a frame, 64 bits each, into short words of 32 bits, two in each beat. The words of other frames pass unchanged.
//
// 1. With short_i a frame's first word, third word and so on become short words that wait in a register. The next word completes the
//    beat: the short word that waits has the lower half, the new one has the upper half.
// 2. If a frame's last word is alone in its beat, it has the lower half, and the upper half is 0, which is no result.
// 3. Without short_i each word is a beat, in the same clock.
//
// Short word: the fields SHORT_RESULT_* of dtof_registers_pkg. The confidence is clipped to the largest value of its field. The word that
// ends an aborted frame becomes a short word in which only `aborted` is set. m_tuser_o marks the beat with a frame's first word.
// Schedule: clock n takes the first word of a pair, without a beat; from clock n + 1 on the second word and its beat are valid together,
// and the same clock takes both.
// Latency: none. One word per clock while m_tready_i stays high.
// Cost: 34 flip-flops, 97 two-input multiplexers, 55 other gates, as Yosys 0.23 counts them after `synth`.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_word_packer #(
    localparam int WIDTH = dtof_registers_pkg::RESULT_WIDTH,
    localparam int HALF = dtof_registers_pkg::SHORT_RESULT_WIDTH
) (
    input  logic             clk_i,
    input  logic             rst_ni,
    // words
    input  logic             short_i,     // comes with each word; the same for all words of a frame
    input  logic             s_tvalid_i,
    output logic             s_tready_o,
    input  logic [WIDTH-1:0] s_tdata_i,
    input  logic             s_tuser_i,   // first word of the frame
    input  logic             s_tlast_i,
    // beats
    output logic             m_tvalid_o,
    input  logic             m_tready_i,
    output logic [WIDTH-1:0] m_tdata_o,
    output logic             m_tuser_o,
    output logic             m_tlast_o
);

  localparam int CONFIDENCE_LSB = dtof_registers_pkg::RESULT_CONFIDENCE_LSB;
  localparam int CONFIDENCE_WIDTH = dtof_registers_pkg::RESULT_CONFIDENCE_WIDTH;
  localparam int SHORT_CONFIDENCE_WIDTH = dtof_registers_pkg::SHORT_RESULT_CONFIDENCE_WIDTH;

  `DTOF_REQUIRE(g_illegal_width, WIDTH == 2 * HALF, "dtof_word_packer: a short word must have half the bits of a word")
  `DTOF_REQUIRE(g_illegal_position,
                dtof_registers_pkg::SHORT_RESULT_POSITION_WIDTH == dtof_registers_pkg::RESULT_POSITION_WIDTH,
                "dtof_word_packer: a position must be whole in a short word")

  // The short word.

  logic [HALF-1:0] word;
  logic clipped;

  assign clipped = (s_tdata_i[CONFIDENCE_LSB+SHORT_CONFIDENCE_WIDTH+:CONFIDENCE_WIDTH-SHORT_CONFIDENCE_WIDTH] != '0);

  assign word[dtof_registers_pkg::SHORT_RESULT_POSITION_LSB+:dtof_registers_pkg::SHORT_RESULT_POSITION_WIDTH] =
      s_tdata_i[dtof_registers_pkg::RESULT_POSITION_LSB+:dtof_registers_pkg::RESULT_POSITION_WIDTH];
  assign word[dtof_registers_pkg::SHORT_RESULT_CONFIDENCE_LSB+:SHORT_CONFIDENCE_WIDTH] =
      s_tdata_i[CONFIDENCE_LSB+:SHORT_CONFIDENCE_WIDTH] | {SHORT_CONFIDENCE_WIDTH{clipped}};
  assign word[dtof_registers_pkg::SHORT_RESULT_VALID_LSB] = s_tdata_i[dtof_registers_pkg::RESULT_VALID_LSB];
  assign word[dtof_registers_pkg::SHORT_RESULT_WEAK_LSB] = s_tdata_i[dtof_registers_pkg::RESULT_WEAK_LSB];
  assign word[dtof_registers_pkg::SHORT_RESULT_EMPTY_LSB] = s_tdata_i[dtof_registers_pkg::RESULT_EMPTY_LSB];
  assign word[dtof_registers_pkg::SHORT_RESULT_MASKED_LSB] = s_tdata_i[dtof_registers_pkg::RESULT_MASKED_LSB];
  assign word[dtof_registers_pkg::SHORT_RESULT_SATURATED_LSB] = s_tdata_i[dtof_registers_pkg::RESULT_SATURATED_LSB];
  assign word[dtof_registers_pkg::SHORT_RESULT_SECOND_LSB] = s_tdata_i[dtof_registers_pkg::RESULT_SECOND_LSB];
  assign word[dtof_registers_pkg::SHORT_RESULT_ABORTED_LSB] = s_tdata_i[dtof_registers_pkg::RESULT_ABORTED_LSB];

  // The lower half of a beat, which waits for the next word.

  logic half_q, first_q, waits;
  logic [HALF-1:0] half_word_q;

  assign waits = short_i && !half_q && !s_tlast_i;  // the word at the input has to wait for the next one

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      half_q <= 1'b0;
    end else if (s_tvalid_i && s_tready_o) begin
      half_q <= waits;
    end
  end

  always_ff @(posedge clk_i) begin
    if (s_tvalid_i && waits) begin
      half_word_q <= word;
      first_q <= s_tuser_i;
    end
  end

  assign s_tready_o = waits || m_tready_i;
  assign m_tvalid_o = s_tvalid_i && !waits;
  assign m_tdata_o = !short_i ? s_tdata_i : half_q ? {word, half_word_q} : {{HALF{1'b0}}, word};
  assign m_tuser_o = half_q ? first_q : s_tuser_i;
  assign m_tlast_o = s_tlast_i;

  `DTOF_ASSERT(a_one_kind, !(half_q && s_tvalid_i) || short_i, "a frame changed from short words to words inside a beat")
  `DTOF_ASSERT(a_in_one_beat, !(half_q && s_tvalid_i) || !s_tuser_i, "a frame began inside a beat of the frame before")

`ifndef SYNTHESIS
  dtof_stream_rules #(
      .WIDTH(WIDTH + 1)
  ) u_stream_rules (
      .clk_i   (clk_i),
      .rst_ni  (rst_ni),
      .tvalid_i(m_tvalid_o),
      .tready_i(m_tready_i),
      .tdata_i ({m_tuser_o, m_tdata_o}),
      .tlast_i (m_tlast_o)
  );
`endif

endmodule

`default_nettype wire
