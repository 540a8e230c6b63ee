# SPDX-License-Identifier: Apache-2.0
# Timing of the netlist in one corner. DTOF_STA_OK is printed only after every command succeeded, since OpenSTA's exit status is 0 even
# after errors.
source $::env(DTOF_SETTINGS)
read_liberty $liberty
read_verilog $netlist
link_design $top
source $constraints
# The clock tree is not built yet; its edges are assumed.
set_clock_transition 0.2 [get_clocks clk]

puts "DTOF_CHECK"
check_setup -verbose
puts "DTOF_END"
puts "DTOF_SLACK [worst_slack -max] [worst_slack -min]"
set inside [lindex [find_timing_paths -path_group clk -from [all_registers -clock_pins] -to [all_registers -data_pins]] 0]
puts "DTOF_INSIDE [get_property $inside slack]"
report_checks -path_group clk -from [all_registers -clock_pins] -to [all_registers -data_pins] -path_delay max -digits 3
report_checks -path_delay min -digits 3
puts "DTOF_RECOVERY"
report_check_types -recovery
puts "DTOF_REMOVAL"
report_check_types -removal
puts "DTOF_TRANSITION"
report_check_types -all_violators -max_transition
puts "DTOF_END"
puts "DTOF_STA_OK"
