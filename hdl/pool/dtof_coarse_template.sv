// SPDX-License-Identifier: Apache-2.0
// poolPointer, decode: selects the entry of TEMPLATE that all engines subtract from a bin's sum, and says whether the bin is hidden.
//
// Equation (docs/reference/poolpointer.md, Template): the sum of bin i over a group and its neighbours is reduced by TEMPLATE[i]
// units. A bin below 7 is hidden if its entry is 128 or more.
//
// Schedule: a new bin_i may come in every clock. Latency: 1 clock from bin_i to entry_o and hidden_o.
// Cost: a multiplexer of 32 entries, 9 flip-flops, per array.

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
