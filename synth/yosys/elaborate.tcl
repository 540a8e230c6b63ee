# SPDX-License-Identifier: Apache-2.0
# From RTL to an elaborated netlist.
yosys -import
source $::env(DTOF_SETTINGS)
foreach step {1_read 2_check_rtl} {
  puts "DTOF_STEP $step"
  source $scripts/$step.tcl
}
write_rtlil $elaborated_netlist
