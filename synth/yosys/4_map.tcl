# SPDX-License-Identifier: Apache-2.0
# Maps to the library: flip-flops, then logic with buffering and sizing against the clock period, constants last.
dfflibmap -liberty $liberty
opt_clean -purge
abc -liberty $liberty -constr $abc_constraints -D $abc_period_ps -script $abc_script
setundef -zero
if {$tie_low ne "" && $tie_high ne ""} { hilomap -singleton -hicell {*}$tie_high -locell {*}$tie_low }
splitnets
yosys rename -wire
opt_clean -purge
