# SPDX-License-Identifier: Apache-2.0
# make scenes     read-outs on scenes, those held out from every choice of parameters included (ten minutes)
# make pareto     area against accuracy, and the goals: from the reports of make synth and make scenes
# make trade      poolPointer's goals that collide, as curves (areas: make synth-growth; two minutes)
# make real-data  read-outs on measured data
# make walk-error bias over reflectivity, and what the host corrects by confidence (one minute)
.PHONY: scenes pareto trade real-data walk-error
SCENE_MAPS := --disparity $(SHARED_DATA)/middlebury_Art_disp1.png \
  --surface $(SHARED_DATA)/shin2016_two_layer_obj.mat
SCENE_VARIANTS := ezpointer:FRACTION_BITS=4 hispointer:FRACTION_BITS=4 hispointer:COUNT_WIDTH=8 \
  hispointer:COUNT_WIDTH=12 sifh:WINDOW_CENTRED=1 sifh:COUNT_WIDTH=8 sifh:COUNT_WIDTH=12 \
  fifh:COUNT_WIDTH=8 fifh:COUNT_WIDTH=12
PHOTON_TIMES := $(SHARED_DATA)/shin2016_two_layer_photon_times.mat \
  --surfaces $(SHARED_DATA)/shin2016_two_layer_obj.mat --shift -20

# The committed report has the maps, too: without them it stays as it is.
scenes: study
	@if [ -f $(SHARED_DATA)/middlebury_Art_disp1.png ]; then \
	  set -e; \
	  $(DTOF_STUDY) scenes --held-out $(SCENE_MAPS) --seed $(SEED) --out build/scenes; \
	  $(DTOF_STUDY) scenes --held-out $(SCENE_MAPS) --seed $(SEED) --preset thesis --klux 14 50 --readout fifh \
	    --variant $(SCENE_VARIANTS) --columns 25 --out build/scenes_variants; \
	  scripts/publish.py scenes; \
	else \
	  echo "depth maps are not here ($(SHARED_DATA)): synthetic scenes only, in build/scenes_synthetic"; \
	  $(DTOF_STUDY) scenes --held-out --seed $(SEED) --out build/scenes_synthetic; \
	fi

pareto:
	@/usr/bin/python3 scripts/pareto.py

trade: study
	@/usr/bin/python3 scripts/trade.py $(DTOF_STUDY)

walk-error: study
	@$(DTOF_STUDY) walk --seed $(SEED) --out build/walk
	@scripts/publish.py walk_error

real-data: study
	@if [ -f $(SHARED_DATA)/ams_tmf8829_log.json.gz ]; then \
	  $(DTOF_STUDY) measured $(SHARED_DATA)/ams_tmf8829_log.json.gz --photons 2000 750 300 \
	    --background 0 0.15 --frames 4 --seed $(SEED) --out build/tmf8829 && scripts/publish.py tmf8829; \
	else echo "TMF8829 frames are not here ($(SHARED_DATA)): skipped"; fi
	@if [ -f $(SHARED_DATA)/shin2016_two_layer_photon_times.mat ]; then \
	  set -e; \
	  $(DTOF_STUDY) measured $(PHOTON_TIMES) --photons 0 25 \
	    --background 0 0.15 --seed $(SEED) --out build/photon_times; \
	  $(DTOF_STUDY) measured $(PHOTON_TIMES) --from-tick 5200 --photons 0 12 \
	    --background 0 0.15 --seed $(SEED) --out build/photon_times_behind; \
	  scripts/publish.py photon_times photon_times_behind; \
	else echo "photon times are not here ($(SHARED_DATA)): skipped"; fi
