// SPDX-License-Identifier: Apache-2.0
// Bits of a register that a write of 1 may set: fields of this configuration, or all bits of a register in which a 1 elsewhere has no
// effect. Combinational.
//
// Latency: none.
// Cost: a decoder of the offset; all else is constant, except that the template is not writable while busy_i is high.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_writable_bits #(
    parameter int HAS_SCHEDULE = 0,
    parameter int TIME_GATE = 0,
    parameter int SELF_TEST = 0,
    parameter int SECOND_TARGET = 0,
    parameter int AMPLITUDE = 0,
    parameter int PRIOR = 0,
    parameter int RAW_HISTOGRAM = 0,
    parameter int NP = 10,
    parameter int SRAM_NUM = 200,
    parameter int ACQ_WIDTH = 16,
    parameter int WEAK_WIDTH = 5,
    parameter int CAUSES = 2
) (
    input  logic [11:0] offset_i,
    input  logic        busy_i,
    output logic [31:0] there_o
);

  localparam int ENABLE_WORDS = (SRAM_NUM + 31) / 32;
  localparam logic [31:0] ACQ_BITS = 32'hffffffff >> (32 - ACQ_WIDTH);
  localparam logic [31:0] NP_BITS = 32'hffffffff >> (32 - NP);
  localparam logic [31:0] ROWS_BITS = (32'hfff << dtof_registers_pkg::RAW_ROWS_FIRST_LSB)
      | (32'hfff << dtof_registers_pkg::RAW_ROWS_LAST_LSB);
  localparam logic [31:0] SHOT_FIELDS = (32'h7 << dtof_registers_pkg::SHOT_BITS_LSB) | (32'hff << dtof_registers_pkg::SHOT_UNIT_LSB);
  localparam logic [31:0] CONTROL_BITS = (32'd1 << dtof_registers_pkg::CONTROL_START_LSB)
      | (32'd1 << dtof_registers_pkg::CONTROL_CONTINUOUS_LSB) | (32'd1 << dtof_registers_pkg::CONTROL_FLUSH_LSB)
      | (32'd1 << dtof_registers_pkg::CONTROL_ABORT_LSB)
      | (((SELF_TEST != 0) ? 32'd1 : 32'd0) << dtof_registers_pkg::CONTROL_SELF_TEST_LSB);
  localparam logic [31:0] OUTPUT_BITS =
      (((SECOND_TARGET != 0) ? 32'd1 : 32'd0) << dtof_registers_pkg::OUTPUT_SECOND_TARGET_LSB)
      | (((RAW_HISTOGRAM != 0) ? 32'd1 : 32'd0) << dtof_registers_pkg::OUTPUT_RAW_LSB)
      | (((HAS_SCHEDULE != 0) ? 32'd1 : 32'd0) << dtof_registers_pkg::OUTPUT_SMOOTH_LSB)
      | (((AMPLITUDE != 0) ? 32'd1 : 32'd0) << dtof_registers_pkg::OUTPUT_AMPLITUDE_LSB)
      | (((PRIOR != 0) ? 32'd1 : 32'd0) << dtof_registers_pkg::OUTPUT_PRIOR_LSB)
      | (32'd1 << dtof_registers_pkg::OUTPUT_SHORT_WORDS_LSB);
  localparam logic [31:0] LAST_COLUMNS = 32'hffffffff >> (32 * ENABLE_WORDS - SRAM_NUM);

  logic is_template;
  logic [9:0] enable_index;

  assign is_template = (offset_i >= dtof_registers_pkg::TEMPLATE)
      && (offset_i < dtof_registers_pkg::TEMPLATE + 12'(4 * dtof_registers_pkg::TEMPLATE_NUMBER));
  assign enable_index = offset_i[11:2] - 10'(dtof_registers_pkg::COLUMN_ENABLE >> 2);

  always_comb begin
    there_o = 32'hffffffff;
    case (offset_i)
      dtof_registers_pkg::CONTROL: there_o = CONTROL_BITS;
      dtof_registers_pkg::IRQ_ENABLE: there_o = 32'hffffffff >> (32 - CAUSES);
      dtof_registers_pkg::ACQUISITIONS: there_o = ACQ_BITS;
      dtof_registers_pkg::COARSE_END, dtof_registers_pkg::TRACK_END: there_o = (HAS_SCHEDULE != 0) ? ACQ_BITS : '0;
      dtof_registers_pkg::WATCHDOG: there_o = 32'h00ffffff;
      dtof_registers_pkg::GATE:
      there_o = (TIME_GATE == 0) ? '0
          : (NP_BITS << dtof_registers_pkg::GATE_BEGIN_LSB) | (NP_BITS << dtof_registers_pkg::GATE_END_LSB);
      dtof_registers_pkg::RELEASE: there_o = 32'h0000ffff;
      dtof_registers_pkg::WEAK_BELOW: there_o = 32'hffffffff >> (32 - WEAK_WIDTH);
      dtof_registers_pkg::OUTPUT: there_o = OUTPUT_BITS;
      dtof_registers_pkg::RAW_ROWS: there_o = (RAW_HISTOGRAM != 0) ? ROWS_BITS : '0;
      dtof_registers_pkg::SHOT: there_o = SHOT_FIELDS;
      dtof_registers_pkg::SHOT_SEED: there_o = 32'h0000ffff;
      dtof_registers_pkg::SETTLE: there_o = 32'h0000ffff;
      dtof_registers_pkg::SELF_TEST_SEED, dtof_registers_pkg::SELF_TEST_EXPECTED: there_o = (SELF_TEST != 0) ? 32'hffffffff : '0;
      dtof_registers_pkg::COMMIT: there_o = 32'd1 << dtof_registers_pkg::COMMIT_SETTINGS_LSB;
      default:
      if (is_template) begin
        there_o = (HAS_SCHEDULE != 0 && !busy_i) ? 32'hffffffff : '0;
      end else if (offset_i >= dtof_registers_pkg::COLUMN_ENABLE) begin
        there_o = (32'(enable_index) == ENABLE_WORDS - 1) ? LAST_COLUMNS
            : (32'(enable_index) >= ENABLE_WORDS) ? '0 : 32'hffffffff;
      end
    endcase
  end

endmodule

`default_nettype wire
