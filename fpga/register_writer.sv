// SPDX-License-Identifier: Apache-2.0
// Replaces a processor: writes the registers of dtof_subsystem once after reset, so that it reads frames continuously.
//
// Order: ACQUISITIONS, WEAK_BELOW, with a pool read-out its schedule (COARSE_END, TRACK_END, from the shares),
// CONTROL with START and CONTINUOUS.
// Schedule: a write takes the two clocks of APB, and the wait states of the slave. Latency: the first write begins after reset.
// Cost: five state bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module register_writer #(
    parameter int HAS_SCHEDULE = 0,
    parameter int ACQUISITIONS = 1000,
    parameter int COARSE_SHARE = 14,  // 64ths of a frame that the coarse phase takes
    parameter int TRACK_SHARE = 20,   // and the track phase
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

  localparam int COARSE_END = (ACQUISITIONS * COARSE_SHARE) >> 6;
  localparam int TRACK_END = (ACQUISITIONS * (COARSE_SHARE + TRACK_SHARE)) >> 6;
  localparam logic [2:0] CONTROL = 3'd4;

  logic [2:0] index_q;
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
        index_q <= (HAS_SCHEDULE == 0 && index_q == 3'd1) ? CONTROL : index_q + 1'b1;
        done_q <= (index_q == CONTROL);
      end
    end
  end

  assign psel_o = !done_q;
  assign penable_o = enable_q;

  always_comb begin
    case (index_q)
      3'd0: begin
        paddr_o = dtof_registers_pkg::ACQUISITIONS;
        pwdata_o = 32'(ACQUISITIONS);
      end
      3'd1: begin
        paddr_o = dtof_registers_pkg::WEAK_BELOW;
        pwdata_o = 32'(WEAK_BELOW);
      end
      3'd2: begin
        paddr_o = dtof_registers_pkg::COARSE_END;
        pwdata_o = 32'(COARSE_END);
      end
      3'd3: begin
        paddr_o = dtof_registers_pkg::TRACK_END;
        pwdata_o = 32'(TRACK_END);
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

`default_nettype wire
