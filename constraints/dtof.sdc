# SPDX-License-Identifier: Apache-2.0
# Timing constraints of dtof_array and dtof_pool_pointer_array. The flow sets `period` (ns) and reads this file again for each period.
#
# Ports: each budget is the share of the clock period that logic outside the array uses. The TDC's timestamps and the
# result stream come from and go to registers; the handshakes have some logic outside.
set setup_uncertainty 0.10
set hold_uncertainty 0.05
set tdc_share 0.30
set control_share 0.30
set stream_share 0.30
set reset_share 0.20
set edge_share 0.15

create_clock -name clk -period $period [get_ports clk_i]
set_clock_uncertainty -setup $setup_uncertainty [get_clocks clk]
set_clock_uncertainty -hold $hold_uncertainty [get_clocks clk]

# Every port except the clock has the budget of the control ports, whatever its name; ports with another budget follow.
foreach port [all_inputs] {
  if {[get_full_name $port] ne "clk_i"} { set_input_delay [expr {$control_share * $period}] -clock clk $port }
}
set_output_delay [expr {$control_share * $period}] -clock clk [all_outputs]

set_input_delay [expr {$tdc_share * $period}] -clock clk [get_ports {tdc_valid_i tdc_timestamp_i*}]
set_output_delay [expr {$tdc_share * $period}] -clock clk [get_ports tdc_ready_o]
set_input_delay [expr {$stream_share * $period}] -clock clk [get_ports result_tready_i]
set_output_delay [expr {$stream_share * $period}] -clock clk [get_ports {result_tvalid_o result_tdata_o* result_tlast_o}]

# The reset comes from dtof_reset_synchroniser: a flip-flop and a multiplexer delay its release after the clock's edge.
set_input_delay [expr {$reset_share * $period}] -clock clk [get_ports rst_ni]

# No transition may be slower.
set_max_transition [expr {$edge_share * $period}] [current_design]

# Exceptions. The side band of the SRAMs is constant while the array works, so no path begins or ends there.
set_false_path -from [get_ports sram_cfg_i*]
set_false_path -to [get_ports sram_cfg_o*]
