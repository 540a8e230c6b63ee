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
SCENE_PICTURES := clutter_14klux_thesis.png disparity_map_50klux_thesis.png room_50klux_thesis.png \
  held_disparity_map_50klux_thesis.png confidence_50klux_thesis.svg confidence_14klux_thesis.svg
PHOTON_TIMES := $(SHARED_DATA)/shin2016_two_layer_photon_times.mat \
  --surfaces $(SHARED_DATA)/shin2016_two_layer_obj.mat --shift -20

scenes: build
	@if [ -f $(SHARED_DATA)/middlebury_Art_disp1.png ]; then \
	  set -e; \
	  $(DTOF) scenes --held-out $(SCENE_MAPS) --seed $(SEED) --out build/scenes; \
	  $(DTOF) scenes --held-out $(SCENE_MAPS) --seed $(SEED) --preset thesis --klux 14 50 --readout fifh \
	    --variant $(SCENE_VARIANTS) --columns 25 --out build/scenes_variants; \
	  mkdir -p reports/scenes; \
	  cp build/scenes/scenes.md build/scenes/scenes.csv reports/; \
	  cp $(addprefix build/scenes/,$(SCENE_PICTURES)) reports/scenes/; \
	  cp build/scenes_variants/scenes.csv reports/scenes_variants.csv; \
	else echo "depth maps are not here ($(SHARED_DATA)): the scene study is skipped"; fi

pareto:
	@/usr/bin/python3 scripts/pareto.py

trade: build
	@/usr/bin/python3 scripts/trade.py $(DTOF)

walk-error: build
	@$(DTOF) walk --seed $(SEED) --out build/walk
	@cp build/walk/walk_error.md build/walk/walk_error.csv build/walk/walk_error.svg reports/

real-data: build
	@if [ -f $(SHARED_DATA)/ams_tmf8829_log.json.gz ]; then \
	  set -e; \
	  $(DTOF) measured $(SHARED_DATA)/ams_tmf8829_log.json.gz --photons 2000 750 300 \
	    --background 0 0.15 --frames 4 --seed $(SEED) --out build/tmf8829; \
	  $(DTOF) measured $(PHOTON_TIMES) --photons 0 25 \
	    --background 0 0.15 --seed $(SEED) --out build/photon_times; \
	  $(DTOF) measured $(PHOTON_TIMES) --from-tick 5200 --photons 0 12 \
	    --background 0 0.15 --seed $(SEED) --out build/photon_times_behind; \
	  for run in tmf8829 photon_times photon_times_behind; do \
	    mkdir -p reports/$$run; \
	    cp build/$$run/summary.md build/$$run/summary.csv build/$$run/depth.png build/$$run/error.png reports/$$run/; \
	  done; \
	else echo "measured data are not here ($(SHARED_DATA)): make real-data is skipped"; fi
