# SPDX-License-Identifier: Apache-2.0
# Timing and power of one configuration in one corner. OpenSTA exits 0 even after errors, so the flow looks for
# the marker DTOF_STA_OK, which is printed only after every command succeeded.

proc constrain {new_period} {
  set ::period $new_period
  uplevel #0 source $::constraints
}

# Shortest period without violation. Slack falls with the period, but less than it where a port's budget is a
# share of the period: secant steps, at most twelve.
proc closing_period {start} {
  set previous_period $start
  constrain $start
  set previous_slack [worst_slack -max]
  set current [expr {$start - $previous_slack}]
  for {set step 0} {$step < 12} {incr step} {
    constrain $current
    set slack [worst_slack -max]
    if {abs($slack) < 0.0005} { break }
    set slope [expr {($slack - $previous_slack) / ($current - $previous_period)}]
    set previous_period $current
    set previous_slack $slack
    set current [expr {$current - $slack / max($slope, 0.1)}]
  }
  return $current
}

proc run {} {
  global liberty_files netlist wires top wire_load target_period activity
  foreach file $liberty_files { read_liberty $file }
  read_verilog $netlist
  link_design $top
  if {$wire_load ne ""} { set_wire_load_model -name $wire_load }
  if {$wires ne ""} { read_spef $wires }
  puts "DTOF_CLOSING_PERIOD [closing_period $target_period]"
  constrain $::fast_period
  puts "DTOF_FAST_SLACK [worst_slack -max]"
  constrain $target_period
  puts "DTOF_SLACK [worst_slack -max] [worst_slack -min]"
  puts "DTOF_PATH_MAX"
  report_checks -path_delay max -digits 4 -fields {slew cap}
  puts "DTOF_PATH_MIN"
  report_checks -path_delay min -digits 4 -fields {slew cap}
  puts "DTOF_MIN_PERIOD"
  report_check_types -min_period
  puts "DTOF_TRANSITION"
  report_check_types -all_violators -max_transition
  puts "DTOF_END"
  if {$::with_power} { report_cell_power $activity }
}

# Power of every cell but the SRAMs, once with nearly idle data (what remains is the clock) and once with the
# stated activity. Rows of `report_power -instances`: internal, switching, leakage, total, name.
proc report_cell_power {activity} {
  set cells {}
  foreach cell [get_cells -hierarchical *] {
    set name [get_full_name $cell]
    if {![string match *u_macro $name] && ![string match *u_column $name]
        && ![string match *u_pair $name]
        && ![string match *u_engine $name]} { lappend cells $cell }
  }
  foreach {label value} [list CLOCK 1e-9 ALL $activity] {
    puts "DTOF_POWER_$label"
    set_power_activity -global -activity $value
    report_power -instances $cells -digits 9
  }
}

source $::env(DTOF_SETTINGS)
if {[catch run message]} {
  puts "DTOF_STA_FAILED $message"
} else {
  puts "DTOF_STA_OK"
}
exit
