# SPDX-License-Identifier: Apache-2.0
# make wave  waveform (FST) of 20 acquisitions of the RTL of READOUT (hispointer): build/wave/
READOUT ?= hispointer
.PHONY: wave
wave: configure
	@ninja -C $(BUILD) dtof-wave
	@$(BUILD)/app/dtof-wave frame --readout $(READOUT) --engine rtl --columns $(if $(findstring pool,$(READOUT)),0-9,0) \
	  --acquisitions 20 --seed $(SEED) --trace build/wave/$(READOUT).fst --out build/wave
