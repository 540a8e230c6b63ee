# SPDX-License-Identifier: Apache-2.0
.PHONY: photon-report photon-bench

photon-report: study-program
	@scripts/reports.py begin photon_models
	@$(DTOF_STUDY) speed-error $(if $(SMALL),--frames 200) --seed $(SEED) --out $(OUT)/photon_models
	@$(DTOF_STUDY) fidelity $(if $(SMALL),--frames 1) --seed $(SEED) --out $(OUT)/photon_models
	@scripts/publish.py speed_error fidelity

photon-bench: configure
	@ninja -C $(BUILD) photon_bench
	@scripts/reports.py begin photon_speed
	@$(BUILD)/bin/photon_bench $(if $(SMALL),--small) --benchmark_filter='plane/(threads|hispointer)' --benchmark_out=build/photon_bench.json \
	  --benchmark_out_format=json
	@scripts/photon_baseline.py build/photon_bench.json $(REPORTS)/photon_speed.md $(if $(SMALL),--pixels 50) --seed $(SEED)
	@scripts/reports.py record photon_speed
