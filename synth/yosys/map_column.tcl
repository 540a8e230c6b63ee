# SPDX-License-Identifier: Apache-2.0
# As map.tcl, for the column (of a pool read-out for a pair of columns, without the SRAM) alone: what is placed and routed.
yosys -import
source $::env(DTOF_SETTINGS)
read_rtlil $generic_netlist
yosys delete *_array *_engine *_quad
foreach step {4_map 5_check_netlist} {
  puts "DTOF_STEP $step"
  source $scripts/$step.tcl
}
write_json $netlist_json
