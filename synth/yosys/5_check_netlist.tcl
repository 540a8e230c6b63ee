# SPDX-License-Identifier: Apache-2.0
# Checks for what a netlist must not contain: unmapped cells, undriven nets, multiple drivers, combinational loops.
select -assert-none t:\$* t:\$paramod* %d
check -assert -mapped
