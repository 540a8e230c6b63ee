// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_coarse_template: entry and hidden bit belong to the bin of the clock before; no bin from bin 7 on is hidden.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module coarse_template_properties (
    input logic         clk_i,
    input logic [255:0] template_i,
    input logic [  4:0] bin_i
);

  (* anyconst *) logic [4:0] bin;
  logic [7:0] entry, wanted_q;
  logic hidden;
  logic of_bin_q;
  logic checking = 1'b0;  // one clock has passed

  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
    of_bin_q <= (bin_i == bin);
    wanted_q <= 8'(template_i >> {bin, 3'd0});
  end

  dtof_coarse_template u_dut (
      .clk_i(clk_i), .template_i(template_i), .bin_i(bin_i), .entry_o(entry), .hidden_o(hidden)
  );

  `PROVE(a_entry, !of_bin_q || entry == wanted_q)
  `PROVE(a_hidden, !of_bin_q || hidden == (bin < 5'd7 && wanted_q >= 8'd128))

endmodule

`default_nettype wire
