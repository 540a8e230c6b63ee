# SPDX-License-Identifier: Apache-2.0
# make example        a frame of dtof_subsystem in a small SystemVerilog bench (examples), with Icarus Verilog
#                     EXAMPLE=poolpointer of another read-out
# make timing-diagrams  the diagrams and the clocks of a frame in docs/user, from simulations (scripts/timing_diagrams.py)
EXAMPLE ?= hispointer

.PHONY: example timing-diagrams
example: packages | build_folder
	@scripts/example.sh $(EXAMPLE)

timing-diagrams: packages
	@scripts/timing_diagrams.py
