# SPDX-License-Identifier: Apache-2.0
# make coverage   lines and toggles of hdl/, lines and branches of the C++ that the tests reach (a build of its own)
.PHONY: coverage faults
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
