# SPDX-License-Identifier: Apache-2.0
# make shuttle        the chips of shuttle/ in IHP's open 130 nm process: netlists, timing in three corners, netlists simulated, inputs for
#                     LibreLane and OpenROAD-flow-scripts, in build/shuttle/; reports/shuttle.md (minutes)
#                     PDK=<folder>  has the PDK's Liberty files, at any depth
.PHONY: shuttle
shuttle: configure
	@scripts/reports.py begin shuttle
	@synth/shuttle.py $(if $(PDK),--pdk $(PDK))
	@ninja -C $(BUILD) shuttle_ezpointer_netlist_test shuttle_poolpointer_lean_netlist_test
	@synth/shuttle.py --report $(BUILD)/bin
	@scripts/reports.py record shuttle
