// SPDX-License-Identifier: Apache-2.0
// Macros of the harnesses in this folder (docs/reference/formal.md). A harness declares `checking`, which is high from the first clock
// on in which the design is out of reset.
`ifndef PROPERTIES_SVH
`define PROPERTIES_SVH

// ASSUME: a contract of the design's inputs.
`define ASSUME(LABEL, CONDITION) \
  always_comb if (checking) begin \
    LABEL: assume (CONDITION); \
  end

// PROVE: a property to prove. GOAL: a situation that must be reachable under the assumptions. scripts/formal.py proves the properties
// and searches a trace to the goal in separate runs.
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
