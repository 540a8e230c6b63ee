# SPDX-License-Identifier: Apache-2.0
# Reads the RTL with the SRAM macros as black boxes, and elaborates the array with the parameters of the configuration.
read_verilog -sv -defer -DSYNTHESIS -I$rtl_include {*}$rtl_files
read_verilog -sv -defer {*}$technology_files
read_verilog $black_boxes
read_liberty -lib -ignore_miss_func $liberty
set chparam {}
foreach {name value} $parameters { lappend chparam -chparam $name $value }
hierarchy -check -top $top {*}$chparam
