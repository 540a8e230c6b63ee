# SPDX-License-Identifier: Apache-2.0
# As map.tcl, for the column alone (in a pool read-out a pair of columns without the SRAM): input of place and route.
yosys -import
source $::env(DTOF_SETTINGS)
read_rtlil $generic_netlist
yosys delete *_array *_engine *_quad
foreach step {4_map 5_check_netlist} {
  puts "DTOF_STEP $step"
  source $scripts/$step.tcl
}
write_json $netlist_json
