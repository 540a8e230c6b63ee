// SPDX-License-Identifier: Apache-2.0
// Lines of timestamps on their way to an array, which takes an acquisition without a pause once it has begun.
//
// 1. A line, one timestamp of every column, comes whenever the source has one; the source may pause anywhere.
// 2. An acquisition of ACQUISITION_LINES lines is offered to the array when release_i lines are in the buffer. With
//    release_i = ACQUISITION_LINES it is whole then, and cannot be interrupted.
// 3. With less, the buffer may run empty inside an acquisition (underrun_o). Its other lines then are "no detection",
//    and those that the source still delivers for it are thrown away, so that the next acquisition begins where it should.
//
// Latency: two clocks from a line's acceptance to its offer. A line a clock goes in and out at the same time.
// Cost: an SRAM of LINES x WIDTH bits, two addresses, four counters.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_line_buffer #(
    parameter int ACQUISITION_LINES = 320,  // of an acquisition
    parameter int LINES = 324,              // that the memory holds; one more waits at its output
    parameter int WIDTH = 2000,             // bits of a line
    localparam int LEVEL_WIDTH = $clog2(LINES + 2)
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    // side band of the SRAM macros, which the technology folder gives a meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    input  logic                   flush_i,      // empties the buffer; not while an acquisition is under way
    input  logic [LEVEL_WIDTH-1:0] release_i,    // 1 to the smaller of ACQUISITION_LINES and LINES
    output logic [LEVEL_WIDTH-1:0] level_o,      // lines in the buffer
    output logic                   underrun_o,   // the array needs a line that is not here: once an acquisition
    output logic                   misframed_o,  // s_tlast_i is not where an acquisition ends; one clock
    // from the source, AXI4-Stream
    input  logic                   s_tvalid_i,
    output logic                   s_tready_o,
    input  logic [      WIDTH-1:0] s_tdata_i,
    input  logic                   s_tlast_i,    // the last line of an acquisition; only checked
    // to the array
    output logic                   line_valid_o,  // high for a whole acquisition
    input  logic                   line_ready_i,
    output logic [      WIDTH-1:0] line_o
);

  localparam int ADDR_WIDTH = dtof_pkg::index_width(LINES);
  localparam int INDEX_WIDTH = dtof_pkg::index_width(ACQUISITION_LINES + 1);
  localparam logic [ADDR_WIDTH-1:0] LAST_ADDRESS = ADDR_WIDTH'(LINES - 1);
  localparam logic [INDEX_WIDTH-1:0] LAST_LINE = INDEX_WIDTH'(ACQUISITION_LINES - 1);
  localparam logic [INDEX_WIDTH-1:0] ALL_LINES = INDEX_WIDTH'(ACQUISITION_LINES);

  `DTOF_REQUIRE(g_illegal_acquisition, ACQUISITION_LINES >= 1, "dtof_line_buffer: ACQUISITION_LINES must be at least 1")
  `DTOF_REQUIRE(g_illegal_lines, LINES >= 2, "dtof_line_buffer: LINES must be at least 2")

  // The source's side.

  logic [ADDR_WIDTH-1:0] write_address_q, read_address_q;
  logic [LEVEL_WIDTH-1:0] stored_q;  // in the memory
  logic [INDEX_WIDTH-1:0] source_line_q;
  logic write, read, take, head_q;

  assign s_tready_o = (stored_q != LEVEL_WIDTH'(LINES)) && !flush_i;
  assign write = s_tvalid_i && s_tready_o;
  assign misframed_o = write && (s_tlast_i != (source_line_q == LAST_LINE));

  // The line at the memory's output (head_q) stays there until the next is read.
  assign read = (stored_q != '0) && (!head_q || take);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      write_address_q <= '0;
      read_address_q <= '0;
      stored_q <= '0;
      source_line_q <= '0;
      head_q <= 1'b0;
    end else if (flush_i) begin
      write_address_q <= '0;
      read_address_q <= '0;
      stored_q <= '0;
      source_line_q <= '0;
      head_q <= 1'b0;
    end else begin
      if (write) begin
        write_address_q <= (write_address_q == LAST_ADDRESS) ? '0 : write_address_q + 1'b1;
        source_line_q <= (source_line_q == LAST_LINE) ? '0 : source_line_q + 1'b1;
      end
      if (read) begin
        read_address_q <= (read_address_q == LAST_ADDRESS) ? '0 : read_address_q + 1'b1;
      end
      stored_q <= stored_q + LEVEL_WIDTH'(write) - LEVEL_WIDTH'(read);
      head_q <= read || (head_q && !take);
    end
  end

  logic [WIDTH-1:0] head;

  dtof_sram #(
      .PORTS(2),
      .DEPTH(LINES),
      .WIDTH(WIDTH)
  ) u_lines (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (sram_cfg_o),
      .read_en_i   (read),
      .read_addr_i (read_address_q),
      .read_data_o (head),
      .write_en_i  (write),
      .write_addr_i(write_address_q),
      .write_data_i(s_tdata_i)
  );

  // The array's side.

  logic inside_q, lost_q;
  logic [INDEX_WIDTH-1:0] line_q;     // of the acquisition
  logic [INDEX_WIDTH-1:0] discard_q;  // lines of a lost acquisition that are still to come
  logic begin_allowed, step, last_line, missing;

  assign level_o = stored_q + LEVEL_WIDTH'(head_q);
  assign begin_allowed = head_q && (discard_q == '0) && (level_o >= release_i);
  assign line_valid_o = inside_q || begin_allowed;
  assign step = line_valid_o && line_ready_i;
  assign last_line = (line_q == LAST_LINE);
  assign missing = lost_q || (inside_q && !head_q);
  assign underrun_o = step && inside_q && !head_q && !lost_q;
  assign line_o = missing ? '1 : head;
  assign take = head_q && ((step && !missing) || (discard_q != '0));

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      inside_q <= 1'b0;
      lost_q <= 1'b0;
      line_q <= '0;
      discard_q <= '0;
    end else begin
      if (step) begin
        inside_q <= !last_line;
        line_q <= last_line ? '0 : line_q + 1'b1;
        lost_q <= missing && !last_line;
      end
      if (flush_i) begin
        discard_q <= '0;
      end else if (underrun_o) begin
        discard_q <= ALL_LINES - line_q;
      end else if (head_q && (discard_q != '0)) begin
        discard_q <= discard_q - 1'b1;
      end
    end
  end

  `DTOF_ASSERT(a_release, release_i != '0, "release_i is 0")
  `DTOF_ASSERT(a_flush_between, !flush_i || !inside_q, "the buffer is flushed inside an acquisition")

endmodule

`default_nettype wire
