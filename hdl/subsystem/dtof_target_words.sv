// SPDX-License-Identifier: Apache-2.0
// Splits an array's results with two targets (SECOND_TARGET = 1) into results with one target each.
//
// 1. A pixel's first result is {column, row, first position, confidence}.
// 2. If both_i is set, {column, row, second position, confidence} follows in the next clock, with m_second_o; the array's result is
//    accepted with this second result.
//
// Latency: none; one clock per result, or two with both_i.
// Cost: a flip-flop and a multiplexer of POSITION_WIDTH bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_target_words #(
    parameter int PLACE_WIDTH = 16,       // column and row
    parameter int POSITION_WIDTH = 16,
    parameter int CONFIDENCE_WIDTH = 8
) (
    input  logic                                                    clk_i,
    input  logic                                                    rst_ni,
    input  logic                                                    both_i,      // stable during a frame
    // from the array
    input  logic                                                    s_tvalid_i,
    output logic                                                    s_tready_o,
    input  logic [PLACE_WIDTH+2*POSITION_WIDTH+CONFIDENCE_WIDTH-1:0] s_tdata_i,  // {place, second, first, confidence}
    input  logic                                                    s_tlast_i,   // last result of the frame
    // results with one target each
    output logic                                                    m_tvalid_o,
    input  logic                                                    m_tready_i,
    output logic [  PLACE_WIDTH+POSITION_WIDTH+CONFIDENCE_WIDTH-1:0] m_tdata_o,  // {place, position, confidence}
    output logic                                                    m_second_o,
    output logic                                                    m_tlast_o
);

  logic second_q, last_word;
  logic [PLACE_WIDTH-1:0] place;
  logic [POSITION_WIDTH-1:0] first, second;
  logic [CONFIDENCE_WIDTH-1:0] confidence;

  assign {place, second, first, confidence} = s_tdata_i;
  assign last_word = second_q || !both_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      second_q <= 1'b0;
    end else if (s_tvalid_i && m_tready_i) begin
      second_q <= !last_word;
    end
  end

  assign s_tready_o = m_tready_i && last_word;
  assign m_tvalid_o = s_tvalid_i;
  assign m_tdata_o = {place, second_q ? second : first, confidence};
  assign m_second_o = second_q;
  assign m_tlast_o = s_tlast_i && last_word;

endmodule

`default_nettype wire
