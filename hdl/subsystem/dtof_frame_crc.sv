// SPDX-License-Identifier: Apache-2.0
// CRC-32 over the words of a frame as the receiver takes them.
//
// 1. Each word that the receiver takes enters the checksum, its lowest bit first. A frame's first word begins a new checksum.
// 2. After a frame's last word the checksum is in crc_o, and stays there until the next frame's last word. A frame that was cut off
//    (aborted_i) leaves crc_o as it is.
//
// Equation: CRC-32 of IEEE 802.3, reflected: polynomial 0xEDB88320, initial value all ones, complemented at the end. The result is the
// crc32 of zlib over the words as bytes, the lowest byte first.
// Schedule: clock 0 the word is taken, clock 1 the word is registered, clock 2 its checksum is registered. irq_o can rise in clock 1; a
// read transfer that begins in clock 1 has its data phase in clock 2, so it reads the new crc_o.
// Latency: 2 clocks. Cost: WIDTH + 67 flip-flops, for 64 bits 853 two-input XORs, as Yosys shares them.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_frame_crc #(
    parameter int WIDTH = 64
) (
    input  logic             clk_i,
    input  logic             rst_ni,
    input  logic             taken_i,    // a word is taken
    input  logic [WIDTH-1:0] word_i,
    input  logic             first_i,    // a frame's first word
    input  logic             last_i,     // a frame's last word
    input  logic             aborted_i,  // the last word of a frame that was cut off
    output logic [     31:0] crc_o       // the last frame that was not aborted
);

  localparam logic [31:0] POLYNOMIAL = 32'hedb88320;

  function automatic logic [31:0] next_crc(input logic [31:0] crc, input logic [WIDTH-1:0] word);
    integer i;
    begin
      next_crc = crc;
      for (i = 0; i < WIDTH; i = i + 1) begin
        next_crc = {1'b0, next_crc[31:1]} ^ ((next_crc[0] ^ word[i]) ? POLYNOMIAL : 32'd0);
      end
    end
  endfunction

  logic taken_q, first_q, ends_q;
  logic [WIDTH-1:0] word_q;
  logic [31:0] crc_q, frame_crc_q, crc;

  assign crc = next_crc(first_q ? {32{1'b1}} : crc_q, word_q);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      taken_q <= 1'b0;
      first_q <= 1'b0;
      ends_q <= 1'b0;
      word_q <= '0;
      crc_q <= '0;
      frame_crc_q <= '0;
    end else begin
      taken_q <= taken_i;
      if (taken_i) begin
        first_q <= first_i;
        ends_q <= last_i && !aborted_i;
        word_q <= word_i;
      end
      if (taken_q) begin
        crc_q <= crc;
        if (ends_q) begin
          frame_crc_q <= ~crc;
        end
      end
    end
  end

  assign crc_o = frame_crc_q;

endmodule

`default_nettype wire
