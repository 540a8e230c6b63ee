// SPDX-License-Identifier: Apache-2.0
// poolPointer: AXI4-Stream of the results: one beat per engine for each pixel that all engines have decided together.
//
// Commands and results between here and the engines take LATENCY clocks, so the results of send_i arrive LATENCY clocks later. A set
// of results, one per engine, is loaded in parallel and shifted out, engine 0 first. The last engine may have fewer columns; it then has
// no beat for the missing ones. Two more sets fit behind the set that is being sent, so that the engines decide the next pixels meanwhile.
// The sets on their way count, too: with LATENCY above 8 the engines of a narrow array wait for some clocks. In a wide array the output is
// slower than the engines anyway.
// tdata = {column, row, code, fraction, confidence}. tvalid does not fall before tready.
// Latency: LATENCY + 1 clocks from send_i to the first beat if no other set is being sent; then one beat per clock while tready is high.
// Cost: three results per engine, counters, per array.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_result_output #(
    parameter int ENGINES = 8,
    parameter int ENGINE_COLUMNS = 25,
    parameter int SRAM_NUM = 200,
    parameter int ROW_WIDTH = 8,
    parameter int RESULT_WIDTH = 25,
    parameter int LATENCY = 2,  // clocks from send_i to results_i
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int STEP_WIDTH = dtof_pkg::index_width(ENGINE_COLUMNS)
) (
    input  logic                                           clk_i,
    input  logic                                           rst_ni,
    input  logic                                           send_i,     // must stay low in a step that begins with waits_o high
    input  logic [                         STEP_WIDTH-1:0] column_i,   // column within each engine; column_i, row_i and last_i come with send_i
    input  logic [                          ROW_WIDTH-1:0] row_i,
    input  logic                                           last_i,     // last pixels of the frame
    input  logic [               ENGINES*RESULT_WIDTH-1:0] results_i,  // LATENCY clocks after send_i
    output logic                                           waits_o,    // no room for another set
    output logic                                           busy_o,     // a set is expected or is being sent
    output logic                                           tvalid_o,
    input  logic                                           tready_i,
    output logic [COLUMN_WIDTH+ROW_WIDTH+RESULT_WIDTH-1:0] tdata_o,
    output logic                                           tlast_o
);

  localparam int ENGINE_WIDTH = dtof_pkg::index_width(ENGINES);
  localparam int LAST_ENGINE_COLUMNS = SRAM_NUM - (ENGINES - 1) * ENGINE_COLUMNS;
  localparam int LAST_BUT_ONE = (ENGINES > 1) ? ENGINES - 2 : 0;
  localparam int PLACE_WIDTH = 1 + ROW_WIDTH + STEP_WIDTH;  // {last, row, column}
  localparam int SET_WIDTH = PLACE_WIDTH + ENGINES * RESULT_WIDTH;
  localparam logic [1:0] SETS = 2'd3;

  // Number of sets that were requested and not completely sent.

  logic [1:0] sets_q;
  logic set_sent;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      sets_q <= '0;
    end else begin
      sets_q <= sets_q + 2'(send_i) - 2'(set_sent);
    end
  end

  // Place of the arriving set in the array: delayed by LATENCY clocks, until its results arrive.

  logic arrives;
  logic [PLACE_WIDTH-1:0] place;

  dtof_broadcast #(
      .WIDTH (1 + PLACE_WIDTH),
      .STAGES(LATENCY)
  ) u_on_the_way (
      .clk_i (clk_i),
      .rst_ni(rst_ni),
      .from_i({send_i, last_i, row_i, column_i}),
      .to_o  ({arrives, place})
  );

  // The set that is being sent, and up to two sets behind it.

  logic valid_q, last_q, short_q, last_beat, take;
  logic [1:0] waiting_q;
  logic [2*SET_WIDTH-1:0] waiting_sets_q;  // the older set lowest
  logic [SET_WIDTH-1:0] arriving, next_set;
  logic [STEP_WIDTH-1:0] next_column;
  logic [ROW_WIDTH-1:0] next_row;
  logic next_last;
  logic [ENGINES*RESULT_WIDTH-1:0] next_results;
  logic [ENGINE_WIDTH-1:0] engine_q;
  logic [COLUMN_WIDTH-1:0] column_q;
  logic [ROW_WIDTH-1:0] row_q;
  logic [ENGINES*RESULT_WIDTH-1:0] results_q;

  assign last_beat = (engine_q == (short_q ? ENGINE_WIDTH'(LAST_BUT_ONE) : ENGINE_WIDTH'(ENGINES - 1)));
  assign set_sent = valid_q && tready_i && last_beat;
  assign arriving = {place, results_i};
  assign next_set = (waiting_q != '0) ? waiting_sets_q[SET_WIDTH-1:0] : arriving;
  assign {next_last, next_row, next_column, next_results} = next_set;
  assign take = !valid_q && (waiting_q != '0 || arrives);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q <= 1'b0;
      waiting_q <= '0;
      last_q <= 1'b0;
      short_q <= 1'b0;
      engine_q <= '0;
      column_q <= '0;
      row_q <= '0;
    end else begin
      waiting_q <= waiting_q + 2'(arrives) - 2'(take);
      if (take) begin
        valid_q <= 1'b1;
        last_q <= next_last;
        short_q <= (32'(next_column) >= LAST_ENGINE_COLUMNS);
        engine_q <= '0;
        column_q <= COLUMN_WIDTH'(next_column);
        row_q <= next_row;
      end else if (valid_q && tready_i) begin
        valid_q <= !last_beat;
        engine_q <= engine_q + 1'b1;
        column_q <= column_q + COLUMN_WIDTH'(ENGINE_COLUMNS);
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (take) begin
      results_q <= next_results;
    end else if (valid_q && tready_i) begin
      results_q <= results_q >> RESULT_WIDTH;
    end
    if (take && waiting_q[1]) begin
      waiting_sets_q[SET_WIDTH-1:0] <= waiting_sets_q[SET_WIDTH+:SET_WIDTH];
    end else if (arrives && (waiting_q == '0 || take)) begin
      waiting_sets_q[SET_WIDTH-1:0] <= arriving;
    end
    // If no set waits, this copy is not read.
    if (arrives) begin
      waiting_sets_q[SET_WIDTH+:SET_WIDTH] <= arriving;
    end
  end

  `DTOF_ASSERT(a_room, !(send_i && sets_q == SETS), "results were given while three sets wait")

  assign waits_o = (sets_q == SETS) || (sets_q == SETS - 2'd1 && send_i);
  assign busy_o = (sets_q != '0);
  assign tvalid_o = valid_q;
  assign tdata_o = {column_q, row_q, results_q[RESULT_WIDTH-1:0]};
  assign tlast_o = last_q && last_beat;

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
