# SPDX-License-Identifier: Apache-2.0
# make coverage   lines and toggles of hdl/, lines and branches of the C++ that the tests reach (a build of its own)
.PHONY: coverage faults fault-metrics
FLIPS ?= $(if $(SMALL),3,300)

coverage: | build_folder
	@$(MAKE) --no-print-directory packages
	@scripts/install_packages.sh coverage
	@scripts/reports.py begin coverage
	@scripts/coverage.sh
	@scripts/reports.py record coverage

faults: configure
	@ninja -C $(BUILD) dtof-faults
	@scripts/reports.py begin faults
	@$(BUILD)/bin/dtof-faults --flips $(FLIPS) --seed $(SEED) --out $(OUT)/faults
	@scripts/publish.py faults

fault-metrics: configure
	@ninja -C $(BUILD) dtof-fault-metrics
	@scripts/reports.py begin fault_metrics
	@scripts/fault_netlists.py $(OUT)/fault_metrics/netlists
	@$(BUILD)/bin/dtof-fault-metrics --netlists $(OUT)/fault_metrics/netlists $(if $(SMALL),--faults 20 --acquisitions 100) \
	  --seed $(SEED) --out $(OUT)/fault_metrics
	@scripts/publish.py fault_metrics
