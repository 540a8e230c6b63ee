# SPDX-License-Identifier: Apache-2.0
# make sweep-test    a small sweep through a real Slurm of one node, with killed jobs and a killed workflow (a minute)
# make sweep-cost    what 10^3 to 10^6 points cost beside their own computing: reports/scaling.md (ten minutes)
SWEEP ?= scripts/sweep/$(if $(SMALL),small,readouts).toml
.PHONY: sweep sweep-test sweep-cost
sweep: configure
	@scripts/install_packages.sh sweep
	@ninja -C $(BUILD) dtof dtof-study
	@scripts/sweep/sweep.py $(SWEEP) $(if $(SLURM),--slurm) $(if $(JOBS),--jobs $(JOBS))

sweep-test: configure
	@scripts/install_packages.sh slurm
	@ninja -C $(BUILD) dtof
	@scripts/sweep/slurm_test.py

sweep-cost: build
	@scripts/install_packages.sh slurm
	@scripts/reports.py begin scaling
	@scripts/sweep/cost.py
	@scripts/publish.py scaling
