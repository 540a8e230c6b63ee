// SPDX-License-Identifier: Apache-2.0
// All RTL, leaf first, relative to this folder; in it these read the list (dtof_lint.f: waivers for Verilator's -Wall):
//   verilator --lint-only -Wall -f dtof_lint.f -f dtof.f --top-module dtof_array
//   iverilog -g2012 -t null -f dtof.f -s dtof_array
//   yosys -q -p "read_verilog -sv -Ipackage $(grep '[.]sv$' dtof.f | xargs); hierarchy -check -top dtof_array"
+incdir+package
package/dtof_pkg.sv
package/dtof_registers_pkg.sv
technology/behavioural/clock_gate.sv
technology/behavioural/sram_1r1w.sv
technology/behavioural/sram_1rw.sv
memory/dtof_sram.sv
control/array_errors.sv
control/gate_register.sv
control/pass_sequencer.sv
control/pixel_sequencer.sv
control/scan_sequencer.sv
control/broadcast.sv
control/controller.sv
control/column_rules.sv
control/stream_rules.sv
control/result_output.sv
control/pair_sequencer.sv
control/pool_controller.sv
control/pool_result_output.sv
control/pool2_sequencer.sv
datapath/data_filter.sv
datapath/full_counter_link.sv
datapath/histogram_builder.sv
datapath/pair_detector.sv
datapath/pair_interpolator.sv
datapath/peak_detector.sv
datapath/peak_histogram.sv
datapath/pointer_update.sv
datapath/word_builder.sv
datapath/pointer_builder.sv
datapath/result_register.sv
datapath/status_bits.sv
datapath/label_match.sv
datapath/minimum.sv
datapath/pixel_distance.sv
datapath/pool2_track_update.sv
datapath/timestamp_input.sv
datapath/twin_pointer_update.sv
datapath/pool2_pixel_update.sv
engine/label_chain.sv
engine/beside_evidence.sv
engine/smoothing.sv
engine/pool2_candidate_decoder.sv
engine/pool2_line.sv
engine/pool2_engine.sv
// Columns of dtof_array: written by scripts/generate.py
column/ez_pointer_column.sv
column/his_pointer_column.sv
column/interframe_histogram_column.sv
column/partitioned_histogram_column.sv
column/coarse_histogram_column.sv
// end of columns
column/pool2_column.sv
column/pool2_pair.sv
column/pool2_quad.sv
top/dtof_array.sv
top/pool_pointer2_array.sv
subsystem/line_buffer.sv
subsystem/line_filter.sv
subsystem/target_words.sv
subsystem/stream_output.sv
subsystem/raster_buffer.sv
subsystem/frame_control.sv
subsystem/apb_registers.sv
subsystem/axi_lite_to_apb.sv
subsystem/reset_synchroniser.sv
subsystem/dtof_subsystem.sv
