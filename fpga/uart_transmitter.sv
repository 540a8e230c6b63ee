// SPDX-License-Identifier: Apache-2.0
// Sends bytes to a serial line: a start bit (0), eight data bits from the lowest on, a stop bit (1).
//
// Schedule: a byte is accepted when the line is free; it takes ten bits of CLOCKS_PER_BIT clocks each.
// Latency: one clock from acceptance to the start bit. Cost: a shift register of ten bits, two counters.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module uart_transmitter #(
    parameter int CLOCKS_PER_BIT = 12
) (
    input  logic       clk_i,
    input  logic       rst_ni,
    input  logic       valid_i,
    output logic       ready_o,
    input  logic [7:0] data_i,
    output logic       tx_o
);

  localparam int COUNT_WIDTH = dtof_pkg::index_width(CLOCKS_PER_BIT);
  localparam int FRAME_BITS = 10;

  `DTOF_REQUIRE(g_illegal_clocks, CLOCKS_PER_BIT >= 4, "uart_transmitter: CLOCKS_PER_BIT must be at least 4")

  logic [FRAME_BITS-1:0] shift_q;  // the lowest bit drives the line
  logic [3:0] bits_q;              // bits still to send
  logic [COUNT_WIDTH-1:0] count_q;

  assign ready_o = (bits_q == '0);
  assign tx_o = shift_q[0];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      shift_q <= {FRAME_BITS{1'b1}};
      bits_q <= '0;
      count_q <= '0;
    end else if (ready_o) begin
      if (valid_i) begin
        shift_q <= {1'b1, data_i, 1'b0};
        bits_q <= 4'(FRAME_BITS);
      end
    end else if (count_q == COUNT_WIDTH'(CLOCKS_PER_BIT - 1)) begin
      count_q <= '0;
      shift_q <= {1'b1, shift_q[FRAME_BITS-1:1]};
      bits_q <= bits_q - 1'b1;
    end else begin
      count_q <= count_q + 1'b1;
    end
  end

endmodule

`default_nettype wire
