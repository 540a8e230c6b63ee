// SPDX-License-Identifier: Apache-2.0
// Signalled clear (thesis 4.4.2): one flip-flop per SRAM address says whether the address was written since the last
// clear, so that clearing takes one clock.
//
// Schedule: valid_o belongs to read_addr_i of the clock before, like the SRAM's read data; write_i makes an
// address valid from the next clock on; clear_i makes all invalid.
// Latency: 1 clock. Cost: DEPTH flip-flops, a decoder and a multiplexer of DEPTH bits, per column.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_status_bits #(
    parameter int DEPTH = 5120,
    localparam int ADDR_WIDTH = dtof_pkg::index_width(DEPTH)
) (
    input  logic                  clk_i,
    input  logic                  clear_i,
    input  logic                  write_i,
    input  logic [ADDR_WIDTH-1:0] write_addr_i,
    input  logic                  read_i,
    input  logic [ADDR_WIDTH-1:0] read_addr_i,
    output logic                  valid_o
);

  logic [DEPTH-1:0] written_q;

  always_ff @(posedge clk_i) begin
    if (clear_i) begin
      written_q <= '0;
    end else if (write_i) begin
      written_q[write_addr_i] <= 1'b1;
    end
    if (read_i) begin
      valid_o <= written_q[read_addr_i];
    end
  end

endmodule

`default_nettype wire
