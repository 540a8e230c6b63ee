// SPDX-License-Identifier: Apache-2.0
// Registers between the shared logic and all columns: STAGES registers for each signal.
//
// The array is several millimetres wide and the shared logic is in its middle. The first register belongs beside the logic that
// drives it, and the last register beside the columns. A layout (and the flow of `make synth`) gives each group of neighbouring
// columns its own copy of the last register, and spreads copies of the registers before it over the way. Timestamps come from above their
// columns and are delayed there by the same number of clocks (dtof_timestamp_input.sv), so that timestamps and commands stay aligned.
//
// Latency: STAGES clocks.
// Cost: STAGES flip-flops per bit.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_broadcast #(
    parameter int WIDTH = 1,
    parameter int STAGES = 2  // registers from input to output, at least 1
) (
    input  logic             clk_i,
    input  logic             rst_ni,
    input  logic [WIDTH-1:0] from_i,
    output logic [WIDTH-1:0] to_o
);

  `DTOF_REQUIRE(g_illegal_stages, STAGES >= 1, "dtof_broadcast: STAGES must be at least 1")

  logic [STAGES*WIDTH-1:0] stages_q, stages_d;

  generate
    if (STAGES == 1) begin : g_one_stage
      assign stages_d = from_i;
    end else begin : g_stages
      assign stages_d = {stages_q[(STAGES-1)*WIDTH-1:0], from_i};
    end
  endgenerate

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      stages_q <= '0;
    end else begin
      stages_q <= stages_d;
    end
  end

  assign to_o = stages_q[STAGES*WIDTH-1:(STAGES-1)*WIDTH];

endmodule

`default_nettype wire
