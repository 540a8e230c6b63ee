# SPDX-License-Identifier: Apache-2.0
# Every end of a path in the netlist of dtof_subsystem that OpenSTA times, one line each, by path group; DTOF_STA_OK says that every
# command succeeded. make synth-subsystem compares the lines with the ends that it counts in the netlist. Slacks are with margins. For each
# end of `asked`, on which check_setup warns, a line says whether OpenSTA finds a constant there.
proc run {} {
  foreach file $::liberty_files { read_liberty $file }
  read_verilog $::netlist
  link_design $::top
  if {$::wire_load ne ""} { set_wire_load_model -name $::wire_load }
  uplevel #0 source $::constraints
  foreach name $::asked {
    puts "DTOF_ASKED $name"
    if {[string match */* $name]} { report_constant [get_pins $name] } else { report_constant [get_ports $name] }
  }
  uplevel #0 source $::margins
  foreach kind {max min} {
    puts "DTOF_ENDS_$kind"
    report_checks -path_delay $kind -format end -digits 4 -group_count 100000 -endpoint_count 1
    puts "DTOF_END"
  }
}

source $::env(DTOF_SETTINGS)
if {[catch run message]} {
  puts "DTOF_STA_FAILED $message"
} else {
  puts "DTOF_STA_OK"
}
exit
