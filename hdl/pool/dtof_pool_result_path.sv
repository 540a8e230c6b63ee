// SPDX-License-Identifier: Apache-2.0
// poolPointer: the way of the results from the engines to the port, once per array: registers in a wide array, the AXI4-Stream, and with
// AMPLITUDE = 1 ambient and amplitude.
//
// An engine gives {background, advantage, depth}, the first two only with AMPLITUDE = 1: they have fewer bits than ambient and amplitude,
// which dtof_pkg::pool_amplitude and the stored part of the background yield behind the stream.
// Latency: LATENCY + STAGES + 1 clocks from send_i to the first beat (dtof_pool_result_output).
// Cost: STAGES registers for each engine's result, and dtof_pool_result_output, per array.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_result_path #(
    parameter int ENGINES = 6,
    parameter int ENGINE_COLUMNS = 34,  // columns of a full engine
    parameter int SRAM_NUM = 200,
    parameter int ROW_WIDTH = 8,
    parameter int DEPTH_WIDTH = 24,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int KEPT_WIDTH = 6,  // bits of a background
    parameter int AMPLITUDE = 0,
    parameter int LATENCY = 2,  // clocks from send_i to results_i
    parameter int STAGES = 0,
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int STEP_WIDTH = dtof_pkg::index_width(ENGINE_COLUMNS),
    localparam int SENT_RESULT_WIDTH = DEPTH_WIDTH + ((AMPLITUDE != 0) ? KEPT_WIDTH + ADVANTAGE_WIDTH : 0),
    localparam int TDATA_WIDTH = COLUMN_WIDTH + ROW_WIDTH + DEPTH_WIDTH + dtof_pkg::pool_light_width(ADVANTAGE_WIDTH, AMPLITUDE)
) (
    input  logic                                 clk_i,
    input  logic                                 rst_ni,
    input  logic                                 send_i,  // up to busy_o: as in dtof_pool_result_output
    input  logic [               STEP_WIDTH-1:0] column_i,
    input  logic [                ROW_WIDTH-1:0] row_i,
    input  logic                                 last_i,
    output logic                                 waits_o,
    output logic                                 busy_o,
    input  logic [ENGINES*SENT_RESULT_WIDTH-1:0] results_i,  // LATENCY clocks after send_i
    output logic                                 tvalid_o,
    input  logic                                 tready_i,
    output logic [              TDATA_WIDTH-1:0] tdata_o,
    output logic                                 tlast_o
);

  logic [COLUMN_WIDTH+ROW_WIDTH+SENT_RESULT_WIDTH-1:0] sent_result;
  logic [ENGINES*SENT_RESULT_WIDTH-1:0] results_there;

  generate
    if (STAGES > 0) begin : g_result_stages
      dtof_broadcast #(
          .WIDTH (ENGINES * SENT_RESULT_WIDTH),
          .STAGES(STAGES)
      ) u_results (
          .clk_i (clk_i),
          .rst_ni(rst_ni),
          .from_i(results_i),
          .to_o  (results_there)
      );
    end else begin : g_no_result_stages
      assign results_there = '0;
    end
  endgenerate

  dtof_pool_result_output #(
      .ENGINES       (ENGINES),
      .ENGINE_COLUMNS(ENGINE_COLUMNS),
      .SRAM_NUM      (SRAM_NUM),
      .ROW_WIDTH     (ROW_WIDTH),
      .RESULT_WIDTH  (SENT_RESULT_WIDTH),
      .LATENCY       (LATENCY + STAGES)
  ) u_result_output (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .send_i   (send_i),
      .column_i (column_i),
      .row_i    (row_i),
      .last_i   (last_i),
      .results_i((STAGES > 0) ? results_there : results_i),
      .waits_o  (waits_o),
      .busy_o   (busy_o),
      .tvalid_o (tvalid_o),
      .tready_i (tready_i),
      .tdata_o  (sent_result),
      .tlast_o  (tlast_o)
  );

  generate
    if (AMPLITUDE != 0) begin : g_amplitude
      localparam int LOST_WIDTH = dtof_pkg::POOL_BACKGROUND_WIDTH - KEPT_WIDTH;
      localparam int AMPLITUDE_WIDTH = dtof_pkg::pool_amplitude_width(ADVANTAGE_WIDTH);
      logic [dtof_pkg::POOL_BACKGROUND_WIDTH-1:0] ambient;
      logic [9:0] amplitude;
      // The low bits that the group's word does not store are replaced by the middle of their range.
      assign ambient = (dtof_pkg::POOL_BACKGROUND_WIDTH'(sent_result[DEPTH_WIDTH+ADVANTAGE_WIDTH+:KEPT_WIDTH]) << LOST_WIDTH)
          | dtof_pkg::POOL_BACKGROUND_WIDTH'((1 << LOST_WIDTH) >> 1);
      assign amplitude = dtof_pkg::pool_amplitude(ADVANTAGE_WIDTH, 7'(sent_result[DEPTH_WIDTH+:ADVANTAGE_WIDTH]));
      assign tdata_o = {sent_result[SENT_RESULT_WIDTH+:COLUMN_WIDTH+ROW_WIDTH], ambient, amplitude[AMPLITUDE_WIDTH-1:0],
                        sent_result[DEPTH_WIDTH-1:0]};
      if (AMPLITUDE_WIDTH < 10) begin : g_unused
        logic unused_amplitude;
        assign unused_amplitude = ^amplitude[9:AMPLITUDE_WIDTH];
      end
    end else begin : g_depth_alone
      assign tdata_o = sent_result;
    end
  endgenerate

endmodule

`default_nettype wire
