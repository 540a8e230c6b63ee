// SPDX-License-Identifier: Apache-2.0
// Splits result words of dtof_subsystem into bytes for a serial line: nine bytes per word, seven bits in each, the lowest first.
// Only the first byte of a word has its highest bit set, so that a receiver finds the words. Bits 60:0 are those of the word,
// bit 61 is tuser, bit 62 tlast.
//
// Schedule: a word is accepted when the word before is sent. Latency: one clock from acceptance to the first byte.
// Cost: a shift register of 63 bits, a counter.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module word_sender (
    input  logic        clk_i,
    input  logic        rst_ni,
    input  logic        s_axis_tvalid_i,
    output logic        s_axis_tready_o,
    input  logic [63:0] s_axis_tdata_i,
    input  logic        s_axis_tuser_i,
    input  logic        s_axis_tlast_i,
    output logic        valid_o,
    input  logic        ready_i,
    output logic [ 7:0] data_o
);

  localparam logic [3:0] BYTES = 4'd9;

  logic [62:0] shift_q;
  logic [3:0] bytes_q;  // bytes still to send

  assign s_axis_tready_o = (bytes_q == '0);
  assign valid_o = (bytes_q != '0);
  assign data_o = {bytes_q == BYTES, shift_q[6:0]};

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      bytes_q <= '0;
    end else if (s_axis_tready_o) begin
      bytes_q <= s_axis_tvalid_i ? BYTES : '0;
    end else if (ready_i) begin
      bytes_q <= bytes_q - 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (s_axis_tready_o) begin
      shift_q <= {s_axis_tlast_i, s_axis_tuser_i, s_axis_tdata_i[60:0]};
    end else if (ready_i) begin
      shift_q <= {7'd0, shift_q[62:7]};
    end
  end

  logic unused_word;
  assign unused_word = ^s_axis_tdata_i[63:61];

endmodule

`default_nettype wire
