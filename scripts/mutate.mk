# SPDX-License-Identifier: Apache-2.0
# make mutate     small changes of RTL, C++ models and synthesis flow, and which of them the tests notice (long): reports/mutants.md
#                 SEED=2 other mutants; COUNT=50 so many of each language (of synthesis, of each file)
.PHONY: mutate
mutate: vectors
	@scripts/reports.py begin mutants
	@scripts/mutate.py --seed $(SEED) $(if $(COUNT),--count $(COUNT)); status=$$?; \
	if [ $$status -le 1 ]; then scripts/reports.py record mutants || exit; fi; exit $$status  # 1: with a report that says why
