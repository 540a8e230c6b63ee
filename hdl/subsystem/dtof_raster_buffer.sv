// SPDX-License-Identifier: Apache-2.0
// Sorts a frame's results into raster order (row by row, within a row column by column), from any order of the array. With
// TARGETS = 2 each pixel of a frame has one result, or each pixel has two and the second comes directly after the first.
//
// 1. Each result is written to the address of its pixel, until the frame's last result.
// 2. Then all results leave, from the first address to the last. Results of the next frame are not accepted before the end.
// 3. cut_i ends a frame that is arriving: none of its results leaves. It also ends a frame that is leaving: the result at the port
//    stays until the sink takes it. Unless this was the last result, a result with m_aborted_o and m_tlast_o follows, whose other
//    fields have no meaning.
//
// Schedule in: clock 0 accepts a result and registers its address, clock 1 writes it. Out: clock 0 reads, clock 1 has the result at the port.
// Latency: the frame. One result per clock enters; after the last one, one result per clock leaves.
// Cost: a single-port SRAM of SRAM_NUM * PIXELS_PER_SRAM * TARGETS results of WIDTH bits, an address, a row and a column.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_raster_buffer #(
    parameter int SRAM_NUM = 200,         // columns
    parameter int PIXELS_PER_SRAM = 160,  // rows
    parameter int WIDTH = 27,             // bits of a result without row and column
    parameter int PARITY = 0,             // 1: each word of the memory has a parity bit
    parameter int TARGETS = 1,            // results per pixel, at most: 1 or 2
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM)
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    // side band of the SRAM macros; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    output logic                   parity_error_o,  // a result that was read two clocks ago is damaged
    input  logic                    cut_i,       // ends the present frame; the next result is of another frame
    // each pixel of a frame once, or each pixel once more with s_second_i
    input  logic                    s_tvalid_i,
    output logic                    s_tready_o,
    input  logic [       WIDTH-1:0] s_result_i,
    input  logic [COLUMN_WIDTH-1:0] s_column_i,
    input  logic [   ROW_WIDTH-1:0] s_row_i,
    input  logic                    s_second_i,  // 0 if TARGETS = 1
    input  logic                    s_tlast_i,   // last result of the frame
    // the same results in raster order
    output logic                    m_tvalid_o,
    input  logic                    m_tready_i,
    output logic [       WIDTH-1:0] m_result_o,
    output logic [COLUMN_WIDTH-1:0] m_column_o,
    output logic [   ROW_WIDTH-1:0] m_row_o,
    output logic                    m_second_o,
    output logic                    m_aborted_o,
    output logic                    unfinished_o,  // cut_i would cut off a whole frame that no earlier cut_i has cut off
    output logic                    m_tlast_o
);

  localparam int RESULTS = SRAM_NUM * PIXELS_PER_SRAM * TARGETS;
  localparam int ADDR_WIDTH = dtof_pkg::index_width(RESULTS);
  localparam logic [COLUMN_WIDTH-1:0] LAST_COLUMN = COLUMN_WIDTH'(SRAM_NUM - 1);
  localparam logic [ROW_WIDTH-1:0] LAST_ROW = ROW_WIDTH'(PIXELS_PER_SRAM - 1);

  // Input. The address is a product and therefore has a register.

  logic reading_q, unread_q, write_q, ends_q, head_q, both_q, both;
  logic [WIDTH-1:0] written_q;
  logic [ADDR_WIDTH-1:0] write_address_q, read_address_q;
  logic accepted, read, taken, last_address, last_target, last_place;

  assign s_tready_o = !reading_q && !ends_q && !cut_i;
  assign accepted = s_tvalid_i && s_tready_o;

  always_ff @(posedge clk_i) begin
    if (accepted) begin
      written_q <= s_result_i;
      write_address_q <= ADDR_WIDTH'((32'(s_row_i) * SRAM_NUM + 32'(s_column_i)) * TARGETS + 32'(s_second_i));
      both_q <= s_second_i;  // the value of the frame's last result counts
    end
  end

  // Output. The result at the memory's output (head_q) stays until the next read.

  logic aborted_q;  // the frame ends as aborted after the result at the output, if there is a result
  logic ended, shown, stays_open;

  assign read = reading_q && unread_q && !cut_i && (!head_q || m_tready_i);
  assign taken = head_q && m_tready_i;
  assign ended = m_tready_i && (head_q ? last_place : aborted_q);  // the sink has taken the frame's last word
  // A result has been at the port, and the last result at the port was not the frame's last.
  assign shown = head_q || (m_column_o != '0) || (m_row_o != '0) || m_second_o;
  assign stays_open = shown && !(head_q && last_place) && !(aborted_q && !head_q && m_tready_i);
  assign both = (TARGETS > 1) && both_q;
  assign last_address = (read_address_q == ADDR_WIDTH'(both ? RESULTS - 1 : RESULTS - TARGETS));
  assign last_target = m_second_o || !both;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      write_q <= 1'b0;
      ends_q <= 1'b0;
      reading_q <= 1'b0;
      unread_q <= 1'b0;
      head_q <= 1'b0;
      aborted_q <= 1'b0;
      read_address_q <= '0;
      m_column_o <= '0;
      m_row_o <= '0;
      m_second_o <= 1'b0;
    end else begin
      write_q <= accepted;
      ends_q <= accepted && s_tlast_i;
      if (cut_i) begin
        reading_q <= (head_q && !m_tready_i) || stays_open;
        unread_q <= 1'b0;
        read_address_q <= '0;
        aborted_q <= stays_open;
      end else if (ends_q) begin
        reading_q <= 1'b1;
        unread_q <= 1'b1;
      end else if (ended) begin
        reading_q <= 1'b0;
        aborted_q <= 1'b0;
      end
      if (read) begin
        unread_q <= !last_address;
        read_address_q <= last_address ? '0 : read_address_q + ADDR_WIDTH'(both ? 1 : TARGETS);
      end
      head_q <= read || (head_q && !m_tready_i);
      if (taken) begin
        m_second_o <= !last_target;
      end
      if (taken && last_target) begin
        m_column_o <= (m_column_o == LAST_COLUMN) ? '0 : m_column_o + 1'b1;
        if (m_column_o == LAST_COLUMN) begin
          m_row_o <= (m_row_o == LAST_ROW) ? '0 : m_row_o + 1'b1;
        end
      end
      if (ended) begin
        m_column_o <= '0;
        m_row_o <= '0;
        m_second_o <= 1'b0;
      end
    end
  end

  dtof_parity_sram #(
      .PORTS (1),
      .DEPTH (RESULTS),
      .WIDTH (WIDTH),
      .PARITY(PARITY)
  ) u_results (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (sram_cfg_o),
      .read_en_i   (read),
      .read_addr_i (read_address_q),
      .read_data_o (m_result_o),
      .ignore_i    (1'b0),
      .error_o     (parity_error_o),
      .write_en_i  (write_q),
      .write_addr_i(write_address_q),
      .write_data_i(written_q)
  );

  assign last_place = (m_column_o == LAST_COLUMN) && (m_row_o == LAST_ROW) && last_target;
  assign unfinished_o = ends_q || (reading_q && !aborted_q && !(head_q && last_place));
  assign m_tvalid_o = head_q || aborted_q;
  assign m_aborted_o = !head_q;
  assign m_tlast_o = !head_q || last_place;

endmodule

`default_nettype wire
