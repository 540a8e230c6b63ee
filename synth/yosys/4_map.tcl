# SPDX-License-Identifier: Apache-2.0
# Maps to the library: flip-flops, then logic with buffering and sizing against the clock period, constants last.
#
# ABC's result depends on private names, on which nothing else depends. So the column, which the
# array has many times, and what the columns share are each mapped with several namings, and the smallest is kept.
proc area_of_selection {} {
  global liberty area_log
  tee -q -o $area_log stat -liberty $liberty
  set log [open $area_log]
  set areas [regexp -all -inline {Chip area for module [^\n]*: *([0-9.]+)} [read $log]]
  close $log
  set sum 0
  foreach {line area} $areas { set sum [expr {$sum + $area}] }
  return $sum
}
proc map_smallest {part naming_seeds selection} {
  global liberty abc_constraints abc_period_ps abc_script
  design -save unmapped
  set smallest Inf
  foreach seed $naming_seeds {
    design -load unmapped
    yosys select {*}$selection
    if {$seed != 0} { yosys rename -scramble-name -seed $seed % w:\$* c:\$* %u %i }
    dfflibmap -liberty $liberty
    opt_clean -purge
    abc -liberty $liberty -constr $abc_constraints -D $abc_period_ps -script $abc_script
    set area [area_of_selection]
    yosys select -clear
    if {$area < $smallest} {
      set smallest $area
      set best $seed
      design -save smallest
    }
  }
  design -load smallest
  puts "DTOF_NAMING $part $best"
}
map_smallest column $column_seeds {*_column *_quad *_pair}
map_smallest shared $shared_seeds {* *_column %d *_quad %d *_pair %d}
setundef -zero
if {$tie_low ne "" && $tie_high ne ""} { hilomap -singleton -hicell {*}$tie_high -locell {*}$tie_low }
splitnets
yosys rename -wire
opt_clean -purge
