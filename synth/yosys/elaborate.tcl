# SPDX-License-Identifier: Apache-2.0
# From RTL to an elaborated netlist, without the names of nets that are another net.
yosys -import
source $::env(DTOF_SETTINGS)
foreach step {1_read 2_check_rtl} {
  puts "DTOF_STEP $step"
  source $scripts/$step.tcl
}
opt_clean -purge
write_rtlil $elaborated_netlist
