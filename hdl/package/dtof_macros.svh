// SPDX-License-Identifier: Apache-2.0
// Checks that mean the same to Verilator, Yosys and Icarus Verilog 11.
`ifndef DTOF_MACROS_SVH
`define DTOF_MACROS_SVH

// Illegal parameters stop elaboration with a sentence. Icarus 11 knows no elaboration $error and stops at
// time 0 instead.
`ifdef __ICARUS__
`define DTOF_REQUIRE(LABEL, CONDITION, SENTENCE) \
  initial if (!(CONDITION)) begin \
    $display("%m: %s", SENTENCE); \
    $finish; \
  end
`else
`define DTOF_REQUIRE(LABEL, CONDITION, SENTENCE) \
  generate if (!(CONDITION)) begin : LABEL \
    $error(SENTENCE); \
  end endgenerate
`endif

// A property that holds in every clock outside reset; alive in simulation, not in synthesis.
`ifdef SYNTHESIS
`define DTOF_ASSERT(LABEL, CONDITION, SENTENCE)
`else
`define DTOF_ASSERT(LABEL, CONDITION, SENTENCE) \
  always @(posedge clk_i) begin \
    if (rst_ni === 1'b1) begin : LABEL \
      assert (CONDITION) else $error("%m: %s", SENTENCE); \
    end \
  end
`endif

`endif
