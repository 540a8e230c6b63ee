# SPDX-License-Identifier: Apache-2.0
# It fails where an interval does not hold, after all three reports are written.
.PHONY: coverage-study
coverage-study: study-program
	@scripts/reports.py begin coverage_study
	@all_hold=true; \
	$(DTOF_STUDY) coverage --readout thesis --frames $(if $(SMALL),100 --seeds 8 --klux 14 --distances 1,100 1000) --seed $(SEED) --out $(OUT)/coverage_study || all_hold=false; \
	$(DTOF_STUDY) coverage --readout thesis --klux 14 50 --distances 1 4 --frames $(if $(SMALL),1000 --seeds 4,10000) --other-calibrations 0 --seed $(SEED) \
	  --name coverage_study_long --out $(OUT)/coverage_study || all_hold=false; \
	$(DTOF_STUDY) coverage --readout poolpointer,poolpointer-lean --klux 50 --distances 3 --frames $(if $(SMALL),100 --seeds 4,100 200) \
	  --other-calibrations 0 --seed $(SEED) --name coverage_study_pool --out $(OUT)/coverage_study || all_hold=false; \
	scripts/publish.py coverage_study coverage_study_long coverage_study_pool && $$all_hold
