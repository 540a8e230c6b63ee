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
  global liberty_files netlist top wire_load target_period activity
  foreach file $liberty_files { read_liberty $file }
  read_verilog $netlist
  link_design $top
  if {$wire_load ne ""} { set_wire_load_model -name $wire_load }
  puts "DTOF_CLOSING_PERIOD [closing_period $target_period]"
  constrain $::fast_period
  puts "DTOF_FAST_SLACK [worst_slack -max]"
  constrain $target_period
  puts "DTOF_SLACK [worst_slack -max] [worst_slack -min]"
  puts "DTOF_PATH_MAX"
  report_checks -path_delay max -digits 4 -fields {slew cap}
  puts "DTOF_PATH_MIN"
  report_checks -path_delay min -digits 4 -fields {slew cap}
  puts "DTOF_CHECKS"
  report_check_types -all_violators -max_transition -min_period
  puts "DTOF_POWER"
  set_power_activity -global -activity $activity
  report_power -digits 6
  puts "DTOF_POWER_SRAM"
  report_power -instances [get_cells -hierarchical *u_macro] -digits 6
}

source $::env(DTOF_SETTINGS)
if {[catch run message]} {
  puts "DTOF_STA_FAILED $message"
} else {
  puts "DTOF_STA_OK"
}
exit
