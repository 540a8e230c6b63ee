# SPDX-License-Identifier: Apache-2.0
# make random-configurations  N arrays of legal parameters that are drawn, each built and compared with its model: build/random_configurations
#                             SEED=7 N=30 FIRST=0 NETLISTS="drawn_3 drawn_9": these as netlists, too (minutes each); NETLISTS=all: all of them
N ?= 30
FIRST ?= 0
.PHONY: random-configurations
random-configurations: configure
	@ninja -C $(BUILD) dtof-random $(if $(NETLISTS),dtof-vectors)
	@DTOF_CACHE=$(CURDIR)/build/random_configurations/cache $(BUILD)/bin/dtof-random --seed $(SEED) --count $(N) --first $(FIRST)
	@$(if $(NETLISTS),synth/synth.py --configurations build/random_configurations/configurations.toml sim-netlist --seed $(SEED) $(filter-out all,$(NETLISTS)))
