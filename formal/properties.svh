// SPDX-License-Identifier: Apache-2.0
// What the harnesses in this folder are written with (docs/reference/formal.md). A harness declares `checking`,
// which is high from the first clock on in which the design is out of reset.
`ifndef PROPERTIES_SVH
`define PROPERTIES_SVH

// A contract of the design's inputs.
`define ASSUME(LABEL, CONDITION) \
  always_comb if (checking) begin \
    LABEL: assume (CONDITION); \
  end

// What is proved, and a situation that must be reachable under the assumptions: scripts/formal.py proves the one and
// looks for a trace to the other in runs of their own.
`ifdef FIND_GOAL
`define PROVE(LABEL, CONDITION)
`define GOAL(CONDITION) \
  always_comb if (checking) begin \
    goal: assert (!(CONDITION)); \
  end
`else
`define PROVE(LABEL, CONDITION) \
  always_comb if (checking) begin \
    LABEL: assert (CONDITION); \
  end
`define GOAL(CONDITION)
`endif

`endif
