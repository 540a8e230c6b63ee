# SPDX-License-Identifier: Apache-2.0
# Netlist in JSON to the plain Verilog that OpenSTA reads.
yosys -import
source $::env(DTOF_SETTINGS)
read_json $netlist_json
write_verilog -noattr -noexpr -nohex -nodec $netlist
