# SPDX-License-Identifier: Apache-2.0
# From RTL to an elaborated netlist of dtof_subsystem. The array is read with its parameters, and then becomes a black box.
yosys -import
source $::env(DTOF_SETTINGS)
puts "DTOF_STEP read"
source $scripts/1_read.tcl
blackbox {*}$array_modules
hierarchy -check -top $top
# The paths become pieces of the top.
setattr -mod -set keep_hierarchy 1 *
setattr -mod -unset keep_hierarchy $top {*}$path_modules
flatten
setattr -mod -unset keep_hierarchy *
puts "DTOF_STEP check"
source $scripts/2_check_rtl.tcl
opt_clean -purge
write_rtlil $elaborated_netlist
