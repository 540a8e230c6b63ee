# SPDX-License-Identifier: Apache-2.0
# Timing constraints of dtof_subsystem. The flow sets `period` (ns) and reads this file again for each period; margins.sdc follows for a
# sign-off.
#
# One clock: dtof_clock_gate suppresses edges of clk_i and divides nothing, so the array's clock is clk_i behind a gate. A tool that
# balances the clock tree gives both the same arrival. Budgets: the share of the period that logic outside the subsystem uses.
set setup_uncertainty 0.10
set hold_uncertainty 0.05
set port_share 0.30
set reset_share 0.20
set edge_share 0.15

create_clock -name clk -period $period [get_ports clk_i]
set_clock_uncertainty -setup $setup_uncertainty [get_clocks clk]
set_clock_uncertainty -hold $hold_uncertainty [get_clocks clk]

# APB, both streams, the interrupt and the shot come from registers and go to registers.
foreach port [all_inputs] {
  if {[get_full_name $port] ne "clk_i"} { set_input_delay [expr {$port_share * $period}] -clock clk $port }
}
set_output_delay [expr {$port_share * $period}] -clock clk [all_outputs]

# The reset comes from dtof_reset_synchroniser: a flip-flop and a multiplexer delay its release after the clock's edge.
set_input_delay [expr {$reset_share * $period}] -clock clk [get_ports rst_ni]

# No transition may be slower.
set_max_transition [expr {$edge_share * $period}] [current_design]

# Exceptions. The side band of the SRAMs is constant while the array works, so no path begins or ends there.
set_false_path -from [get_ports sram_cfg_i*]
set_false_path -to [get_ports sram_cfg_o*]

# When rst_ni rises, the flip-flop of dtof_array_reset still keeps the array in reset. So no release comes from rst_ni itself. After the release the
# array's clock is stopped for three clocks: the release has four periods. The last edge before the clock stops is that of the release.
set_false_path -from [get_ports rst_ni] -through [get_pins u_array_reset/array_rst_no]
set_multicycle_path 4 -setup -through [get_pins u_array_reset/array_rst_no]
set_multicycle_path 3 -hold -through [get_pins u_array_reset/array_rst_no]

# The scan mode is constant while the subsystem works.
set_false_path -from [get_ports scan_mode_i]
