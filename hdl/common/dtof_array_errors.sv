// SPDX-License-Identifier: Apache-2.0
// Reports the errors of a master that violates the array's contract, once per array. Each bit is high for one clock per error. To keep
// a bit, store it in a register outside the array.
//
// Bits:
//   ERROR_UNDERRUN          tdc_valid_i was low in a clock inside an acquisition: the pixel counts as not detected
//   ERROR_START_IGNORED     start_i came while busy_o was high: it has no effect
//   ERROR_ILLEGAL_SCHEDULE  a frame began with a schedule whose ends are not in order, or a raw frame with rows that are not in
//                           order: the results of this frame have no meaning
//
// Latency: one clock from the error to its bit. Cost: three flip-flops.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_array_errors (
    input  logic                              clk_i,
    input  logic                              rst_ni,
    input  logic                              start_i,
    input  logic                              busy_i,
    input  logic                              underrun_i,
    input  logic                              illegal_schedule_i,
    output logic [dtof_pkg::ERROR_WIDTH-1:0] error_o
);

  logic [dtof_pkg::ERROR_WIDTH-1:0] error_d, error_q;

  always_comb begin
    error_d = '0;
    error_d[dtof_pkg::ERROR_UNDERRUN] = underrun_i;
    error_d[dtof_pkg::ERROR_START_IGNORED] = start_i && busy_i;
    error_d[dtof_pkg::ERROR_ILLEGAL_SCHEDULE] = illegal_schedule_i;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      error_q <= '0;
    end else begin
      error_q <= error_d;
    end
  end

  assign error_o = error_q;

endmodule

`default_nettype wire
