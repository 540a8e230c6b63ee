# SPDX-License-Identifier: Apache-2.0
# From RTL to an elaborated netlist of dtof_subsystem. The array is read with its parameters, and then becomes a black box.
yosys -import
source $::env(DTOF_SETTINGS)
puts "DTOF_STEP read"
source $scripts/1_read.tcl
blackbox {*}$array_modules
hierarchy -check -top $top
puts "DTOF_STEP check"
source $scripts/2_check_rtl.tcl
opt_clean -purge
write_rtlil $elaborated_netlist
