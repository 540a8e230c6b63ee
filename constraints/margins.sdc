# SPDX-License-Identifier: Apache-2.0
# Margins of a sign-off, read behind dtof.sdc: cells 5 % slower where that hurts and 5 % faster where that does, more
# uncertainty, and ports that are neither driven nor loaded ideally. `slew` (ns) and `load` (the library's unit) are the
# flow's: the edge of an inverter with a fan-out of four, and ten inverters' inputs.
set margin_uncertainty 0.15

set_clock_uncertainty -setup $margin_uncertainty [get_clocks clk]
set_timing_derate -late 1.05
set_timing_derate -early 0.95
set_input_transition $slew [all_inputs]
set_load $load [all_outputs]
