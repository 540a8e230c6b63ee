// SPDX-License-Identifier: Apache-2.0
// AXI4-Stream from the columns' result chain: one beat a column for the pixel (row) just read out.
//
// The columns' result registers form a shift chain whose head is column 0; each accepted beat shifts it by
// one column. The shift is a register's output, so no path leads from tready to 200 columns in one clock.
// tdata = {column, row, code, fraction, confidence}; tlast on the last column of the last row.
// Latency: 2 SRAM_NUM + 1 clocks a row when tready stays high; the next row is scanned meanwhile. tvalid never
// falls before tready.
// Cost: a column counter, four flip-flops.
`include "dtof_macros.svh"

module result_output #(
    parameter int SRAM_NUM = 200,
    parameter int ROW_WIDTH = 8,
    parameter int RESULT_WIDTH = 14,
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM)
) (
    input  logic                                           clk_i,
    input  logic                                           rst_ni,
    input  logic                                           start_i,     // the chain holds a row's results
    input  logic                                           last_row_i,
    input  logic [                          ROW_WIDTH-1:0] row_i,
    input  logic [                       RESULT_WIDTH-1:0] head_i,      // result register of column 0
    output logic                                           shift_o,
    output logic                                           done_o,      // last beat of the row accepted
    output logic                                           busy_o,      // beats to come: chain and row_i are in use
    output logic                                           tvalid_o,
    input  logic                                           tready_i,
    output logic [COLUMN_WIDTH+ROW_WIDTH+RESULT_WIDTH-1:0] tdata_o,
    output logic                                           tlast_o
);

  localparam logic [COLUMN_WIDTH-1:0] LAST_COLUMN = COLUMN_WIDTH'(SRAM_NUM - 1);

  logic valid_q, shift_q, done_q;
  logic [COLUMN_WIDTH-1:0] column_q;
  logic last_column, accepted;

  assign last_column = (column_q == LAST_COLUMN);
  assign accepted = valid_q && tready_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q <= 1'b0;
      shift_q <= 1'b0;
      done_q <= 1'b0;
      column_q <= '0;
    end else begin
      shift_q <= accepted && !last_column;
      done_q <= accepted && last_column;
      if (start_i) begin
        valid_q <= 1'b1;
        column_q <= '0;
      end else if (accepted) begin
        valid_q <= 1'b0;
        column_q <= last_column ? column_q : column_q + 1'b1;
      end else if (shift_q) begin
        valid_q <= 1'b1;
      end
    end
  end

  `DTOF_ASSERT(a_one_row, !(start_i && (valid_q || shift_q)), "a row of results is started while another is sent")

  assign shift_o = shift_q;
  assign done_o = done_q;
  assign busy_o = valid_q || shift_q;
  assign tvalid_o = valid_q;
  assign tdata_o = {column_q, row_i, head_i};
  assign tlast_o = last_row_i && last_column;

`ifndef SYNTHESIS
  stream_rules #(
      .WIDTH(COLUMN_WIDTH + ROW_WIDTH + RESULT_WIDTH)
  ) u_stream_rules (
      .clk_i   (clk_i),
      .rst_ni  (rst_ni),
      .tvalid_i(tvalid_o),
      .tready_i(tready_i),
      .tdata_i (tdata_o),
      .tlast_i (tlast_o)
  );
`endif

endmodule
