# SPDX-License-Identifier: Apache-2.0
# RTL to technology-independent netlist, all steps in one Yosys process.
yosys -import
source $::env(DTOF_SETTINGS)
foreach step {1_read 2_check_rtl 3_generic} {
  puts "DTOF_STEP $step"
  source $scripts/$step.tcl
}
write_rtlil $generic_netlist
