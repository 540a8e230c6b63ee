# SPDX-License-Identifier: Apache-2.0
# make layout          columns of ezPointer, hisPointer and poolPointer's pair placed and routed in OSU 0.18 um, design rules
#                      and netlist checked, GDS in build/layout/; reports/layout.md (seven minutes)
#                      CONFIGURATIONS="fifh"  others, build/layout/layout.md
# make orfs            config.mk, constraints, LEF and Liberty of the SRAMs for OpenROAD-flow-scripts, into build/orfs/
#                      CONFIGURATIONS="hispointer" COLUMNS=8  some read-outs, columns of the array
.PHONY: layout orfs
layout:
	@scripts/install_packages.sh layout
	@$(if $(CONFIGURATIONS),,scripts/reports.py begin layout)
	@synth/layout.py $(CONFIGURATIONS)
	@$(if $(CONFIGURATIONS),,scripts/reports.py record layout)

orfs: packages
	@synth/orfs.py $(CONFIGURATIONS) $(if $(COLUMNS),--columns $(COLUMNS))
