# SPDX-License-Identifier: Apache-2.0
# make coverage-study  whether the confidence intervals hold over 40 seeds: reports/coverage_study.md (minutes)
.PHONY: coverage-study
coverage-study: study
	@$(DTOF_STUDY) coverage --seed $(SEED) --out reports
	@$(DTOF_STUDY) coverage --seed $(SEED) --readout poolpointer,poolpointer-lean --klux 50 --distances 3 \
	  --frames 100 200 --other-calibrations 0 --name coverage_study_pool --out reports
