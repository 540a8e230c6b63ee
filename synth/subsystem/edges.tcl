# SPDX-License-Identifier: Apache-2.0
# Pins of the netlist of dtof_subsystem whose transition is beyond the limit, of the library or of set_max_transition, one line each;
# DTOF_STA_OK says that every command succeeded.
proc run {} {
  foreach file $::liberty_files { read_liberty $file }
  read_verilog $::netlist
  link_design $::top
  if {$::wire_load ne ""} { set_wire_load_model -name $::wire_load }
  uplevel #0 source $::constraints
  uplevel #0 source $::margins
  puts "DTOF_EDGES"
  report_check_types -all_violators -max_transition
  puts "DTOF_END"
}

source $::env(DTOF_SETTINGS)
if {[catch run message]} {
  puts "DTOF_STA_FAILED $message"
} else {
  puts "DTOF_STA_OK"
}
exit
