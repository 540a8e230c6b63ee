// SPDX-License-Identifier: Apache-2.0
// A part of dtof_pool_control, which gives the commands, and of dtof_pool_pointer_array, which sends them through its broadcast: all commands of a
// clock to pairs and engines. The module around this file defines the widths. Their sum is dtof_pkg::pool_sent_width.
  typedef struct packed {
    logic template_hidden;
    logic [dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] template_entry;
    logic [dtof_pkg::POOL_SIGNIFICANCE_OFFSET_WIDTH-1:0] significance_offset;
    logic [NP-1:0] gate_begin;
    logic [NP-1:0] gate_end;
    logic smooth;
    logic coarse;
    logic point;
    logic beat_t1;
    logic first_slot_t1;
    logic last_slot_t1;
    logic odd_t1;
    logic second_row_t0;
    logic first_row_t2;
    logic second_row_t2;
    logic [3:0] acquisition_t2;
    logic [dtof_pkg::POOL_THINNING_WIDTH-1:0] thinning_t2;
    logic keep_first;
    logic keep_last;
    logic load;
    logic [PART_WIDTH-1:0] part;
    logic sweep;
    logic make_room;
    logic read;
    logic optional;
    logic late;
    logic write;
    logic [ADDR_WIDTH-1:0] address;
    logic word_load;
    logic group_load;
    logic group_upper;
    logic engine;
    logic replace;
    logic clear;
    logic [STEP_PAIRS-1:0] select;
    logic [LAST_PAIRS-1:0] last_select;
    logic upper;
    logic used;
    logic has_right;
    logic last_has_right;
    logic [ROW_WIDTH-1:0] scratch_row;
    logic [dtof_pkg::POOL_COMMAND_WIDTH-1:0] command;  // a pool_engine_command_t; Yosys 0.23 cannot nest that type here
  } sent_t;
