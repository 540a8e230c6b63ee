# SPDX-License-Identifier: Apache-2.0
# Timing constraints of the crossing in dtof_async_line_fifo (docs/user/subsystem.md, TDCs of another clock). Read this file after the
# constraints that create both clocks. Set before:
#
#   tdc_clock, tdc_period     name and period (ns) of the TDCs' clock
#   read_clock, read_period   name and period of the read-out's clock, clk_i
#   fifo_memory               pattern of the cells of the FIFO's memory, for example u_fifo/memory*
#
# The two clocks must not be in different groups of set_clock_groups, and no false path may lie between them: both would remove these limits.
# Vivado and Quartus: use -datapath_only in place of -ignore_clock_latency. Design Compiler and PrimeTime: remove the option.
#
# A pointer in Gray code is right if its bits arrive within one period of its own clock, and the handshake of the two sides if its bits
# arrive within one period of the clock that takes them. The shorter period serves both.
set crossing_limit [expr {min($tdc_period, $read_period)}]
set_max_delay -ignore_clock_latency $crossing_limit -from [get_clocks $tdc_clock] -to [get_clocks $read_clock]
set_max_delay -ignore_clock_latency $crossing_limit -from [get_clocks $read_clock] -to [get_clocks $tdc_clock]

# A line is in the memory a clock before its pointer leaves, and stays until it is taken. Its way to the read-out has a whole period.
set_max_delay -ignore_clock_latency $read_period -from [get_cells $fifo_memory] -to [get_clocks $read_clock]

# There is no hold between the two clocks: the synchronisers take a bit before or after its change.
set_false_path -hold -from [get_clocks $tdc_clock] -to [get_clocks $read_clock]
set_false_path -hold -from [get_clocks $read_clock] -to [get_clocks $tdc_clock]
