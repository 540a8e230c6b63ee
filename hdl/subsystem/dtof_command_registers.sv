// SPDX-License-Identifier: Apache-2.0
// The commands of CONTROL, and the settings that are valid at once: CONTROL.CONTINUOUS, WATCHDOG, SHOT_SEED, SELF_TEST_SEED and
// SELF_TEST_EXPECTED. illegal_schedule_i ends continuous mode. START and SELF_TEST have no effect while busy_i is high, or with ABORT in
// the same write; CONTINUOUS takes its value in each write.
//
// Latency: a command is a pulse in the clock after its write, and a setting is at its output in that clock.
// Cost: a flip-flop per command and per bit of a setting, and a multiplexer for reads.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_command_registers #(
    parameter int SELF_TEST = 0
) (
    input  logic        clk_i,
    input  logic        rst_ni,
    // write of a register
    input  logic [11:0] offset_i,
    input  logic        write_i,
    input  logic [31:0] mask_i,      // bits that are written
    input  logic [31:0] written_i,   // bits that are written as 1
    output logic [31:0] data_o,      // value of the register at offset_i; 0 at an offset of another one
    input  logic        busy_i,
    output logic        starts_o,    // START or SELF_TEST is written in this clock, and has an effect
    output logic        start_ignored_o,  // in the clock after a write of START or SELF_TEST that has no effect
    input  logic        illegal_schedule_i,
    // commands and settings
    output logic        start_o,
    output logic        self_test_o, // with start_o; this output and the two settings of the self-test are 0 without SELF_TEST
    output logic        flush_o,
    output logic        abort_o,
    output logic        continuous_o,
    output logic [23:0] watchdog_o,
    output logic [15:0] shot_seed_o,
    output logic        shot_reseed_o,  // in the clock after a write of SHOT_SEED
    output logic [31:0] self_test_seed_o,
    output logic [31:0] self_test_expected_o
);

  logic start_q, start_ignored_q, flush_q, abort_q, continuous_q, shot_reseed_q, controls, chosen;
  logic [23:0] watchdog_q;
  logic [15:0] shot_seed_q;

  assign controls = write_i && (offset_i == dtof_registers_pkg::CONTROL);
  assign chosen = controls
      && (written_i[dtof_registers_pkg::CONTROL_START_LSB] || written_i[dtof_registers_pkg::CONTROL_SELF_TEST_LSB]);
  assign starts_o = chosen && !busy_i && !written_i[dtof_registers_pkg::CONTROL_ABORT_LSB];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      start_q <= 1'b0;
      start_ignored_q <= 1'b0;
      flush_q <= 1'b0;
      abort_q <= 1'b0;
      continuous_q <= 1'b0;
      watchdog_q <= 24'(dtof_registers_pkg::WATCHDOG_RESET);
      shot_seed_q <= 16'(dtof_registers_pkg::SHOT_SEED_RESET);
      shot_reseed_q <= 1'b0;
    end else begin
      start_q <= starts_o;
      start_ignored_q <= chosen && !starts_o;
      flush_q <= controls && written_i[dtof_registers_pkg::CONTROL_FLUSH_LSB];
      abort_q <= controls && written_i[dtof_registers_pkg::CONTROL_ABORT_LSB];
      shot_reseed_q <= write_i && (offset_i == dtof_registers_pkg::SHOT_SEED) && (mask_i[15:0] != '0);
      if (illegal_schedule_i) begin
        continuous_q <= 1'b0;
      end
      if (write_i) begin
        case (offset_i)
          dtof_registers_pkg::CONTROL:
          if (mask_i[dtof_registers_pkg::CONTROL_CONTINUOUS_LSB]) begin
            continuous_q <= written_i[dtof_registers_pkg::CONTROL_CONTINUOUS_LSB];
          end
          dtof_registers_pkg::WATCHDOG: watchdog_q <= (watchdog_q & ~mask_i[23:0]) | written_i[23:0];
          dtof_registers_pkg::SHOT_SEED: shot_seed_q <= (shot_seed_q & ~mask_i[15:0]) | written_i[15:0];
          default: begin
          end
        endcase
      end
    end
  end

  assign start_o = start_q;
  assign start_ignored_o = start_ignored_q;
  assign flush_o = flush_q;
  assign abort_o = abort_q;
  assign continuous_o = continuous_q;
  assign watchdog_o = watchdog_q;
  assign shot_seed_o = shot_seed_q;
  assign shot_reseed_o = shot_reseed_q;

  generate
    if (SELF_TEST != 0) begin : g_self_test
      logic self_test_q;
      logic [31:0] seed_q, expected_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          self_test_q <= 1'b0;
          seed_q <= 32'd1;
          expected_q <= '0;
        end else begin
          self_test_q <= starts_o && written_i[dtof_registers_pkg::CONTROL_SELF_TEST_LSB];
          if (write_i && offset_i == dtof_registers_pkg::SELF_TEST_SEED) begin
            seed_q <= (seed_q & ~mask_i) | written_i;
          end
          if (write_i && offset_i == dtof_registers_pkg::SELF_TEST_EXPECTED) begin
            expected_q <= (expected_q & ~mask_i) | written_i;
          end
        end
      end
      assign self_test_o = self_test_q;
      assign self_test_seed_o = seed_q;
      assign self_test_expected_o = expected_q;
    end else begin : g_no_self_test
      logic unused;
      assign unused = ^{mask_i, written_i};
      assign self_test_o = 1'b0;
      assign self_test_seed_o = '0;
      assign self_test_expected_o = '0;
    end
  endgenerate

  always_comb begin
    data_o = '0;
    case (offset_i)
      dtof_registers_pkg::CONTROL: data_o[dtof_registers_pkg::CONTROL_CONTINUOUS_LSB] = continuous_q;
      dtof_registers_pkg::WATCHDOG: data_o = 32'(watchdog_q);
      dtof_registers_pkg::SHOT_SEED: data_o = 32'(shot_seed_q);
      dtof_registers_pkg::SELF_TEST_SEED: data_o = self_test_seed_o;
      dtof_registers_pkg::SELF_TEST_EXPECTED: data_o = self_test_expected_o;
      default: begin
      end
    endcase
  end

endmodule

`default_nettype wire
