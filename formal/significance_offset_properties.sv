// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_significance_offset: the offset is 0 up to 3,839 acquisitions, 17 for the longest frame, and never smaller for a
// longer frame.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module significance_offset_properties #(
    parameter int ACQ_WIDTH = 16
) (
    input logic clk_i
);

  (* anyconst *) logic [ACQ_WIDTH-1:0] acquisitions;
  (* anyconst *) logic [ACQ_WIDTH-1:0] fewer;
  logic [4:0] offset, smaller;
  logic [1:0] t_q = 2'd0;
  logic checking;  // two clocks have passed

  assign checking = t_q[1];

  always_ff @(posedge clk_i) begin
    t_q <= checking ? t_q : t_q + 2'd1;
  end

  dtof_significance_offset #(.ACQ_WIDTH(ACQ_WIDTH)) u_dut (
      .clk_i(clk_i), .acq_num_i(acquisitions), .offset_o(offset)
  );
  dtof_significance_offset #(.ACQ_WIDTH(ACQ_WIDTH)) u_fewer (
      .clk_i(clk_i), .acq_num_i(fewer), .offset_o(smaller)
  );

  // From the definition: lg(3584) = 94 gives 0, lg(4096) = 96 gives 1, each doubling adds 4.
  `PROVE(a_short, 32'(acquisitions) >= 3840 || offset == 5'd0)
  `PROVE(a_first, 32'(acquisitions) < 3840 || 32'(acquisitions) >= 4608 || offset == 5'd1)
  `PROVE(a_ten_thousand, 32'(acquisitions) != 10000 || offset == 5'd6)
  `PROVE(a_longest, ACQ_WIDTH != 16 || acquisitions != '1 || offset == 5'd17)
  `PROVE(a_monotonic, fewer > acquisitions || smaller <= offset)

endmodule

`default_nettype wire
