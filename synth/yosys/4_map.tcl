# SPDX-License-Identifier: Apache-2.0
# Maps to the library: flip-flops, then logic with buffering and sizing for the clock period, constants last.
#
# The column and the logic that columns share have separate ABC scripts. ABC's result depends on private names, which have no other
# effect; another naming shows by how much (make synth-namings).
proc map_part {selection abc_script} {
  global liberty abc_constraints abc_period_ps naming
  yosys select {*}$selection
  if {$naming != 0} { yosys rename -scramble-name -seed $naming % w:\$* c:\$* %u %i }
  dfflibmap -liberty $liberty
  opt_clean -purge
  abc -liberty $liberty -constr $abc_constraints -D $abc_period_ps -script $abc_script
  yosys select -clear
}
map_part {*_column *_quad *_pair} $column_script
map_part {* *_column %d *_quad %d *_pair %d} $shared_script
setundef -zero
if {$tie_low ne "" && $tie_high ne ""} { hilomap -singleton -hicell {*}$tie_high -locell {*}$tie_low }
splitnets
yosys rename -wire
opt_clean -purge
