# SPDX-License-Identifier: Apache-2.0
# From RTL to a flat netlist of the process's cells (synth/dtof_synth/shuttle.py has the settings). Memories become flip-flops.
yosys -import
source $::env(DTOF_SETTINGS)

puts "DTOF_STEP read"
read_liberty -lib $liberty
read_verilog -sv -DSYNTHESIS -I$rtl_include {*}$rtl_files
foreach {name value} $parameters { chparam -set $name $value $top }

puts "DTOF_STEP synthesis"
synth -top $top -flatten
select -assert-none t:\$_DLATCH*
check -assert

puts "DTOF_STEP map"
dfflibmap -liberty $liberty
opt_clean -purge
abc -liberty $liberty -constr $abc_constraints -D $abc_period_ps
setundef -zero
hilomap -singleton -hicell {*}$tie_high -locell {*}$tie_low
splitnets
yosys rename -wire
opt_clean -purge

puts "DTOF_STEP check"
select -assert-none t:\$*
check -assert -mapped
write_json $netlist_json
