# SPDX-License-Identifier: Apache-2.0
# make layout          columns of ezPointer, hisPointer and poolPointer placed and routed in OSU 0.18 um, design rules and
#                      netlist checked, GDS in build/layout/; reports/layout.md (fifteen minutes on two cores)
#                      CONFIGURATIONS="poolpointer2"  others, build/layout/layout.md
.PHONY: layout
layout:
	@scripts/install_packages.sh layout
	@synth/layout.py $(CONFIGURATIONS)
