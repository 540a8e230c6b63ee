# SPDX-License-Identifier: Apache-2.0
# make wave  waveform (FST) of 20 acquisitions of the RTL of READOUT (hispointer): build/wave/
# make pool2-rtl  build/cpp/app/dtof-pool2, which is dtof with the arrays of poolPointer 2, too (a minute to compile)
READOUT ?= hispointer
WAVE_PROGRAM := $(if $(filter poolpointer2,$(READOUT)),dtof-pool2,dtof-wave)
.PHONY: wave pool2-rtl
wave: configure
	@ninja -C $(BUILD) $(WAVE_PROGRAM)
	@$(BUILD)/app/$(WAVE_PROGRAM) frame --readout $(READOUT) --engine rtl --columns $(if $(findstring pool,$(READOUT)),0-9,0) \
	  --acquisitions 20 --seed $(SEED) --trace build/wave/$(READOUT).fst --out build/wave

pool2-rtl: configure
	@ninja -C $(BUILD) dtof-pool2
	@echo "$(BUILD)/app/dtof-pool2 frame --readout poolpointer2 --engine rtl --verify"
