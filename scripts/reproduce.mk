# SPDX-License-Identifier: Apache-2.0
.PHONY: reproduce
reproduce: study-program
	@scripts/reports.py begin reproduction
	@$(DTOF_STUDY) reproduce $(if $(SMALL),--frames 40) --seed $(SEED) --out $(OUT)/reproduce
	@scripts/publish.py reproduction
