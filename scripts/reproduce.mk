# SPDX-License-Identifier: Apache-2.0
# make reproduce  the thesis's accuracy statements against the models: reports/reproduction.md
.PHONY: reproduce
reproduce: study
	@scripts/reports.py begin reproduction
	@$(DTOF_STUDY) reproduce --seed $(SEED) --out build/reproduce
	@scripts/publish.py reproduction
