# SPDX-License-Identifier: Apache-2.0
# Changes drive strengths of gates by trial: OpenSTA times the whole array again after each change. ABC chooses drives without the
# arrival times of SRAM words and broadcasts, and without the required times of their outputs.
#   grow     On the slowest path, enlarges the gate whose larger drive removes the most negative slack for its area, and others that remove
#            at least SHARE_OF_BEST of that. Ends if no slack is negative, or if no such gate is on the slowest PATHS, or if MOST_GROWN
#            gates are enlarged. Does not try if a path misses by more than HOPELESS_NS, which no drive corrects. OpenSTA's total negative
#            slack changes a little with every trial, so a gate can seem to help: a gate whose second trial shows no gain is not tried again.
#            Bits of a word often have paths with equal delays to one register. No gate of one of them helps alone, so the gates at one place of
#            all these twins are then enlarged together.
#   drop     Removes buffers of `dispensable` if all paths stay met: {kind buffer driver drive}, where `drive` is the cell of
#            the driver that carries the load without the buffer.
#   shrink   Sets the gates of `shrinkable` to the next smaller drive if all paths stay met.
# `drives`: lists of cells of one function, smallest first. `blocks`: kind of a block, its instances, their number in the array; a
# gate is resized in all of them at once. Gates outside blocks have the kind `top`. `stand_ins`: kind of a block, the
# instances that have only gates at the border, and these gates.
# `buffer_pins`: input and output of all buffers.
# Prints the changed drives, the buffers that are not needed, the total area and the slack.

set PATHS 100
set MOST_GROWN 500
set SHARE_OF_BEST 0.15
set HOPELESS_NS 0.4
set MOST_TWINS 8
set TWIN_NS 0.0005

proc index_drives {} {
  foreach family $::drives {
    for {set i 0} {$i < [llength $family]} {incr i} {
      set name [lindex $family $i]
      set ::smaller($name) [expr {$i > 0 ? [lindex $family [expr {$i - 1}]] : ""}]
      set ::larger($name) [lindex $family [expr {$i + 1}]]
    }
  }
}

# {kind gate} of a pin's name, or an empty list for a port.
proc gate_of {pin} {
  set parts [split $pin /]
  if {[llength $parts] == 2} { return [list top [lindex $parts 0]] }
  if {[llength $parts] == 3} { return [list $::kind_of([lindex $parts 0]) [lindex $parts 1]] }
}

# Blocks that have a gate; stand-ins last.
proc blocks_with {kind gate} {
  if {[info exists ::in_stand_ins([list $kind $gate])]} { return [concat $::instances_of($kind) $::stand_ins_of($kind)] }
  return $::instances_of($kind)
}

proc instances {kind gate} {
  if {![info exists ::cells_of([list $kind $gate])]} {
    set ::cells_of([list $kind $gate]) [expr {$kind eq "top" ? [list [get_cells $gate]]
                                              : [lmap block [blocks_with $kind $gate] { get_cells $block/$gate }]}]
  }
  return $::cells_of([list $kind $gate])
}

# Area that another drive of a gate adds to the array.
proc added_area {gate now next} {
  return [expr {$::copies_of([lindex $gate 0]) * ($::area_of($next) - $::area_of($now))}]
}

proc resize_to {cells name} {
  foreach cell $cells { replace_cell $cell [get_lib_cells */$name] }
}

# Gates on a path that have a larger drive, without duplicates.
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

# Negative slack that a drive of a gate removes, over its area; 0 if it removes hardly any.
proc worth {gate cells now next before} {
  resize_to $cells $next
  set gain [expr {[total_negative_slack] - $before}]
  return [expr {$gain > 1e-5 ? $gain / [added_area $gate $now $next] : 0}]
}

