# SPDX-License-Identifier: Apache-2.0
# Sums of the power of cells. `report_power -instances` would print and sort tens of thousands of lines.

# Prints one line per group of `groups` (name, cells, name, cells ...): DTOF_POWER <label> <group> <internal> <switching> <leakage>, in W.
proc report_power_sums {label groups} {
  set corner [sta::cmd_corner]
  foreach {group cells} $groups {
    set sums {0.0 0.0 0.0}
    foreach cell $cells {
      set power [sta::instance_power $cell $corner]
      set sums [lmap sum $sums part [lrange $power 0 2] { expr {$sum + $part} }]
    }
    puts "DTOF_POWER $label $group $sums"
  }
}

# Each group twice: with nearly idle data, so that the clock's power remains (CLOCK), and with all data nets at `activity` (ALL).
proc report_clock_and_all {activity groups} {
  foreach {label value} [list CLOCK 1e-9 ALL $activity] {
    set_power_activity -global -activity $value
    report_power_sums $label $groups
  }
}
