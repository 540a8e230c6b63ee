# SPDX-License-Identifier: Apache-2.0
# Reads a routed DEF into Magic; writes the extracted netlist, design rule errors and GDS. Runs without a display; prints DTOF_MAGIC_OK
# only if every step succeeded. DTOF_NAME: the block; DTOF_LEF: the cells. Boxes are in lambda, tenths of a micrometre.
proc run {} {
  set name $::env(DTOF_NAME)
  drc off
  snap int
  lef read $::env(DTOF_LEF)
  def read $name
  load $name
  select top cell
  expand
  extract all
  ext2spice hierarchy on
  ext2spice format ngspice
  ext2spice scale off
  ext2spice renumber off
  ext2spice cthresh infinite
  ext2spice rthresh infinite
  ext2spice blackbox on
  ext2spice subcircuit top auto
  ext2spice global off
  ext2spice
  drc on
  drc check
  drc catchup
  puts "DTOF_DRC [drc list count total]"
  foreach {why boxes} [drc listall why] {
    foreach box $boxes { puts "DTOF_BOX $box $why" }
  }
  gds write $name
}
if {[catch run message]} {
  puts "DTOF_MAGIC_FAILED $message"
} else {
  puts "DTOF_MAGIC_OK"
}
quit -noprompt
