# SPDX-License-Identifier: Apache-2.0
# Power of every cell of a column's netlist with one activity of all data nets, and with nearly idle data; the difference is the power of
# the data. As in timing.tcl the marker DTOF_STA_OK says that every command succeeded.
source $::env(DTOF_SCRIPTS)/cell_power.tcl

proc run {} {
  global liberty_files netlist top wire_load column activity
  foreach file $liberty_files { read_liberty $file }
  read_verilog $netlist
  link_design $top
  if {$wire_load ne ""} { set_wire_load_model -name $wire_load }
  create_clock -name clk -period $::period [get_ports clk_i]
  set cells {}
  foreach cell [get_cells -hierarchical *] {
    set name [get_full_name $cell]
    if {[string match *$column/* $name] && ![string match *u_macro $name]} { lappend cells $cell }
  }
  report_clock_and_all $activity [list column $cells]
}

source $::env(DTOF_SETTINGS)
if {[catch run message]} {
  puts "DTOF_STA_FAILED $message"
} else {
  puts "DTOF_STA_OK"
}
exit
