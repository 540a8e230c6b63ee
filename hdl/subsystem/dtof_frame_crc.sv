// SPDX-License-Identifier: Apache-2.0
// CRC-32 over the words of a frame as the receiver takes them.
//
// 1. Each word that the receiver takes enters the checksum, its lowest bit first. A frame's first word begins a new checksum.
// 2. After a frame's last word the checksum is in crc_o, and stays there until the next frame's last word. A frame that was cut off
//    (aborted_i) leaves crc_o as it is.
//
// Equation: CRC-32 of IEEE 802.3, reflected: polynomial 0xEDB88320, initial value all ones, complemented at the end. The result is the
// crc32 of zlib over the words as bytes, the lowest byte first.
// The checksum is linear over GF(2): next(crc, word) = next(crc, 0) ^ next(0, word). Each bit of both terms is the parity of some bits, which
// the rows of a matrix select, so that a path has a tree of XORs instead of one XOR for each bit of the word.
// Schedule: clock 0 the word is taken, clock 1 the word is in a register, clock 2 next(0, word) is in a register, from clock 3 on crc_o is the
// new checksum. After a frame's last word pending_o is high in clocks 1 and 2, in which dtof_apb_registers makes reads wait.
// Latency: 3 clocks. Cost: 166 flip-flops, for 64 bits 947 two-input XORs, as Yosys shares them.

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
    output logic             pending_o,  // crc_o follows at once: the last word of a frame has been taken
    output logic [     31:0] crc_o       // the last frame that was not aborted
);

  localparam logic [31:0] POLYNOMIAL = 32'hedb88320;

  // Column k: the checksum after a bit that k bits follow, all 0.
  function automatic logic [32*WIDTH-1:0] columns();
    integer k;
    begin
      columns[31:0] = POLYNOMIAL;
      for (k = 1; k < WIDTH; k = k + 1) begin
        columns[32*k+:32] = {1'b0, columns[32*k-31+:31]} ^ (columns[32*k-32] ? POLYNOMIAL : 32'd0);
      end
    end
  endfunction

  localparam logic [32*WIDTH-1:0] COLUMNS = columns();

  // Bits of the word on which bit `i` of next(0, word) depends.
  function automatic logic [WIDTH-1:0] word_row(input integer i);
    integer j;
    begin
      for (j = 0; j < WIDTH; j = j + 1) begin
        word_row[j] = COLUMNS[32*(WIDTH-1-j)+i];
      end
    end
  endfunction

  // Bits of the checksum on which bit `i` of next(crc, 0) depends: those that leave meet the word's bits, the others only move.
  function automatic logic [31:0] crc_row(input integer i);
    integer j;
    begin
      for (j = 0; j < 32; j = j + 1) begin
        crc_row[j] = (j < WIDTH) ? COLUMNS[32*(WIDTH-1-j)+i] : (j - WIDTH == i);
      end
    end
  endfunction

  logic taken_q, first_q, ends_q, part_q, part_first_q, part_ends_q;
  logic [WIDTH-1:0] word_q;
  logic [31:0] word_part, word_part_q, crc_part, first_part, crc_q, frame_crc_q, crc;

  genvar i;
  generate
    for (i = 0; i < 32; i = i + 1) begin : g_bit
      localparam logic [WIDTH-1:0] WORD_ROW = word_row(i);
      localparam logic [31:0] CRC_ROW = crc_row(i);
      assign word_part[i] = ^(word_q & WORD_ROW);
      assign crc_part[i] = ^(crc_q & CRC_ROW);
      assign first_part[i] = ^CRC_ROW;  // of the initial value, all ones
    end
  endgenerate

  assign crc = word_part_q ^ (part_first_q ? first_part : crc_part);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      taken_q <= 1'b0;
      part_q <= 1'b0;
      part_first_q <= 1'b0;
      part_ends_q <= 1'b0;
      word_part_q <= '0;
      crc_q <= '0;
      frame_crc_q <= '0;
    end else begin
      taken_q <= taken_i;
      part_q <= taken_q;
      if (taken_q) begin
        part_first_q <= first_q;
        part_ends_q <= ends_q;
        word_part_q <= word_part;
      end
      if (part_q) begin
        crc_q <= crc;
        if (part_ends_q) begin
          frame_crc_q <= ~crc;
        end
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (taken_i) begin
      word_q <= word_i;
      first_q <= first_i;
      ends_q <= last_i && !aborted_i;
    end
  end

  assign pending_o = (taken_q && ends_q) || (part_q && part_ends_q);
  assign crc_o = frame_crc_q;

endmodule

`default_nettype wire
