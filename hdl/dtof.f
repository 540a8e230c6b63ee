// SPDX-License-Identifier: Apache-2.0
// All RTL, leaf first, relative to this folder; in it these read the list (dtof_lint.f: waivers for Verilator's -Wall):
//   verilator --lint-only -Wall -f dtof_lint.f -f dtof.f --top-module dtof_array
//   iverilog -g2012 -t null -f dtof.f -s dtof_array
//   yosys -q -p "read_verilog -sv -Icommon $(grep '[.]sv$' dtof.f | xargs); hierarchy -check -top dtof_array"
+incdir+common
common/dtof_pkg.sv
subsystem/dtof_registers_pkg.sv
technology/behavioural/dtof_clock_gate.sv
technology/behavioural/dtof_sram_1r1w.sv
technology/behavioural/dtof_sram_1rw.sv
common/dtof_sram.sv
common/dtof_array_errors.sv
common/dtof_gate_register.sv
thesis/dtof_pass_sequencer.sv
thesis/dtof_pixel_sequencer.sv
thesis/dtof_scan_sequencer.sv
common/dtof_broadcast.sv
thesis/dtof_controller.sv
thesis/dtof_column_rules.sv
common/dtof_stream_rules.sv
thesis/dtof_result_output.sv
pool/dtof_pair_sequencer.sv
pool/dtof_pool_controller.sv
pool/dtof_pool_result_output.sv
pool/dtof_pool2_sequencer.sv
thesis/dtof_data_filter.sv
thesis/dtof_full_counter_link.sv
thesis/dtof_histogram_builder.sv
thesis/dtof_pair_detector.sv
thesis/dtof_pair_interpolator.sv
thesis/dtof_peak_detector.sv
thesis/dtof_peak_histogram.sv
thesis/dtof_pointer_update.sv
thesis/dtof_word_builder.sv
thesis/dtof_pointer_builder.sv
thesis/dtof_result_register.sv
thesis/dtof_status_bits.sv
pool/dtof_label_match.sv
pool/dtof_minimum.sv
pool/dtof_pixel_distance.sv
pool/dtof_pool2_track_update.sv
common/dtof_timestamp_input.sv
pool/dtof_twin_pointer_update.sv
pool/dtof_pool2_pixel_update.sv
pool/dtof_label_chain.sv
pool/dtof_beside_evidence.sv
pool/dtof_smoothing.sv
pool/dtof_pool2_candidate_decoder.sv
pool/dtof_pool2_line.sv
pool/dtof_pool2_engine.sv
// Columns of dtof_array: written by scripts/generate.py
thesis/dtof_ez_pointer_column.sv
thesis/dtof_his_pointer_column.sv
thesis/dtof_interframe_histogram_column.sv
thesis/dtof_partitioned_histogram_column.sv
thesis/dtof_coarse_histogram_column.sv
// end of columns
pool/dtof_pool2_column.sv
pool/dtof_pool2_pair.sv
pool/dtof_pool2_quad.sv
thesis/dtof_array.sv
pool/dtof_pool_pointer2_array.sv
subsystem/dtof_line_buffer.sv
subsystem/dtof_watchdog.sv
subsystem/dtof_saturating_counter.sv
subsystem/dtof_shot_dither.sv
subsystem/dtof_frame_crc.sv
subsystem/dtof_array_reset.sv
subsystem/dtof_line_filter.sv
subsystem/dtof_target_words.sv
subsystem/dtof_stream_output.sv
subsystem/dtof_raster_buffer.sv
subsystem/dtof_frame_control.sv
subsystem/dtof_apb_registers.sv
subsystem/dtof_axi_lite_to_apb.sv
subsystem/dtof_reset_synchroniser.sv
subsystem/dtof_subsystem.sv
