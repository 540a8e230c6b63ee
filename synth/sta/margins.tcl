# SPDX-License-Identifier: Apache-2.0
# Slacks of one configuration in one corner with the margins of constraints/margins.sdc, and the paths that are too early or
# have less than `tight` ns to spare. OpenSTA exits 0 even after errors, so the flow looks for the marker DTOF_STA_OK, which is
# printed only after every command succeeded.

proc run {} {
  global liberty_files netlist wires top wire_load
  foreach file $liberty_files { read_liberty $file }
  read_verilog $netlist
  link_design $top
  if {$wire_load ne ""} { set_wire_load_model -name $wire_load }
  if {$wires ne ""} { read_spef $wires }
  uplevel #0 source $::constraints
  uplevel #0 source $::margins
  puts "DTOF_SLACK [worst_slack -max] [worst_slack -min]"
  puts "DTOF_PATH_MAX"
  report_checks -path_delay max -digits 4 -fields {slew cap}
  puts "DTOF_PATH_MIN"
  report_checks -path_delay min -digits 4 -fields {slew cap}
  puts "DTOF_EARLY"
  report_checks -path_delay min -slack_max 0 -group_count 100000 -format full -fields {input_pins} -digits 4
  puts "DTOF_TIGHT"
  report_checks -path_delay max -slack_max $::tight -group_count 100000 -format full -fields {input_pins} -digits 4
  puts "DTOF_RESET"
  report_check_types -recovery -removal
  puts "DTOF_END"
}

source $::env(DTOF_SETTINGS)
if {[catch run message]} {
  puts "DTOF_STA_FAILED $message"
} else {
  puts "DTOF_STA_OK"
}
exit
