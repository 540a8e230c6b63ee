// SPDX-License-Identifier: Apache-2.0
// poolPointer: the entry of TEMPLATE for the bin that the engines add up, and whether it hides the bin; for all engines.
//
// Equation (docs/reference/poolpointer.md, Template): bin i's sum over a group and its neighbours falls by TEMPLATE[i] units. One of the
// first 7 bins is hidden if its entry is 128 or more.
//
// Schedule: both are those of bin_i a clock before. Cost: a multiplexer of 32 entries, 9 flip-flops, per array.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_coarse_template (
    input  logic                                            clk_i,
    input  logic [dtof_pkg::POOL_COARSE_BINS*dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] template_i,  // entry 0 lowest
    input  logic [$clog2(dtof_pkg::POOL_COARSE_BINS)-1:0]   bin_i,
    output logic [dtof_pkg::POOL_TEMPLATE_WIDTH-1:0]        entry_o,
    output logic                                            hidden_o
);

  localparam int HIDDEN_BINS = 7;

  logic [dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] entry;
  assign entry = template_i[bin_i*dtof_pkg::POOL_TEMPLATE_WIDTH+:dtof_pkg::POOL_TEMPLATE_WIDTH];

  always_ff @(posedge clk_i) begin
    entry_o <= entry;
    hidden_o <= entry[dtof_pkg::POOL_TEMPLATE_WIDTH-1] && 32'(bin_i) < HIDDEN_BINS;
  end

endmodule

`default_nettype wire
