// SPDX-License-Identifier: Apache-2.0
// Smallest of NUMBER unsigned values, by a tree of comparators. Combinational.
// Latency: none. Cost: NUMBER - 1 comparators and multiplexers, log2(NUMBER) levels deep.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_minimum #(
    parameter int NUMBER = 8,
    parameter int WIDTH = 5
) (
    input  logic [NUMBER*WIDTH-1:0] values_i,
    output logic [       WIDTH-1:0] smallest_o
);

  // The children of node n are nodes 2 n + 1 and 2 n + 2; the last NUMBER nodes are the values.
  logic [(2*NUMBER-1)*WIDTH-1:0] tree;
  integer n;

  always_comb begin
    tree = {values_i, {((NUMBER - 1) * WIDTH) {1'b0}}};
    for (n = NUMBER - 2; n >= 0; n = n - 1) begin
      tree[n*WIDTH+:WIDTH] = (tree[(2*n+1)*WIDTH+:WIDTH] < tree[(2*n+2)*WIDTH+:WIDTH])
          ? tree[(2*n+1)*WIDTH+:WIDTH] : tree[(2*n+2)*WIDTH+:WIDTH];
    end
  end

  assign smallest_o = tree[WIDTH-1:0];

endmodule

`default_nettype wire
