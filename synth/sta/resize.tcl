# SPDX-License-Identifier: Apache-2.0
# Gates of other drive strengths, by trial: OpenSTA times the whole array anew after each. ABC chooses them without knowing when
# an SRAM's word or a broadcast arrives, and when its outputs are due.
#   grow     of the slowest path the gate whose larger drive takes the most negative slack away for its area, until no slack is
#            negative, or no such gate is on the slowest PATHS, or MOST_GROWN have been enlarged
#   shrink   the gates of `shrinkable` to the next smaller drive, if that leaves all paths met
# `drives`: cells of one function, smallest first, by list. `blocks`: kind of a block, its instances, how many the array has of
# it; a gate is resized in all of them at once. Gates outside blocks have the kind `top`.
# Prints what is another drive now, the area of it all and the slack.

set PATHS 100
set MOST_GROWN 500

proc index_drives {} {
  foreach family $::drives {
    for {set i 0} {$i < [llength $family]} {incr i} {
      set name [lindex $family $i]
      set ::smaller($name) [expr {$i > 0 ? [lindex $family [expr {$i - 1}]] : ""}]
      set ::larger($name) [lindex $family [expr {$i + 1}]]
    }
  }
}

# {kind gate} of a pin's name, or nothing for a port.
proc gate_of {pin} {
  set parts [split $pin /]
  if {[llength $parts] == 2} { return [list top [lindex $parts 0]] }
  if {[llength $parts] == 3} { return [list $::kind_of([lindex $parts 0]) [lindex $parts 1]] }
}

proc instances {kind gate} {
  if {$kind eq "top"} { return [list [get_cells $gate]] }
  return [lmap block $::instances_of($kind) { get_cells $block/$gate }]
}

# What another drive of a gate adds to the array's area.
proc added_area {gate now next} {
  return [expr {$::copies_of([lindex $gate 0]) * ($::area_of($next) - $::area_of($now))}]
}

proc resize_to {cells name} {
  foreach cell $cells { replace_cell $cell [get_lib_cells */$name] }
}

# Gates on a path that have a larger drive, each once.
proc growable {path} {
  set found {}
  foreach point [get_property $path points] {
    set gate [gate_of [get_full_name [get_property $point pin]]]
    if {$gate eq "" || $gate in $found} { continue }
    set now [get_property [lindex [instances {*}$gate] 0] ref_name]
    if {[info exists ::larger($now)] && $::larger($now) ne ""} { lappend found $gate }
  }
  return $found
}

# The best gate to grow on a path, what it is and what it shall be; nothing if none helps.
proc best_of_path {path} {
  set before [total_negative_slack]
  set best 0
  set choice {}
  foreach gate [growable $path] {
    set cells [instances {*}$gate]
    set now [get_property [lindex $cells 0] ref_name]
    for {set next $::larger($now)} {$next ne ""} {set next $::larger($next)} {
      resize_to $cells $next
      set gain [expr {[total_negative_slack] - $before}]
      set worth [expr {$gain / [added_area $gate $now $next]}]
      if {$gain > 1e-5 && $worth > $best} {
        set best $worth
        set choice [list $gate $now $next]
      }
    }
    resize_to $cells $now
  }
  return $choice
}

# That of the slowest path where there is one. OpenSTA keeps the memory of all paths that it ever found, so the slowest
# alone is looked at first.
proc best_growth {} {
  foreach count [list 1 $::PATHS] {
    foreach path [find_timing_paths -path_delay max -group_count $count] {
      if {[get_property $path slack] >= 0} { continue }
      set choice [best_of_path $path]
      if {$choice ne ""} { return $choice }
    }
  }
}

proc resize {} {
  foreach {kind names copies} $::blocks {
    set ::instances_of($kind) $names
    set ::copies_of($kind) $copies
    foreach name $names { set ::kind_of($name) $kind }
  }
  set ::copies_of(top) 1
  array set ::area_of $::cell_areas
  index_drives
  constrain [expr {$::target_period - $::guard}]
  uplevel #0 source $::margins
  set resized [dict create]
  set area 0
  for {set grown 0} {$grown < $::MOST_GROWN && [total_negative_slack] < 0} {incr grown} {
    lassign [best_growth] gate now next
    if {$gate eq ""} { break }
    resize_to [instances {*}$gate] $next
    dict set resized $gate $next
    set area [expr {$area + [added_area $gate $now $next]}]
  }
  set limit [total_negative_slack]
  foreach pair $::shrinkable {
    set gate [list {*}$pair]
    set cells [instances {*}$gate]
    set now [get_property [lindex $cells 0] ref_name]
    set next $::smaller($now)
    resize_to $cells $next
    if {[total_negative_slack] < $limit} {
      resize_to $cells $now
    } else {
      dict set resized $gate $next
      set area [expr {$area + [added_area $gate $now $next]}]
    }
  }
  dict for {gate name} $resized { puts "DTOF_RESIZED $gate $name" }
  puts "DTOF_RESIZED_AREA $area"
  puts "DTOF_RESIZED_SLACK [expr {[worst_slack -max] + $::guard}]"
  puts "DTOF_END"
}
