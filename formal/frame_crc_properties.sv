// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_frame_crc: the checksum is that of all words of a frame, computed bit by bit with the polynomial in the other bit order;
// it changes only with the last word of a frame that was not aborted.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module frame_crc_properties #(
    parameter int WIDTH = 64
) (
    input logic             clk_i,
    input logic             reset_i,
    input logic             taken_i,
    input logic [WIDTH-1:0] word_i,
    input logic             first_i,
    input logic             last_i,
    input logic             aborted_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic [31:0] crc;
  logic pending;

  dtof_frame_crc #(
      .WIDTH(WIDTH)
  ) u_dut (
      .clk_i    (clk_i),
      .rst_ni   (rst_n),
      .taken_i  (taken_i),
      .word_i   (word_i),
      .first_i  (first_i),
      .last_i   (last_i),
      .aborted_i(aborted_i),
      .pending_o(pending),
      .crc_o    (crc)
  );

  // The last word that was taken, and whether it was taken in the last clock; then the same a clock later.
  logic taken_q, first_q, ends_q, late_taken_q, late_first_q, late_ends_q;
  logic [WIDTH-1:0] word_q, late_word_q;

  // Highest bit first: bit 31 is x^31 of the remainder; a bit of the word enters there.
  logic [32*WIDTH+31:0] remainders;
  logic [31:0] remainder_q, expected_q, mirrored;
  logic [1:0] frames_q;  // frames that were not aborted, modulo 4
  genvar i;
  generate
    assign remainders[31:0] = late_first_q ? {32{1'b1}} : remainder_q;
    for (i = 0; i < WIDTH; i = i + 1) begin : g_bit
      assign remainders[32*i+32+:32] = {remainders[32*i+:31], 1'b0}
          ^ ((remainders[32*i+31] ^ late_word_q[i]) ? 32'h04c11db7 : 32'd0);
    end
    for (i = 0; i < 32; i = i + 1) begin : g_mirror
      assign mirrored[i] = !remainders[32*WIDTH+31-i];
    end
  endgenerate

  always_ff @(posedge clk_i or negedge rst_n) begin
    if (!rst_n) begin
      {taken_q, first_q, ends_q, word_q} <= '0;
      {late_taken_q, late_first_q, late_ends_q, late_word_q} <= '0;
      remainder_q <= '0;
      expected_q <= '0;
      frames_q <= '0;
    end else begin
      taken_q <= taken_i;
      late_taken_q <= taken_q;
      if (taken_i) begin
        first_q <= first_i;
        ends_q <= last_i && !aborted_i;
        word_q <= word_i;
      end
      if (taken_q) begin
        {late_first_q, late_ends_q, late_word_q} <= {first_q, ends_q, word_q};
      end
      if (late_taken_q) begin
        remainder_q <= remainders[32*WIDTH+:32];
        if (late_ends_q) begin
          expected_q <= mirrored;
          frames_q <= frames_q + 1'b1;
        end
      end
    end
  end

  `PROVE(a_crc, !rst_n || crc == expected_q)
  `PROVE(a_pending, !rst_n || pending == ((taken_q && ends_q) || (late_taken_q && late_ends_q)))
  `GOAL(rst_n && frames_q == 2 && crc != '0 && taken_i && last_i && aborted_i && !first_i)

endmodule

`default_nettype wire
