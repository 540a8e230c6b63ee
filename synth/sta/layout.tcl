# SPDX-License-Identifier: Apache-2.0
# Times one netlist with three kinds of wires: none, those of the wire-load model, those of the layout. Every path counts from a
# register or a port to a register or a port, without budgets for logic outside; the clock is ideal. OpenSTA exits with 0
# even after errors, so the flow checks for DTOF_STA_OK.
proc ends {label} {
  puts $label
  report_checks -path_delay max -format end -digits 4 -group_count 100000 -endpoint_count 1
  puts "DTOF_END"
}

proc run {} {
  foreach file $::liberty_files { read_liberty $file }
  read_verilog $::netlist
  link_design $::top
  create_clock -name clk -period $::period [get_ports clk_i]
  set_input_delay 0 -clock clk [get_ports $::inputs]
  set_output_delay 0 -clock clk [get_ports $::outputs]
  set_driving_cell -lib_cell $::driving_cell [get_ports $::inputs]
  set_load $::load [get_ports $::outputs]
  set reset [get_ports -quiet rst_ni]
  if {[llength $reset]} { set_false_path -from $reset }
  ends DTOF_BARE
  set_wire_load_model -name $::wire_load
  ends DTOF_MODEL
  puts "DTOF_MODEL_PATH"
  report_checks -path_delay max -digits 4
  read_spef $::parasitics
  ends DTOF_ROUTED
  puts "DTOF_ROUTED_PATH"
  report_checks -path_delay max -digits 4
}

source $::env(DTOF_SETTINGS)
if {[catch run message]} {
  puts "DTOF_STA_FAILED $message"
} else {
  puts "DTOF_STA_OK"
}
exit
