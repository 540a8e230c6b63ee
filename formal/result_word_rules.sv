// SPDX-License-Identifier: Apache-2.0
// Proves that a result word of dtof_subsystem has the column, row, position and confidence that are expected, and the status that follows
// (docs/user/integration.md), for a read-out whose confidence is a counter and a frame without WEAK_BELOW and without masked columns.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module result_word_rules #(
    parameter int COLUMN = 0,
    parameter int ROW = 0,
    parameter int CONFIDENCE_WIDTH = 2
) (
    input logic        checking,
    input logic        here_i,       // the word is at the port
    input logic [63:0] tdata_i,
    input logic [31:0] position_i,
    input logic [31:0] confidence_i
);

  logic empty, full;
  logic [63:0] expected;

  assign empty = (confidence_i == 32'd0);
  assign full = (confidence_i == 32'((1 << CONFIDENCE_WIDTH) - 1));
  // Bits 63 to 56: aborted, raw, second, saturated, masked, empty, weak, valid.
  assign expected = {3'b000, full, 1'b0, empty, 1'b0, !empty, 12'(COLUMN), 12'(ROW), 16'(confidence_i), 16'(position_i)};

  `PROVE(a_word, !here_i || tdata_i == expected)

endmodule

`default_nettype wire
