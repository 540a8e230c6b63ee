# SPDX-License-Identifier: Apache-2.0
# make coverage   lines and toggles of hdl/, lines and branches of tb_cpp/ that the tests reach (a build of its own)
# make faults     what flipped bits, stuck columns, hot and dead pixels and resets do to a frame
.PHONY: coverage faults
FLIPS ?= 300

coverage: | build_folder
	@$(MAKE) --no-print-directory packages
	@scripts/coverage.sh

faults: configure
	@ninja -C $(BUILD) dtof-faults
	@$(BUILD)/faults/dtof-faults --flips $(FLIPS) --seed $(SEED) --out build/faults
	@scripts/publish.py faults
