# SPDX-License-Identifier: Apache-2.0
# Maps dtof_line_buffer alone to the library; the log has its area.
yosys -import
source $::env(DTOF_SETTINGS)
puts "DTOF_STEP read"
read_verilog -sv -defer -DSYNTHESIS -I$rtl_include {*}$rtl_files
read_liberty -lib -ignore_miss_func $liberty
hierarchy -check -top dtof_line_buffer -chparam ACQUISITION_LINES $acquisition_lines -chparam LINES $lines -chparam WIDTH $width
puts "DTOF_STEP map"
synth -flatten -top dtof_line_buffer
dfflibmap -liberty $liberty
abc -liberty $liberty
opt_clean -purge
select -assert-none t:\$*
puts "DTOF_STEP count"
stat -liberty $liberty
