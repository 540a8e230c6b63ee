// SPDX-License-Identifier: Apache-2.0
// poolPointer: AXI4-Stream from the engines, one beat an engine for the pixel that all have just decided.
//
// The results are taken side by side and shifted out, engine 0 first; the last engine may have fewer columns. Results
// given meanwhile wait where they are, and nothing more is to be given until they are taken.
// tdata = {column, row, code, fraction, confidence}. tvalid never falls before tready.
// Latency: one clock a beat when tready stays high.
// Cost: a result register an engine, counters, per array.
`include "dtof_macros.svh"

module pool_result_output #(
    parameter int ENGINES = 8,
    parameter int ENGINE_COLUMNS = 25,
    parameter int SRAM_NUM = 200,
    parameter int ROW_WIDTH = 8,
    parameter int RESULT_WIDTH = 25,
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int STEP_WIDTH = dtof_pkg::index_width(ENGINE_COLUMNS)
) (
    input  logic                                           clk_i,
    input  logic                                           rst_ni,
    input  logic                                           send_i,     // not while waits_o
    input  logic [                         STEP_WIDTH-1:0] column_i,   // of each engine
    input  logic [                          ROW_WIDTH-1:0] row_i,
    input  logic                                           last_i,     // the frame's last pixels
    input  logic [               ENGINES*RESULT_WIDTH-1:0] results_i,
    output logic                                           waits_o,
    output logic                                           busy_o,
    output logic                                           tvalid_o,
    input  logic                                           tready_i,
    output logic [COLUMN_WIDTH+ROW_WIDTH+RESULT_WIDTH-1:0] tdata_o,
    output logic                                           tlast_o
);

  localparam int ENGINE_WIDTH = dtof_pkg::index_width(ENGINES);
  localparam int LAST_ENGINE_COLUMNS = SRAM_NUM - (ENGINES - 1) * ENGINE_COLUMNS;
  localparam int LAST_BUT_ONE = (ENGINES > 1) ? ENGINES - 2 : 0;

  logic valid_q, waits_q, last_q, short_q, last_beat;
  logic [ENGINE_WIDTH-1:0] engine_q;
  logic [COLUMN_WIDTH-1:0] column_q;
  logic [ROW_WIDTH-1:0] row_q;
  logic [ENGINES*RESULT_WIDTH-1:0] results_q;

  assign last_beat = (engine_q == (short_q ? ENGINE_WIDTH'(LAST_BUT_ONE) : ENGINE_WIDTH'(ENGINES - 1)));

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q <= 1'b0;
      waits_q <= 1'b0;
      last_q <= 1'b0;
      short_q <= 1'b0;
      engine_q <= '0;
      column_q <= '0;
      row_q <= '0;
    end else if (!valid_q) begin
      valid_q <= send_i || waits_q;
      waits_q <= 1'b0;
      last_q <= last_i;
      short_q <= (32'(column_i) >= LAST_ENGINE_COLUMNS);
      engine_q <= '0;
      column_q <= COLUMN_WIDTH'(column_i);
      row_q <= row_i;
    end else begin
      waits_q <= waits_q || send_i;
      if (tready_i) begin
        valid_q <= !last_beat;
        engine_q <= engine_q + 1'b1;
        column_q <= column_q + COLUMN_WIDTH'(ENGINE_COLUMNS);
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (!valid_q) begin
      results_q <= results_i;
    end else if (tready_i) begin
      results_q <= results_q >> RESULT_WIDTH;
    end
  end

  `DTOF_ASSERT(a_one_waits, !(send_i && waits_q), "results were given while others wait")

  assign waits_o = waits_q;
  assign busy_o = valid_q || waits_q;
  assign tvalid_o = valid_q;
  assign tdata_o = {column_q, row_q, results_q[RESULT_WIDTH-1:0]};
  assign tlast_o = last_q && last_beat;

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
