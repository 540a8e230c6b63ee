# SPDX-License-Identifier: Apache-2.0
# Timing and power of one netlist in one corner. `steps` selects from the following steps, in this order:
#   check     ends of paths that no path reaches
#   nominal   slacks at the target clock
#   closing   the shortest period, and its slack
#   power     power of every cell, at the target clock
#   margins   slacks with the margins of constraints/margins.sdc, which stay in force
#   early     paths that are too early with these margins
#   spare     setup slack of each of `pins` with these margins
#   resize    other drive strengths of gates (resize.tcl); alone, since the clock and the margins of that step stay in force
# OpenSTA exits with 0 even after errors, so the flow checks for the marker DTOF_STA_OK, which is printed only after every command
# succeeded.

source $::env(DTOF_SCRIPTS)/cell_power.tcl
source $::env(DTOF_SCRIPTS)/resize.tcl

proc constrain {new_period} {
  set ::period $new_period
  uplevel #0 source $::constraints
}

# Slack of the slowest path (max) or of the earliest one (min). For some netlists worst_slack crashes OpenSTA, in a sort of its own. Then the
# flow runs the script again with DTOF_SLACK_OF_PATHS: the slack is that of the worst path, with seven digits.
proc slack_of {kind} {
  if {![info exists ::env(DTOF_SLACK_OF_PATHS)]} { return [worst_slack -$kind] }
  set slacks {}
  foreach path [find_timing_paths -path_delay $kind] { lappend slacks [get_property $path slack] }
  return [lindex [lsort -real $slacks] 0]
}

# Shortest period without violation, searched from the target clock on. Slack falls with the period, but by less than the period if a
# port's budget is a share of the period: secant steps, at most twelve.
proc closing_period {} {
  set previous_period $::target_period
  set previous_slack [slack_of max]
  set current [expr {$previous_period - $previous_slack}]
  for {set step 0} {$step < 12} {incr step} {
    constrain $current
    set slack [slack_of max]
    if {abs($slack) < 0.0005} { break }
    set slope [expr {($slack - $previous_slack) / ($current - $previous_period)}]
    set previous_period $current
    set previous_slack $slack
    set current [expr {$current - $slack / max($slope, 0.1)}]
  }
  return $current
}

proc closing {} {
  puts "DTOF_CLOSING_PERIOD [closing_period]"
  constrain $::fast_period
  puts "DTOF_FAST_SLACK [slack_of max]"
  constrain $::target_period
}

# Setup and hold, and the slowest path of each group.
proc report_slacks {prefix} {
  puts "${prefix}_SLACK [slack_of max] [slack_of min]"
  puts "${prefix}_PATH_MAX"
  report_checks -path_delay max -digits 4 -fields {slew cap}
  puts "${prefix}_PATH_MIN"
  report_checks -path_delay min -digits 4 -fields {slew cap}
}

proc check {} {
  puts "DTOF_CHECK"
  check_setup -verbose -no_input_delay -no_clock -multiple_clock -loops -unconstrained_endpoints -generated_clocks
  puts "DTOF_END"
}

proc nominal {} {
  report_slacks DTOF
  puts "DTOF_MIN_PERIOD"
  report_check_types -min_period
  puts "DTOF_TRANSITION"
  report_check_types -all_violators -max_transition
  puts "DTOF_END"
}

proc margins {} {
  uplevel #0 source $::margins
  report_slacks DTOF_MARGIN
  puts "DTOF_RESET"
  report_check_types -recovery -removal
  puts "DTOF_END"
}

proc early {} {
  puts "DTOF_EARLY"
  report_checks -path_delay min -slack_max 0 -group_count 100000 -format full -fields {input_pins} -digits 4
  puts "DTOF_END"
}

# Slack of the slowest path through each pin, in ns.
proc spare {} {
  puts "DTOF_SPARE"
  foreach name $::pins {
    set pin [sta::find_pin $name]
    puts "$name [expr {min([get_property $pin max_rise_slack], [get_property $pin max_fall_slack])}]"
  }
  puts "DTOF_END"
}

# Power of the cells of the column `measured_column`, and of all cells outside the columns, without SRAMs.
proc power {} {
  set column {}
  set shared {}
  foreach cell [get_cells -hierarchical *] {
    set name [get_full_name $cell]
    if {[string match *u_macro $name] || [string match *u_column $name] || [string match *u_quad $name]
        || [string match *u_engine $name]} { continue }
    if {![regexp {^.*u_(column|quad)/} $name place]} {
      lappend shared $cell
    } elseif {$place eq "$::measured_column/"} {
      lappend column $cell
    }
  }
  report_clock_and_all $::activity [list column $column shared $shared]
}

proc run {} {
  global liberty_files netlist wires top wire_load steps
  foreach file $liberty_files { read_liberty $file }
  read_verilog $netlist
  link_design $top
  if {$wire_load ne ""} { set_wire_load_model -name $wire_load }
  if {$wires ne ""} { read_spef $wires }
  constrain $::target_period
  foreach step {check nominal closing power margins early spare resize} {
    if {$step in $steps} { $step }
  }
}

source $::env(DTOF_SETTINGS)
if {[catch run message]} {
  puts "DTOF_STA_FAILED $message"
} else {
  puts "DTOF_STA_OK"
}
exit
