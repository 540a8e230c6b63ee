# SPDX-License-Identifier: Apache-2.0
# Timing constraints of dtof_product: one clock, budgets as shares of its period that the outside uses.
set period @PERIOD@
set port_share 0.30
set reset_share 0.20

create_clock -name clk -period $period [get_ports clk_i]
set_clock_uncertainty -setup 0.10 [get_clocks clk]
set_clock_uncertainty -hold 0.05 [get_clocks clk]

foreach port [all_inputs] {
  if {[get_full_name $port] ne "clk_i"} { set_input_delay [expr {$port_share * $period}] -clock clk $port }
}
set_output_delay [expr {$port_share * $period}] -clock clk [all_outputs]
set_input_delay [expr {$reset_share * $period}] -clock clk [get_ports rst_ni]

# The SRAMs' side band and the scan mode rest while the array works.
set_false_path -from [get_ports {sram_cfg_i* scan_mode_i}]
set_false_path -to [get_ports sram_cfg_o*]