# Gates to grow on a path, each as {worth gate now next} with its next larger drive, the best first; empty if none helps.
proc growths_of_path {path} {
  set before [total_negative_slack]
  set found {}
  foreach gate [growable $path] {
    if {[info exists ::hopeless($gate)] || [info exists ::useless($gate)]} { continue }
    set cells [instances {*}$gate]
    set now [get_property [lindex $cells 0] ref_name]
    set next $::larger($now)
    set worth [worth $gate $cells $now $next $before]
    resize_to $cells $now
    if {$worth > 0} { lappend found [list $worth $gate $now $next] } else { set ::hopeless($gate) 1 }
  }
  return [lsort -real -decreasing -index 0 $found]
}

# Grows the best gate of a path, and those that still remove enough after that, each as far as its growth helps; returns the grown
# gates.
proc grow {growths} {
  set enough [expr {[lindex $growths 0 0] * $::SHARE_OF_BEST}]
  set grown {}
  foreach growth $growths {
    lassign $growth worth gate now next
    if {$worth < $enough} { break }
    set cells [instances {*}$gate]
    set before [total_negative_slack]
    set best $enough
    set chosen $now
    for {} {$next ne ""} {set next $::larger($next)} {
      set worth [worth $gate $cells $now $next $before]
      if {$worth < $best} { break }
      set best $worth
      set chosen $next
    }
    resize_to $cells $chosen
    if {$chosen ne $now} { lappend grown [list $gate $now $chosen] }
  }
  return $grown
}

# Gates of the slowest path, if it has any. OpenSTA keeps the memory of all paths that it ever found, so only the slowest
# path is looked at first. A gate that once did not help is tried again when no other gate helps.
proc best_growths {} {
  foreach again {0 1} {
    if {$again} { array unset ::hopeless }
    foreach count [list 1 $::PATHS] {
      foreach path [find_timing_paths -path_delay max -group_count $count] {
        if {[get_property $path slack] >= 0} { continue }
        set growths [growths_of_path $path]
        if {$growths ne ""} { return $growths }
      }
    }
  }
}

# Lists of growable gates on the slowest paths to one register whose slacks differ by less than TWIN_NS; empty if there is one path or no
# late one.
proc twins {} {
  set found {}
  foreach path [find_timing_paths -path_delay max -group_count $::MOST_TWINS -endpoint_count $::MOST_TWINS] {
    set slack [get_property $path slack]
    set end [get_full_name [get_property $path endpoint]]
    if {$found eq ""} {
      if {$slack >= 0} { return }
      set limit [expr {$slack + $::TWIN_NS}]
      set first_end $end
    }
    if {$slack < $limit && $end eq $first_end} { lappend found [growable $path] }
  }
  if {[llength $found] > 1} { return $found }
}

# Grows the gates at the place of twins where that helps most for its area, by one drive; returns them.
proc grow_twins {} {
  set paths [twins]
  set before [total_negative_slack]
  set most 0
  set chosen {}
  for {set place 0} {$place < [llength [lindex $paths 0]]} {incr place} {
    set grown {}
    set area 0
    foreach gate [lsort -unique [lmap path $paths { lindex $path $place }]] {
      if {$gate eq ""} { continue }
      set now [get_property [lindex [instances {*}$gate] 0] ref_name]
      lappend grown [list $gate $now $::larger($now)]
      set area [expr {$area + [added_area $gate $now $::larger($now)]}]
    }
    if {[llength $grown] < 2} { continue }
    foreach growth $grown { resize_to [instances {*}[lindex $growth 0]] [lindex $growth 2] }
    set worth [expr {([total_negative_slack] - $before) / $area}]
    foreach growth $grown { resize_to [instances {*}[lindex $growth 0]] [lindex $growth 1] }
    if {$worth > $most} {
      set most $worth
      set chosen $grown
    }
  }
  foreach growth $chosen { resize_to [instances {*}[lindex $growth 0]] [lindex $growth 2] }
  if {$chosen ne ""} { array unset ::hopeless }
  return $chosen
}

# Pins of a net, except its driver.
proc sinks {net driver} {
  set found {}
  foreach pin [get_pins -of_objects $net] {
    if {[get_full_name $pin] ne $driver} { lappend found $pin }
  }
  return $found
}

