// SPDX-License-Identifier: Apache-2.0
// Yosys maps flip-flops behind formal/dtof_clock_gate.sv to these: a step of the proof is a clock, and CLK is the enable of its edge.

module \$dff (CLK, D, Q);
  parameter WIDTH = 1;
  parameter CLK_POLARITY = 1'b1;
  input CLK;
  input [WIDTH-1:0] D;
  output [WIDTH-1:0] Q;

  \$ff #(.WIDTH(WIDTH)) _TECHMAP_REPLACE_ (.D(CLK ? D : Q), .Q(Q));
endmodule

module \$adff (CLK, ARST, D, Q);
  parameter WIDTH = 1;
  parameter CLK_POLARITY = 1'b1;
  parameter ARST_POLARITY = 1'b1;
  parameter ARST_VALUE = 0;
  input CLK, ARST;
  input [WIDTH-1:0] D;
  output [WIDTH-1:0] Q;

  wire [WIDTH-1:0] kept;
  wire reset = ARST_POLARITY ? ARST : !ARST;
  assign Q = reset ? ARST_VALUE : kept;
  \$ff #(.WIDTH(WIDTH)) _TECHMAP_REPLACE_ (.D(reset ? ARST_VALUE : (CLK ? D : Q)), .Q(kept));
endmodule
