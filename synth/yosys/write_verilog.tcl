# SPDX-License-Identifier: Apache-2.0
# From a netlist in JSON to plain Verilog for OpenSTA.
yosys -import
source $::env(DTOF_SETTINGS)
read_json $netlist_json
write_verilog -noattr -noexpr -nohex -nodec $netlist
