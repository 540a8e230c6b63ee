// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_minimum: the smallest value is one of the values, and no value is smaller.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module minimum_properties #(
    parameter int NUMBER = 8,
    parameter int WIDTH = 5
) (
    input logic                    clk_i,
    input logic [NUMBER*WIDTH-1:0] values_i
);

  logic checking;
  assign checking = 1'b1;

  logic [WIDTH-1:0] smallest;
  logic [NUMBER-1:0] equal, not_smaller;

  dtof_minimum #(.NUMBER(NUMBER), .WIDTH(WIDTH)) u_dut (.values_i(values_i), .smallest_o(smallest));

  genvar k;
  generate
    for (k = 0; k < NUMBER; k = k + 1) begin : g_value
      assign equal[k] = (values_i[k*WIDTH+:WIDTH] == smallest);
      assign not_smaller[k] = (values_i[k*WIDTH+:WIDTH] >= smallest);
    end
  endgenerate

  `PROVE(a_is_a_value, |equal)
  `PROVE(a_none_is_smaller, &not_smaller)

endmodule

`default_nettype wire
