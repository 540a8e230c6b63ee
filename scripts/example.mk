# SPDX-License-Identifier: Apache-2.0
# make example        a frame of dtof_subsystem in a small SystemVerilog bench (hdl/example), with Icarus Verilog
#                     EXAMPLE=poolpointer  of another read-out
EXAMPLE ?= hispointer

.PHONY: example
example: packages | build_folder
	@scripts/example.sh $(EXAMPLE)
