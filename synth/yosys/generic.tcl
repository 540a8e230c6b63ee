# SPDX-License-Identifier: Apache-2.0
# From an elaborated to a technology-independent netlist.
yosys -import
source $::env(DTOF_SETTINGS)
read_rtlil $elaborated_netlist
puts "DTOF_STEP 3_generic"
source $scripts/3_generic.tcl
write_rtlil $generic_netlist
