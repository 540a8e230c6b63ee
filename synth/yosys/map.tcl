# SPDX-License-Identifier: Apache-2.0
# From a technology-independent to a mapped netlist; repeated with more effort if timing does not close.
yosys -import
source $::env(DTOF_SETTINGS)
read_rtlil $generic_netlist
foreach step {4_map 5_check_netlist} {
  puts "DTOF_STEP $step"
  source $scripts/$step.tcl
}
write_json $netlist_json
