# SPDX-License-Identifier: Apache-2.0
# All steps in one Yosys process. argv: the settings that the flow wrote for this configuration.
yosys -import
source $::env(DTOF_SETTINGS)
foreach step {1_read 2_check_rtl 3_generic 4_map 5_check_netlist} {
  puts "DTOF_STEP $step"
  source $scripts/$step.tcl
}
write_json $netlist_json
