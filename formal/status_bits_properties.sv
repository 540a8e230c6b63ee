// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_status_bits, for one arbitrary address: after a read, valid_o says whether the address was written since the last
// clear.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module status_bits_properties #(
    parameter int DEPTH = 5,
    localparam int ADDR_WIDTH = dtof_pkg::index_width(DEPTH)
) (
    input logic                  clk_i,
    input logic                  clear_i,
    input logic                  write_i,
    input logic [ADDR_WIDTH-1:0] write_addr_i,
    input logic                  read_i,
    input logic [ADDR_WIDTH-1:0] read_addr_i
);

  logic checking;
  assign checking = 1'b1;
  (* anyconst *) logic [ADDR_WIDTH-1:0] watched;

  logic valid;

  dtof_status_bits #(.DEPTH(DEPTH)) u_dut (
      .clk_i       (clk_i),
      .clear_i     (clear_i),
      .write_i     (write_i),
      .write_addr_i(write_addr_i),
      .read_i      (read_i),
      .read_addr_i (read_addr_i),
      .valid_o     (valid)
  );

  // The state is known from the first clear on.
  logic known_q = 1'b0;
  logic read_q = 1'b0;
  logic written_q, expected_q;

  always_ff @(posedge clk_i) begin
    known_q <= known_q || clear_i;
    if (clear_i) begin
      written_q <= 1'b0;
    end else if (write_i && write_addr_i == watched) begin
      written_q <= 1'b1;
    end
    read_q <= known_q && read_i && (read_addr_i == watched);
    expected_q <= written_q;
  end

  `ASSUME(m_write_in_range, 32'(write_addr_i) < DEPTH)
  `ASSUME(m_read_in_range, 32'(read_addr_i) < DEPTH)
  `PROVE(a_valid, !read_q || valid == expected_q)
  `GOAL(read_q && valid)

endmodule

`default_nettype wire
