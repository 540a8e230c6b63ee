# SPDX-License-Identifier: Apache-2.0
# Sums of cells' power. `report_power -instances` would print and sort tens of thousands of lines.

# One line per group of `groups` (a name, its cells, and so on): DTOF_POWER <label> <group> <internal> <switching> <leakage>, in W.
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

# The groups twice: with nearly idle data, so that the clock is what remains (CLOCK), and with every data net at `activity` (ALL).
proc report_clock_and_all {activity groups} {
  foreach {label value} [list CLOCK 1e-9 ALL $activity] {
    set_power_activity -global -activity $value
    report_power_sums $label $groups
  }
}
