// SPDX-License-Identifier: Apache-2.0
// The registers ERROR, WARNING, IRQ_STATUS and IRQ_ENABLE: sticky bits that events set and a written 1 clears, and the interrupt.
// If software clears a bit in the clock of a new event, the bit stays set.
//
// Latency: a bit is set in the clock after its event; irq_o shows an error one clock after ERROR, and a frame in the clock after frame_i.
// Cost: two flip-flops per error, one per warning, two per cause of an interrupt.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_event_registers #(
    parameter int ERRORS = 10,  // bits of ERROR
    parameter int CAUSES = 2    // of an interrupt
) (
    input  logic              clk_i,
    input  logic              rst_ni,
    // write of a register
    input  logic [      11:0] offset_i,
    input  logic              write_i,
    input  logic [CAUSES-1:0] mask_i,
    input  logic [ERRORS-1:0] written_i,
    output logic [      31:0] data_o,              // value of the register at offset_i; 0 at an offset of another one
    // events
    input  logic              frame_i,
    input  logic              underrun_i,
    input  logic              start_ignored_i,
    input  logic              illegal_schedule_i,
    input  logic              overrun_i,
    input  logic              short_i,
    input  logic              long_i,
    input  logic              timeout_i,
    input  logic              stalled_i,
    input  logic              flush_ignored_i,
    input  logic              parity_error_i,
    input  logic              self_test_failed_i,
    input  logic              aborted_i,
    input  logic              counter_full_i,
    output logic              irq_o
);

  localparam int WARNINGS = 4;

  logic [ERRORS-1:0] error_q, error_event, error_event_q, error_cleared;
  logic [WARNINGS-1:0] warning_q, warning_event, warning_cleared;
  logic [CAUSES-1:0] cause_q, cause_event, cause_cleared, cause_enable_q;

  always_comb begin
    error_event = '0;
    error_event[dtof_registers_pkg::ERROR_UNDERRUN_LSB] = underrun_i;
    error_event[dtof_registers_pkg::ERROR_START_IGNORED_LSB] = start_ignored_i;
    error_event[dtof_registers_pkg::ERROR_ILLEGAL_SCHEDULE_LSB] = illegal_schedule_i;
    error_event[dtof_registers_pkg::ERROR_OVERRUN_LSB] = overrun_i;
    error_event[dtof_registers_pkg::ERROR_MISFRAMED_LSB] = short_i || long_i;
    error_event[dtof_registers_pkg::ERROR_TIMEOUT_LSB] = timeout_i;
    error_event[dtof_registers_pkg::ERROR_STALLED_LSB] = stalled_i;
    error_event[dtof_registers_pkg::ERROR_FLUSH_IGNORED_LSB] = flush_ignored_i;
    error_event[dtof_registers_pkg::ERROR_PARITY_LSB] = parity_error_i;
    error_event[dtof_registers_pkg::ERROR_SELF_TEST_LSB] = self_test_failed_i;
    warning_event = '0;
    warning_event[dtof_registers_pkg::WARNING_COUNTER_FULL_LSB] = counter_full_i;
    warning_event[dtof_registers_pkg::WARNING_ABORTED_LSB] = aborted_i;
    warning_event[dtof_registers_pkg::WARNING_SHORT_LSB] = short_i;
    warning_event[dtof_registers_pkg::WARNING_LONG_LSB] = long_i;
    cause_event = '0;
    cause_event[dtof_registers_pkg::IRQ_STATUS_FRAME_LSB] = frame_i;
    cause_event[dtof_registers_pkg::IRQ_STATUS_ERROR_LSB] = |error_event_q;
  end

  assign error_cleared = (write_i && offset_i == dtof_registers_pkg::ERROR) ? written_i : '0;
  assign warning_cleared = (write_i && offset_i == dtof_registers_pkg::WARNING) ? written_i[WARNINGS-1:0] : '0;
  assign cause_cleared = (write_i && offset_i == dtof_registers_pkg::IRQ_STATUS) ? written_i[CAUSES-1:0] : '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      error_q <= '0;
      error_event_q <= '0;
      warning_q <= '0;
      cause_q <= '0;
      cause_enable_q <= '0;
    end else begin
      error_q <= (error_q & ~error_cleared) | error_event;
      error_event_q <= error_event;
      warning_q <= (warning_q & ~warning_cleared) | warning_event;
      cause_q <= (cause_q & ~cause_cleared) | cause_event;
      if (write_i && offset_i == dtof_registers_pkg::IRQ_ENABLE) begin
        cause_enable_q <= (cause_enable_q & ~mask_i) | written_i[CAUSES-1:0];
      end
    end
  end

  assign irq_o = |(cause_q & cause_enable_q);

  always_comb begin
    data_o = '0;
    case (offset_i)
      dtof_registers_pkg::ERROR: data_o = 32'(error_q);
      dtof_registers_pkg::WARNING: data_o = 32'(warning_q);
      dtof_registers_pkg::IRQ_STATUS: data_o = 32'(cause_q);
      dtof_registers_pkg::IRQ_ENABLE: data_o = 32'(cause_enable_q);
      default: begin
      end
    endcase
  end

endmodule

`default_nettype wire
