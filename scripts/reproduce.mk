# SPDX-License-Identifier: Apache-2.0
# make reproduce  the thesis's accuracy statements against the models: reports/reproduction.md
.PHONY: reproduce
reproduce: build
	@$(DTOF) reproduce --seed $(SEED) --out build/reproduce
	@scripts/publish.py reproduction
