// SPDX-License-Identifier: Apache-2.0
// Decodes commands of three bytes that write a pixel's target. The first byte is 128 + bits 6:0 of the pixel. The two other bytes have bits
// 13:7 and 6:0 of a number of 14 bits: the code in its lower NP bits, the further bits of the pixel above them. Only the first byte has its
// highest bit set, so that a lost byte damages one command only.
//
// Schedule: write_o is high for one clock. Latency: one clock after the third byte.
// Cost: 21 bits of pixel and code, three state bits.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module target_command #(
    parameter int NP = 10,
    parameter int PIXELS = 64,
    localparam int PIXEL_WIDTH = dtof_pkg::index_width(PIXELS)
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   valid_i,
    input  logic [            7:0] data_i,
    output logic                   write_o,
    output logic [PIXEL_WIDTH-1:0] pixel_o,
    output logic [         NP-1:0] code_o
);

  `DTOF_REQUIRE(g_illegal_np, NP >= 8 && NP <= 14, "target_command: NP must be 8 to 14")
  `DTOF_REQUIRE(g_illegal_pixels, PIXELS <= 128 << (14 - NP), "target_command: PIXELS must be at most 128 x 2^(14 - NP)")

  logic [1:0] bytes_q;  // bytes of the present command so far
  logic [6:0] low_pixel_q;
  logic [13:0] number_q;
  logic [20:0] pixel;
  logic complete_q;

  assign pixel = {14'(number_q >> NP), low_pixel_q};

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      bytes_q <= '0;
      complete_q <= 1'b0;
    end else begin
      complete_q <= valid_i && !data_i[7] && (bytes_q == 2'd2);
      if (valid_i) begin
        if (data_i[7]) begin
          bytes_q <= 2'd1;
        end else begin
          bytes_q <= (bytes_q == 2'd1) ? 2'd2 : 2'd0;
        end
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (valid_i && data_i[7]) begin
      low_pixel_q <= data_i[6:0];
    end
    if (valid_i && !data_i[7]) begin
      number_q <= {number_q[6:0], data_i[6:0]};
    end
  end

  assign write_o = complete_q && (32'(pixel) < PIXELS);
  assign pixel_o = pixel[PIXEL_WIDTH-1:0];
  assign code_o = number_q[NP-1:0];

endmodule

`default_nettype wire
