# SPDX-License-Identifier: Apache-2.0
# Reads the RTL into a Vivado project or a non-project run, with memories that become block RAM:
#
#   source synth/vivado/dtof.tcl
#   dtof_read_rtl                       ;# or: dtof_read_rtl my_srams, for a folder with one's own dtof_sram_1rw.sv, dtof_sram_1r1w.sv and dtof_clock_gate.sv
#   synth_design -top dtof_subsystem -part xc7a35ticsg324-1L -generic READOUT=2 -generic SRAM_NUM=8 -generic PIXELS_PER_SRAM=16 -generic CLOCK_WAITS=0
#
# The files are those of hdl/dtof_no_srams.f, in the same order.

set dtof_hdl [file normalize [file join [file dirname [info script]] .. .. hdl]]

proc dtof_read_rtl {{technology ""}} {
    global dtof_hdl
    if {$technology eq ""} {
        set technology [file join $dtof_hdl technology fpga]
    }
    set files {}
    set list [open [file join $dtof_hdl dtof_no_srams.f]]
    foreach line [split [read $list] "\n"] {
        if {[string match "*.sv" $line] && ![string match "//*" $line]} {
            lappend files [file join $dtof_hdl $line]
        }
    }
    close $list
    foreach module {dtof_sram_1rw dtof_sram_1r1w dtof_clock_gate} {
        set file [file join $technology $module.sv]
        if {![file exists $file]} {
            error "dtof_read_rtl: $file is not there"
        }
        lappend files $file
    }
    read_verilog -sv $files
    set_property include_dirs [list [file join $dtof_hdl common]] [current_fileset]
}
