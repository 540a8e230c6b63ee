# SPDX-License-Identifier: Apache-2.0
# make wave  waveform (FST) of 20 acquisitions of the RTL of READOUT (hispointer) and GTKWave's groups of it: build/wave/
# make full  build/cpp/bin/dtof-full, which is dtof with subsystems, too (a minute to compile)
READOUT ?= hispointer
.PHONY: wave full
WAVE_POOL := $(findstring pool,$(READOUT))
DTOF_WAVE := dtof-wave$(if $(WAVE_POOL),-pool)
wave: configure
	@scripts/install_packages.sh wave
	@ninja -C $(BUILD) $(DTOF_WAVE)
	@$(BUILD)/bin/$(DTOF_WAVE) frame --readout $(READOUT) --engine rtl --columns $(if $(WAVE_POOL),0-9,0) \
	  --acquisitions 20 --seed $(SEED) --trace build/wave/$(READOUT).fst --out build/wave
	@scripts/wave_groups.py build/wave/$(READOUT).fst

full: configure
	@ninja -C $(BUILD) dtof-full
	@echo "$(BUILD)/bin/dtof-full frame --readout hispointer --engine subsystem --verify --columns 0-7"
