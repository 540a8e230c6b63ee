// SPDX-License-Identifier: Apache-2.0
// A value that may differ in every clock. The proof makes each bit a free input.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module arbitrary_value #(
    parameter int WIDTH = 1
) (
    output logic [WIDTH-1:0] value_o
);

  genvar i;
  generate
    for (i = 0; i < WIDTH; i = i + 1) begin : g_bit
      arbitrary_bit u_bit (.value_o(value_o[i]));
    end
  endgenerate

endmodule

(* blackbox *)
module arbitrary_bit (
    output logic value_o
);
endmodule

`default_nettype wire
