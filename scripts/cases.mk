# SPDX-License-Identifier: Apache-2.0
# make cases          every case that outsiders reported: files, commands, chips and projects of others (scripts/cases.py)
#                     CASES=../shared/cases  their folder; QUICK=1: without those that configure or build
CASES ?= ../shared/cases
.PHONY: cases
cases: build
	@ninja -C $(BUILD) dtof_models
	@scripts/cases.py $(CASES) $(if $(QUICK)$(SMALL),--quick)
