// SPDX-License-Identifier: Apache-2.0
// In the place of a processor: writes the registers of dtof_subsystem once behind the reset, so that it reads frames without
// an end.
//
// Order: ACQUISITIONS, WEAK_BELOW, CONTROL with START and CONTINUOUS.
// Schedule: a write takes APB's two clocks and what the slave waits.
// Cost: three state bits.
module register_writer #(
    parameter int ACQUISITIONS = 1000,
    parameter int WEAK_BELOW = 2
) (
    input  logic        clk_i,
    input  logic        rst_ni,
    output logic        psel_o,
    output logic        penable_o,
    output logic [11:0] paddr_o,
    output logic [31:0] pwdata_o,
    input  logic        pready_i
);

  localparam logic [1:0] LAST = 2'd2;

  logic [1:0] index_q;
  logic enable_q, done_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      index_q <= '0;
      enable_q <= 1'b0;
      done_q <= 1'b0;
    end else if (!done_q) begin
      if (!enable_q) begin
        enable_q <= 1'b1;
      end else if (pready_i) begin
        enable_q <= 1'b0;
        index_q <= index_q + 1'b1;
        done_q <= (index_q == LAST);
      end
    end
  end

  assign psel_o = !done_q;
  assign penable_o = enable_q;

  always_comb begin
    case (index_q)
      2'd0: begin
        paddr_o = dtof_registers_pkg::ACQUISITIONS;
        pwdata_o = 32'(ACQUISITIONS);
      end
      2'd1: begin
        paddr_o = dtof_registers_pkg::WEAK_BELOW;
        pwdata_o = 32'(WEAK_BELOW);
      end
      default: begin
        paddr_o = dtof_registers_pkg::CONTROL;
        pwdata_o = '0;
        pwdata_o[dtof_registers_pkg::CONTROL_START_LSB] = 1'b1;
        pwdata_o[dtof_registers_pkg::CONTROL_CONTINUOUS_LSB] = 1'b1;
      end
    endcase
  end

endmodule
