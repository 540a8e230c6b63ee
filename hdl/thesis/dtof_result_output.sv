// SPDX-License-Identifier: Apache-2.0
// AXI4-Stream of the results in the columns' result chain: one beat per column for the pixel (row) that was just scanned.
//
// The result registers of the columns form a shift chain whose head is column 0. The way to the chain and back takes LATENCY
// clocks. Therefore the chain is shifted ahead of the beats, as long as all results on their way have room here even if the sink
// does not take any. The shift is the output of a register, so no path leads from tready to all columns in one clock.
// tdata = {column, row, code, fraction, confidence}; tlast on the last column of the last row. tvalid does not fall before tready.
// Latency: SRAM_NUM + LATENCY + 1 clocks per row while tready stays high; the next row is scanned in this time.
// Cost: LATENCY + 2 results, three counters.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_result_output #(
    parameter int SRAM_NUM = 200,
    parameter int ROW_WIDTH = 8,
    parameter int RESULT_WIDTH = 14,
    parameter int LATENCY = 3,  // clocks to the columns and back
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM)
) (
    input  logic                                           clk_i,
    input  logic                                           rst_ni,
    input  logic                                           start_i,     // the first result of a row is at head_i LATENCY + 1 clocks later
    input  logic                                           last_row_i,
    input  logic [                          ROW_WIDTH-1:0] row_i,
    input  logic [                       RESULT_WIDTH-1:0] head_i,      // result register of column 0
    output logic                                           shift_o,
    output logic                                           done_o,      // last beat of the row was accepted
    output logic                                           busy_o,      // the row has beats to come: chain and row_i are in use
    output logic                                           tvalid_o,
    input  logic                                           tready_i,
    output logic [COLUMN_WIDTH+ROW_WIDTH+RESULT_WIDTH-1:0] tdata_o,
    output logic                                           tlast_o
);

  localparam int PLACES = LATENCY + 2;  // enough for a beat per clock
  localparam int PLACES_WIDTH = $clog2(PLACES + 1);
  localparam int PLACE_WIDTH = $clog2(PLACES);
  localparam logic [PLACE_WIDTH-1:0] LAST_PLACE = PLACE_WIDTH'(PLACES - 1);
  localparam logic [COLUMN_WIDTH-1:0] LAST_COLUMN = COLUMN_WIDTH'(SRAM_NUM - 1);

  logic busy_q, shift_q, done_q, valid_q, last_column, accepted, shift_d, shifted_all, arrives;
  logic [COLUMN_WIDTH-1:0] column_q, head_column_q;  // column of the beat; column at the chain's head after all shifts so far
  logic [LATENCY:0] arrives_q;                       // a column's result is at the head, in (bit number) clocks
  logic [PLACES_WIDTH-1:0] promised_q, promised_d;   // results that are stored or on their way
  logic [PLACES_WIDTH-1:0] kept_q, kept_d;
  logic [PLACE_WIDTH-1:0] read_q, write_q;
  logic [PLACES*RESULT_WIDTH-1:0] results_q;
  logic [RESULT_WIDTH-1:0] result;

  assign last_column = (column_q == LAST_COLUMN);
  assign accepted = valid_q && tready_i;
  assign arrives = arrives_q[0];
  assign shifted_all = (head_column_q == LAST_COLUMN);
  assign shift_d = start_i ? (SRAM_NUM > 1) : busy_q && !shifted_all && (32'(promised_q) < PLACES);
  assign promised_d = promised_q + PLACES_WIDTH'(start_i) + PLACES_WIDTH'(shift_d) - PLACES_WIDTH'(accepted);
  assign kept_d = kept_q + PLACES_WIDTH'(arrives) - PLACES_WIDTH'(accepted);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      busy_q <= 1'b0;
      shift_q <= 1'b0;
      done_q <= 1'b0;
      valid_q <= 1'b0;
      arrives_q <= '0;
      promised_q <= '0;
      kept_q <= '0;
      read_q <= '0;
      write_q <= '0;
      column_q <= '0;
      head_column_q <= '0;
    end else begin
      busy_q <= start_i || (busy_q && !(accepted && last_column));
      shift_q <= shift_d;
      done_q <= accepted && last_column;
      valid_q <= (kept_d != '0);
      arrives_q <= (LATENCY + 1)'({start_i || shift_q, arrives_q} >> 1);
      promised_q <= promised_d;
      kept_q <= kept_d;
      if (accepted) begin
        read_q <= (read_q == LAST_PLACE) ? '0 : read_q + 1'b1;
      end
      if (arrives) begin
        write_q <= (write_q == LAST_PLACE) ? '0 : write_q + 1'b1;
      end
      if (start_i) begin
        column_q <= '0;
        head_column_q <= COLUMN_WIDTH'(shift_d);
      end else begin
        column_q <= (accepted && !last_column) ? column_q + 1'b1 : column_q;
        head_column_q <= shift_d ? head_column_q + 1'b1 : head_column_q;
      end
    end
  end

  // The write enables do not depend on the sink, so that the path from tready is short.
  integer i;
  always_ff @(posedge clk_i) begin
    for (i = 0; i < PLACES; i = i + 1) begin
      if (arrives && write_q == PLACE_WIDTH'(i)) begin
        results_q[i*RESULT_WIDTH+:RESULT_WIDTH] <= head_i;
      end
    end
  end

  integer j;
  always_comb begin
    result = '0;
    for (j = 0; j < PLACES; j = j + 1) begin
      if (read_q == PLACE_WIDTH'(j)) begin
        result = results_q[j*RESULT_WIDTH+:RESULT_WIDTH];
      end
    end
  end

  `DTOF_ASSERT(a_one_row, !(start_i && busy_q), "a row of results is started while another is sent")

  assign shift_o = shift_q;
  assign done_o = done_q;
  assign busy_o = busy_q;
  assign tvalid_o = valid_q;
  assign tdata_o = {column_q, row_i, result};
  assign tlast_o = last_row_i && last_column;

`ifndef SYNTHESIS
  dtof_stream_rules #(
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

`default_nettype wire
