# SPDX-License-Identifier: Apache-2.0
# make photon-report  speed against error of the photon models, what auto may take (reports/)
# make photon-bench   speed of the photon models beside NumPy
.PHONY: photon-report photon-bench

photon-report: study
	@$(DTOF_STUDY) speed-error --seed $(SEED) --out reports
	@$(DTOF_STUDY) fidelity --seed $(SEED) --out reports

photon-bench: configure
	@ninja -C $(BUILD) photon_bench
	@$(BUILD)/bench/photon_bench --benchmark_out=build/photon_bench.json --benchmark_out_format=json
	@/usr/bin/python3 scripts/photon_baseline.py --seed $(SEED) --bench build/photon_bench.json
