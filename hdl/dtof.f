// SPDX-License-Identifier: Apache-2.0
// All RTL, leaf first, relative to this folder; in it these read the list (dtof_lint.f: waivers for Verilator's -Wall):
//   verilator --lint-only -Wall -f dtof_lint.f -f dtof.f --top-module dtof_array
//   iverilog -g2012 -t null -f dtof.f -s dtof_array
//   yosys -q -p "read_verilog -sv -Ipackage $(grep '[.]sv$' dtof.f | xargs); hierarchy -check -top dtof_array"
+incdir+package
package/dtof_pkg.sv
package/dtof_registers_pkg.sv
technology/behavioural/dtof_clock_gate.sv
technology/behavioural/dtof_sram_1r1w.sv
technology/behavioural/dtof_sram_1rw.sv
memory/dtof_sram.sv
control/dtof_array_errors.sv
control/dtof_gate_register.sv
control/dtof_pass_sequencer.sv
control/dtof_pixel_sequencer.sv
control/dtof_scan_sequencer.sv
control/dtof_broadcast.sv
control/dtof_controller.sv
control/dtof_column_rules.sv
control/dtof_stream_rules.sv
control/dtof_result_output.sv
control/dtof_pair_sequencer.sv
control/dtof_pool_controller.sv
control/dtof_pool_result_output.sv
control/dtof_pool2_sequencer.sv
datapath/dtof_data_filter.sv
datapath/dtof_full_counter_link.sv
datapath/dtof_histogram_builder.sv
datapath/dtof_pair_detector.sv
datapath/dtof_pair_interpolator.sv
datapath/dtof_peak_detector.sv
datapath/dtof_peak_histogram.sv
datapath/dtof_pointer_update.sv
datapath/dtof_word_builder.sv
datapath/dtof_pointer_builder.sv
datapath/dtof_result_register.sv
datapath/dtof_status_bits.sv
datapath/dtof_label_match.sv
datapath/dtof_minimum.sv
datapath/dtof_pixel_distance.sv
datapath/dtof_pool2_track_update.sv
datapath/dtof_timestamp_input.sv
datapath/dtof_twin_pointer_update.sv
datapath/dtof_pool2_pixel_update.sv
engine/dtof_label_chain.sv
engine/dtof_beside_evidence.sv
engine/dtof_smoothing.sv
engine/dtof_pool2_candidate_decoder.sv
engine/dtof_pool2_line.sv
engine/dtof_pool2_engine.sv
// Columns of dtof_array: written by scripts/generate.py
column/dtof_ez_pointer_column.sv
column/dtof_his_pointer_column.sv
column/dtof_interframe_histogram_column.sv
column/dtof_partitioned_histogram_column.sv
column/dtof_coarse_histogram_column.sv
// end of columns
column/dtof_pool2_column.sv
column/dtof_pool2_pair.sv
column/dtof_pool2_quad.sv
top/dtof_array.sv
top/dtof_pool_pointer2_array.sv
subsystem/dtof_line_buffer.sv
subsystem/dtof_line_filter.sv
subsystem/dtof_target_words.sv
subsystem/dtof_stream_output.sv
subsystem/dtof_raster_buffer.sv
subsystem/dtof_frame_control.sv
subsystem/dtof_apb_registers.sv
subsystem/dtof_axi_lite_to_apb.sv
subsystem/dtof_reset_synchroniser.sv
subsystem/dtof_subsystem.sv
