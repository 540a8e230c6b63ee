# SPDX-License-Identifier: Apache-2.0
# make random-configurations  N arrays of legal parameters that are drawn, each built and compared with its model: build/random_configurations
#                             SEED=7 N=30 FIRST=0 NETLISTS="drawn_3 drawn_9": these as netlists, too (minutes each); NETLISTS=all: all of them
# make random-subsystems      N subsystems of drawn parameters, each built and run through the tests of subsystems: build/random_subsystems
N ?= $(if $(filter random-subsystems,$(MAKECMDGOALS)),12,30)
FIRST ?= 0
.PHONY: random-configurations
random-configurations: configure
	@ninja -C $(BUILD) dtof-random $(if $(NETLISTS),dtof-vectors)
	@DTOF_CACHE=$(CURDIR)/build/random_configurations/cache $(BUILD)/bin/dtof-random --seed $(SEED) --count $(N) --first $(FIRST)
	@$(if $(NETLISTS),synth/synth.py --configurations build/random_configurations/configurations.toml sim-netlist --seed $(SEED) $(filter-out all,$(NETLISTS)))

SUBSYSTEMS := build/random_subsystems
.PHONY: random-subsystems
random-subsystems:
	@mkdir -p $(SUBSYSTEMS)
	@scripts/draw_subsystems.py --seed $(SEED) --count $(N) > $(SUBSYSTEMS)/models.cmake.new
	@mv $(SUBSYSTEMS)/models.cmake.new $(SUBSYSTEMS)/models.cmake
	@cmake --preset release -B $(SUBSYSTEMS)/cpp -DDTOF_SUBSYSTEM_MODELS=$(CURDIR)/$(SUBSYSTEMS)/models.cmake > $(SUBSYSTEMS)/cmake.log || { cat $(SUBSYSTEMS)/cmake.log; exit 1; }
	@ninja -C $(SUBSYSTEMS)/cpp subsystem_test
	@$(SUBSYSTEMS)/cpp/bin/subsystem_test --gtest_filter=-DriverExample*:GoogleTestVerification* --gtest_brief=1
	@echo "$(N) subsystems drawn with seed $(SEED): all tests pass."
