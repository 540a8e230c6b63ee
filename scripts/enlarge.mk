# SPDX-License-Identifier: Apache-2.0
# make train-enlarger  the learned enlarger's weights, trained by dlib on random shapes (ten minutes): build/weights.txt. The
#                      project's are those, as studies/small_arrays/models/weights.txt, and every build has them: only this needs dlib.
.PHONY: enlarge train-enlarger
# Laundry is for training (scripts/study.mk), thus not for tests.
SMALL_ENLARGE := $(if $(SMALL),--klux 14 --scene room --array 50x40 --picture-array 50x40 --seeds 2)
COMMA := ,
PHOTOGRAPHED := $(foreach map,Art Moebius,\
  $(map)=$(SHARED_DATA)/middlebury_$(map)_disp1.png$(COMMA)$(SHARED_DATA)/middlebury_$(map)_view1.png)

# The committed report has the photographed maps, too: without them it stays as it is.
enlarge: study-program
	@if [ -f $(SHARED_DATA)/middlebury_Moebius_view1.png ]; then \
	  scripts/reports.py begin enlarge && \
	  $(DTOF_STUDY) enlarge $(SMALL_ENLARGE) --photographed $(PHOTOGRAPHED) --seed $(SEED) --out $(OUT)/enlarge && scripts/publish.py enlarge; \
	else \
	  echo "photographed maps are not here ($(SHARED_DATA)): synthetic scenes only, in build/enlarge_synthetic"; \
	  $(DTOF_STUDY) enlarge $(SMALL_ENLARGE) --seed $(SEED) --out $(OUT)/enlarge_synthetic; \
	fi

train-enlarger: configure
	@scripts/install_packages.sh learning
	@cmake -S . --preset release > $(BUILD).log 2>&1 || { cat $(BUILD).log; exit 1; }
	@ninja -C $(BUILD) train-enlarger
	@$(BUILD)/bin/train-enlarger --out $(OUT)/weights.txt
