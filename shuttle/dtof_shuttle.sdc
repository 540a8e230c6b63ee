# SPDX-License-Identifier: Apache-2.0
# Timing constraints of dtof_shuttle, for this project's flow, LibreLane and OpenROAD-flow-scripts.
# 48 MHz; times in ns.
set period 20.833

create_clock -name clk -period $period [get_ports clk_i]
set_clock_uncertainty -setup 0.25 [get_clocks clk]
set_clock_uncertainty -hold 0.10 [get_clocks clk]

# The reset may change at any time: two flip-flops synchronise its end. So may the serial line, which two flip-flops synchronise, too; its
# path is timed all the same, so that it stays short.
set_input_delay [expr {0.3 * $period}] -clock clk [get_ports {rst_ni rx_i}]
set_false_path -from [get_ports rst_ni]
set_output_delay [expr {0.3 * $period}] -clock clk [all_outputs]

set_max_transition 2.5 [current_design]
