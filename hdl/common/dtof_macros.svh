// SPDX-License-Identifier: Apache-2.0
// Checks and types that have the same meaning for Verilator, Yosys and Icarus Verilog 11.
`ifndef DTOF_MACROS_SVH
`define DTOF_MACROS_SVH

// DTOF_REQUIRE: an illegal parameter stops elaboration with a message. Yosys 0.23 takes the message as the first argument.
// Icarus 11 has no elaboration task, and Verilator continues with -Wno-fatal: in both, the simulation stops at time 0.
`ifdef YOSYS
`define DTOF_REQUIRE(LABEL, CONDITION, SENTENCE) \
  generate if (!(CONDITION)) begin : LABEL \
    $fatal(SENTENCE); \
  end endgenerate
`elsif __ICARUS__
`define DTOF_REQUIRE(LABEL, CONDITION, SENTENCE) \
  initial if (!(CONDITION)) begin \
    $fatal(1, "%m: %s", SENTENCE); \
  end
`else
`define DTOF_REQUIRE(LABEL, CONDITION, SENTENCE) \
  generate if (!(CONDITION)) begin : LABEL \
    $fatal(1, SENTENCE); \
    initial $fatal(1, "%m: %s", SENTENCE); \
  end endgenerate
`endif

// Types of a package: write `DTOF_TYPES_OF(PACKAGE) after the name of a module that uses such types, and `DTOF_TYPE(PACKAGE, NAME) in place
// of a type. Icarus Verilog 11 accepts a package's type only after an import, Yosys 0.23 only by its full name.
`ifdef __ICARUS__
`define DTOF_TYPES_OF(PACKAGE) import PACKAGE::*;
`define DTOF_TYPE(PACKAGE, NAME) NAME
`else
`define DTOF_TYPES_OF(PACKAGE)
`define DTOF_TYPE(PACKAGE, NAME) PACKAGE::NAME
`endif

// DTOF_ASSERT: a property that holds in every clock outside reset: checked in simulation, proved by make formal, removed by
// synthesis. A violation ends an Icarus simulation; under Verilator --assert it calls the stop hook.
// DTOF_ASSERT_AS_IF makes tb_cpp faster: the C++ of Verilator 5.006 is laid out for an assert that fails, and for an if with a
// $error that is rare.
`ifdef FORMAL
`define DTOF_ASSERT(LABEL, CONDITION, SENTENCE) \
  always @(posedge clk_i) begin \
    if (rst_ni) begin \
      LABEL: assert (CONDITION); \
    end \
  end
`elsif SYNTHESIS
`define DTOF_ASSERT(LABEL, CONDITION, SENTENCE)
`elsif __ICARUS__
`define DTOF_ASSERT(LABEL, CONDITION, SENTENCE) \
  always @(posedge clk_i) begin : LABEL \
    if (rst_ni === 1'b1 && (CONDITION) !== 1'b1) begin \
      $fatal(1, "%m: %s", SENTENCE); \
    end \
  end
`elsif DTOF_ASSERT_AS_IF
`define DTOF_ASSERT(LABEL, CONDITION, SENTENCE) \
  always @(posedge clk_i) begin \
    if (rst_ni === 1'b1) begin : LABEL \
      if (!(CONDITION)) $error("%m: %s", SENTENCE); \
    end \
  end
`else
`define DTOF_ASSERT(LABEL, CONDITION, SENTENCE) \
  always @(posedge clk_i) begin \
    if (rst_ni === 1'b1) begin : LABEL \
      assert (CONDITION) else $error("%m: %s", SENTENCE); \
    end \
  end
`endif

`endif
