// SPDX-License-Identifier: Apache-2.0
// Receives bytes from a serial line (format: uart_transmitter.sv). The line is asynchronous to clk_i; two flip-flops synchronise it.
//
// Schedule: each bit is sampled in its middle; valid_o is high for one clock in the middle of the stop bit. A byte with a stop
// bit of 0 is not reported.
// Latency: nine and a half bits from the start bit to valid_o. Cost: a shift register of eight bits, two counters, two flip-flops.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module uart_receiver #(
    parameter int CLOCKS_PER_BIT = 12
) (
    input  logic       clk_i,
    input  logic       rst_ni,
    input  logic       rx_i,     // asynchronous to clk_i
    output logic       valid_o,
    output logic [7:0] data_o
);

  localparam int COUNT_WIDTH = dtof_pkg::index_width(CLOCKS_PER_BIT);
  localparam logic [3:0] STOP_BIT = 4'd9;

  `DTOF_REQUIRE(g_illegal_clocks, CLOCKS_PER_BIT >= 4, "uart_receiver: CLOCKS_PER_BIT must be at least 4")

  logic meta_q, line_q, busy_q, sample;
  logic [3:0] bit_q;  // 0: start bit
  logic [COUNT_WIDTH-1:0] count_q;
  logic [7:0] shift_q;

  assign sample = busy_q && (count_q == '0);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      meta_q <= 1'b1;
      line_q <= 1'b1;
      busy_q <= 1'b0;
      bit_q <= '0;
      count_q <= '0;
    end else begin
      meta_q <= rx_i;
      line_q <= meta_q;
      if (!busy_q) begin
        busy_q <= !line_q;
        bit_q <= '0;
        count_q <= COUNT_WIDTH'(CLOCKS_PER_BIT / 2 - 1);
      end else if (!sample) begin
        count_q <= count_q - 1'b1;
      end else begin
        count_q <= COUNT_WIDTH'(CLOCKS_PER_BIT - 1);
        bit_q <= bit_q + 1'b1;
        // A start bit that is no longer 0 in its middle is ignored.
        busy_q <= (bit_q == '0) ? !line_q : (bit_q != STOP_BIT);
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (sample && bit_q != STOP_BIT) begin
      shift_q <= {line_q, shift_q[7:1]};
    end
  end

  assign valid_o = sample && (bit_q == STOP_BIT) && line_q;
  assign data_o = shift_q;

endmodule

`default_nettype wire
