// SPDX-License-Identifier: Apache-2.0
// A part of dtof_array_control, which gives the commands, and of dtof_array, which sends them through its broadcast: all commands of a clock to
// the columns, with the names of the columns' ports. The module around this file defines the widths. Their sum is dtof_pkg::command_width.
  typedef struct packed {
    logic [NP-1:0] gate_begin;
    logic [NP-1:0] gate_end;
    logic [PASS_WIDTH-1:0] pass;
    logic first_pass;
    logic final_pass;
    logic first_slot_t0;
    logic beat_t1;
    logic visit_t1;
    logic first_acq_t1;
    logic [STEP_WIDTH-1:0] step_t0;
    logic [3:1] same_pixel_t3;
    logic beat_t5;
    logic [ROW_WIDTH-1:0] histogram_read_pixel;
    logic [ROW_WIDTH-1:0] histogram_write_pixel;
    logic scan_s0;
    logic [BIN_WIDTH-1:0] scan_bin_s0;
    logic clear_s1;
    logic [BIN_WIDTH-1:0] clear_bin_s1;
    logic clear_all;
    logic scan_s2;
    logic first_s2;
    logic [SCAN_WIDTH-1:0] bin_s2;
    logic word_read;
    logic [ROW_WIDTH-1:0] word_read_pixel;
    logic word_read_done;
    logic word_set;
    logic [ROW_WIDTH-1:0] word_set_pixel;
    logic word_write;
    logic [ROW_WIDTH-1:0] word_write_pixel;
    logic result_load;
    logic result_shift;
  } command_t;
