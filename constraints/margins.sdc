# SPDX-License-Identifier: Apache-2.0
# Margins of a sign-off, read after dtof.sdc: cells 5 % slower where late paths count and 5 % faster where early paths count, more
# uncertainty, and ports with a real driver and load. The flow sets `slew` (ns), the transition of an inverter with a fan-out of four, and
# `load` (the library's unit), ten inverter inputs.
set margin_uncertainty 0.15

set_clock_uncertainty -setup $margin_uncertainty [get_clocks clk]
set_timing_derate -late 1.05
set_timing_derate -early 0.95
set_input_transition $slew [all_inputs]
set_load $load [all_outputs]
