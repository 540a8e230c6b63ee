// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_parity_sram: a word that is as it was written raises no error and has its data; a word with an odd number of changed bits
// raises an error two clocks after its read. A read in the clock of a write to the same address, and a read with ignore_i, raise none. The
// contents of the memory are arbitrary until an address is written: they stand for damaged words.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module parity_sram_properties #(
    parameter int PORTS = 2,
    parameter int DEPTH = 3,
    parameter int WIDTH = 3,
    parameter int PARITIES = 1,
    localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1
) (
    input logic                  clk_i,
    input logic                  reset_i,
    input logic                  read_en_i,
    input logic [ADDR_WIDTH-1:0] read_addr_i,
    input logic                  ignore_i,
    input logic                  write_en_i,
    input logic [ADDR_WIDTH-1:0] write_addr_i,
    input logic [     WIDTH-1:0] write_data_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic [WIDTH-1:0] data;
  logic error;

  dtof_parity_sram #(
      .PORTS (PORTS),
      .DEPTH (DEPTH),
      .WIDTH (WIDTH),
      .PARITY(1),
      .PARITIES(PARITIES)
  ) u_dut (
      .clk_i       (clk_i),
      .rst_ni      (rst_n),
      .cfg_i       ('0),
      .read_en_i   (read_en_i),
      .read_addr_i (read_addr_i),
      .read_data_o (data),
      .ignore_i    (ignore_i),
      .error_o     (error),
      .write_en_i  (write_en_i),
      .write_addr_i(write_addr_i),
      .write_data_i(write_data_i)
  );

  // One address is observed: whether its word was written, with what data, and whether the last two reads were of this address.
  (* anyconst *) logic [ADDR_WIDTH-1:0] watched;
  logic used, written_q, good_q, good_before_q, read_q, read_before_q;
  logic [WIDTH-1:0] word_q, expected_q;

  assign used = read_en_i && !(write_en_i && read_addr_i == write_addr_i);

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      written_q <= 1'b0;
    end else if (write_en_i && write_addr_i == watched) begin
      written_q <= 1'b1;
      word_q <= write_data_i;
    end
    good_q <= rst_n && used && (read_addr_i == watched) && written_q;
    read_q <= rst_n && used;
    expected_q <= word_q;
    good_before_q <= rst_n && good_q;
    read_before_q <= rst_n && read_q && !ignore_i;
  end

  `ASSUME(m_range, read_addr_i < DEPTH && write_addr_i < DEPTH)
  `ASSUME(m_ports, !(PORTS == 1 && read_en_i && write_en_i))
  `PROVE(a_data, !rst_n || !good_q || data == expected_q)
  `PROVE(a_no_false_alarm, !rst_n || !good_before_q || !error)
  `PROVE(a_only_behind_a_read_that_is_used, !rst_n || read_before_q || !error)
  `GOAL(rst_n && error)

endmodule

`default_nettype wire
