# SPDX-License-Identifier: Apache-2.0
# make fpga-check     a small dtof_subsystem of every read-out on four FPGA families, by Yosys: block RAMs, look-up tables,
#                     flip-flops in reports/fpga_check.md; fails if a memory does not become block RAM (20 minutes)
#                     FPGA="ezpointer --families ecp5"  some of them (no report)
.PHONY: fpga-check
fpga-check: packages
	@scripts/fpga_check.py $(FPGA)
