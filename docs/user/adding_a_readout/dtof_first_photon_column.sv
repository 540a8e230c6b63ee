// SPDX-License-Identifier: Apache-2.0
// First photon: the code of the first detection of the frame.
//
// 1. RESET sets every pixel's word {code, found} to zero.
// 2. The first detection of a pixel is stored in the word, with found = 1. Later detections change nothing.
// 3. In M4 the word is read as the result. The bit found is the confidence.
//
//   clock     what happens
//   T0        the timestamp is registered and compared with the gate
//   T1        the next word is computed: the timestamp or the old word
//   T2        the word is written, after the pixel's last slot
//   S3 of M4  the result is loaded
//
// Cost at the defaults: PIXELS_PER_SRAM x 11 bits, and little more than the registers of dtof_word_builder.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_first_photon_column #(
    // parameters of a column: written by scripts/generate.py from scripts/templates/column_parameters.svh
    // end of parameters of a column
) (
    // ports of a column: written by scripts/generate.py from scripts/templates/column_ports.svh
    // end of ports of a column
);

  localparam int WORD_WIDTH = NP + 1;

  logic [NP-1:0] timestamp_t1;
  logic [WORD_WIDTH-1:0] word_t1, next_t1, word;
  logic found, hit, detected_t0, detected_t1, damaged;

  dtof_timestamp_input #(
      .NP       (NP),
      .TIME_GATE(TIME_GATE),
      .STAGES   (BROADCAST_STAGES)
  ) u_timestamp_input (
      .clk_i         (clk_i),
      .timestamp_i   (timestamp_i),
      .gate_begin_i  (gate_begin_i),
      .gate_end_i    (gate_end_i),
      .detected_t0_o (detected_t0),
      .detected_t1_o (detected_t1),
      .timestamp_t1_o(timestamp_t1)
  );

  assign found = word_t1[0];
  assign hit = beat_t1_i && detected_t1 && !found;
  assign next_t1 = hit ? {timestamp_t1, 1'b1} : word_t1;

  dtof_word_builder #(
      .WIDTH          (WORD_WIDTH),
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .SLOTS          (SLOTS),
      .PORTS          (POINTER_PORTS),
      .PARITY         (PARITY)
  ) u_word_builder (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .sram_cfg_i     (sram_cfg_i),
      .sram_cfg_o     (sram_cfg_o),
      .read_i         (word_read_i),
      .read_pixel_i   (word_read_pixel_i),
      .read_done_i    (word_read_done_i),
      .first_slot_t0_i(first_slot_t0_i),
      .visit_t1_i     (visit_t1_i),
      .first_acq_t1_i (first_acq_t1_i),
      .write_i        (word_write_i),
      .write_pixel_i  (word_write_pixel_i),
      .may_change_t0_i(detected_t0),
      .changes_t1_i   (hit),
      .word_t1_o      (word_t1),
      .next_t1_i      (next_t1),
      .start_write_i  (word_set_i),
      .start_pixel_i  (word_set_pixel_i),
      .start_word_i   (WORD_WIDTH'(0)),
      .word_o         (word),
      .parity_error_o (damaged)
  );

  // This column has no counters.
  logic unused_next_counter_full;
  assign unused_next_counter_full = next_counter_full_i;
  assign counter_full_o = 1'b0;

  dtof_event_link #(
      .PRESENT(PARITY)
  ) u_parity_link (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .event_i      (damaged),
      .next_column_i(next_parity_error_i),
      .event_o      (parity_error_o)
  );

  dtof_result_register #(
      .WIDTH(RESULT_WIDTH)
  ) u_result_register (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .load_i       (result_load_i),
      .shift_i      (result_shift_i),
      .result_i     (word),
      .next_column_i(next_column_i),
      .result_o     (result_o)
  );

endmodule

`default_nettype wire