# Connects pins to another net.
proc move_pins {pins from to} {
  foreach pin $pins {
    disconnect_pin $from $pin
    connect_pin $to $pin
  }
}

# Records that a gate has another drive now.
proc note {gate now next} {
  dict set ::resized $gate $next
  set ::area [expr {$::area + [added_area $gate $now $next]}]
}

proc grow_late_paths {} {
  if {[slack_of max] < -$::HOPELESS_NS} { return }
  for {set grown 0} {$grown < $::MOST_GROWN && [total_negative_slack] < 0} {} {
    set growths [best_growths]
    if {$growths eq ""} {
      set chosen [grow_twins]
      if {$chosen eq ""} { break }
    } else {
      set chosen [grow $growths]
      if {$chosen eq ""} {
        foreach growth $growths { set ::useless([lindex $growth 1]) 1 }
      }
    }
    foreach growth $chosen {
      note {*}$growth
      incr grown
    }
  }
}

# Removes a buffer if all paths stay met.
proc drop {kind buffer driver drive} {
  lassign $::buffer_pins input output
  set cells [instances $kind $driver]
  set now [get_property [lindex $cells 0] ref_name]
  set own [get_property [lindex [instances $kind $buffer] 0] ref_name]
  if {$::area_of($drive) - $::area_of($now) >= $::area_of($own)} { return }
  set limit [total_negative_slack]
  set places {}
  foreach block [blocks_with $kind $buffer] {
    set pin [get_pins $block/$buffer/$input]
    set net [get_nets -of_objects $pin]
    set own_net [get_nets -of_objects [get_pins $block/$buffer/$output]]
    lappend places [list $pin $net $own_net [sinks $own_net $block/$buffer/$output]]
  }
  foreach place $places {
    lassign $place pin net own_net sinks
    disconnect_pin $net $pin
    move_pins $sinks $own_net $net
  }
  resize_to $cells $drive
  if {[total_negative_slack] < $limit} {
    foreach place $places {
      lassign $place pin net own_net sinks
      connect_pin $net $pin
      move_pins $sinks $net $own_net
    }
    resize_to $cells $now
    return
  }
  lappend ::dropped [list $kind $buffer]
  set ::area [expr {$::area - $::copies_of($kind) * $::area_of($own)}]
  if {$drive ne $now} { note [list $kind $driver] $now $drive }
}

# Sets a gate to the next smaller drive if all paths stay met.
proc shrink {gate} {
  set limit [total_negative_slack]
  set cells [instances {*}$gate]
  set now [get_property [lindex $cells 0] ref_name]
  set next $::smaller($now)
  resize_to $cells $next
  if {[total_negative_slack] < $limit} {
    resize_to $cells $now
  } else {
    note $gate $now $next
  }
}

proc resize {} {
  foreach {kind names copies} $::blocks {
    set ::instances_of($kind) $names
    set ::copies_of($kind) $copies
    foreach name $names { set ::kind_of($name) $kind }
  }
  foreach {kind names gates} $::stand_ins {
    set ::stand_ins_of($kind) $names
    foreach name $names { set ::kind_of($name) $kind }
    foreach gate $gates { set ::in_stand_ins([list $kind $gate]) 1 }
  }
  set ::copies_of(top) 1
  array set ::area_of $::cell_areas
  index_drives
  set ::resized [dict create]
  set ::dropped {}
  set ::area 0
  constrain [expr {$::target_period - $::guard}]
  uplevel #0 source $::margins
  grow_late_paths
  foreach item $::dispensable { drop {*}$item }
  foreach pair $::shrinkable {
    set gate [list {*}$pair]
    if {$gate ni $::dropped} { shrink $gate }
  }
  dict for {gate name} $::resized { puts "DTOF_RESIZED $gate $name" }
  foreach gate $::dropped { puts "DTOF_DROPPED $gate" }
  puts "DTOF_RESIZED_AREA $::area"
  puts "DTOF_RESIZED_SLACK [expr {[slack_of max] + $::guard}]"
  puts "DTOF_END"
}
