# SPDX-License-Identifier: Apache-2.0
# make fpga-check     a small dtof_subsystem of every read-out on four FPGA families, and arrays of 32 x 32 and 64 x 64 pixels on two, by Yosys:
#                     block RAMs, look-up tables, flip-flops in reports/fpga_check.md; fails if a memory does not become block RAM (40 minutes)
#                     FPGA="ezpointer --families ecp5"  some of them (no report)
# make fpga           the demonstrator of fpga for an iCE40 HX8K with hisPointer and with poolPointer lean, from RTL to the
#                     bitstreams in build/fpga/; their netlists simulated, depths compared with the models'; reports/fpga.md (minutes)
.PHONY: fpga-check fpga
fpga-check: packages
	@$(if $(FPGA),,scripts/reports.py begin fpga_check)
	@scripts/fpga_check.py $(FPGA)
	@$(if $(FPGA),,scripts/reports.py record fpga_check)

fpga: configure
	@scripts/install_packages.sh fpga
	@scripts/reports.py begin fpga
	@scripts/fpga.py
	@ninja -C $(BUILD) demonstrator_netlist_test demonstrator_pool_netlist_test
	@scripts/fpga.py --report $(BUILD)/bin
	@scripts/reports.py record fpga
