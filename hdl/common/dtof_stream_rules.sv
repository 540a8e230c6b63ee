// SPDX-License-Identifier: Apache-2.0
// Rules of an AXI4-Stream source as assertions, for simulation and proofs; synthesis leaves it out.
//
// Rule: after tvalid without tready, tvalid stays high and tdata and tlast stay unchanged until tready.
// Latency: none. Cost: none in silicon.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_stream_rules #(
    parameter int WIDTH = 8
) (
    input logic             clk_i,
    input logic             rst_ni,
    input logic             tvalid_i,
    input logic             tready_i,
    input logic [WIDTH-1:0] tdata_i,
    input logic             tlast_i
);

  logic waits_q, tlast_q;
  logic [WIDTH-1:0] tdata_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      waits_q <= 1'b0;
    end else begin
      waits_q <= tvalid_i && !tready_i;
    end
  end

  always_ff @(posedge clk_i) begin
    tdata_q <= tdata_i;
    tlast_q <= tlast_i;
  end

  `DTOF_ASSERT(a_valid_holds, !waits_q || tvalid_i, "tvalid fell before tready")
  `DTOF_ASSERT(a_data_holds, !waits_q || (tdata_i == tdata_q && tlast_i == tlast_q),
               "tdata or tlast changed before tready")

endmodule

`default_nettype wire
