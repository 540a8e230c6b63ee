# SPDX-License-Identifier: Apache-2.0
# Slacks of all ports of an array in one corner, for the array's stand-in in the netlist of dtof_subsystem: without margins, then with
# them. The edges at inputs and the loads at outputs are those of the margins in both. One line per port:
#   DTOF_PORT <nominal or margins> <port> <in or out> <setup slack> <hold slack> <pins on its net>
# Before, report_net prints the load of each input. DTOF_STA_OK says that every command succeeded.
proc least {object kind} {
  return [expr {min([get_property $object ${kind}_rise_slack], [get_property $object ${kind}_fall_slack])}]
}

proc ports {step} {
  foreach port [concat [all_inputs] [all_outputs]] {
    set name [get_full_name $port]
    if {$name eq "clk_i"} { continue }
    set way [expr {[get_property $port direction] eq "input" ? "in" : "out"}]
    set pins 0
    set net [get_nets -quiet $name]
    if {$net ne "" && $net ne "NULL"} { set pins [llength [get_pins -quiet -of_objects $net]] }
    puts "DTOF_PORT $step $name $way [least $port max] [least $port min] $pins"
  }
}

proc input_loads {} {
  foreach port [all_inputs] {
    set name [get_full_name $port]
    if {$name ne "clk_i" && [get_nets -quiet $name] ni {"" NULL}} { report_net -connections -verbose $name }
  }
}

proc run {} {
  foreach file $::liberty_files { read_liberty $file }
  read_verilog $::netlist
  link_design $::top
  if {$::wire_load ne ""} { set_wire_load_model -name $::wire_load }
  read_spef $::wires
  uplevel #0 source $::constraints
  set_input_transition $::slew [all_inputs]
  set_load $::load [all_outputs]
  puts "DTOF_THROUGH"
  report_checks -from [all_inputs] -to [all_outputs]
  puts "DTOF_END"
  input_loads
  ports nominal
  uplevel #0 source $::margins
  ports margins
}

source $::env(DTOF_SETTINGS)
if {[catch run message]} {
  puts "DTOF_STA_FAILED $message"
} else {
  puts "DTOF_STA_OK"
}
exit
