# SPDX-License-Identifier: Apache-2.0
.PHONY: claims design-judgement detection dynamic-range hostile-scenes host-filter frames leaderboard pool-parts pulse-widths scenes pool pool-search rivals pareto trade real-data walk-error video
SMALL_SCENES := $(if $(SMALL),--klux 14 --columns 8)
SMALL_POOL := $(if $(SMALL),--klux 14 --scene planes --seeds 2)
HOST_FILTER := $(if $(SMALL),--klux 14 --scene planes --columns 8 --seeds 2 --no-goal,--columns 20)
SCENE_MAPS := --disparity $(SHARED_DATA)/middlebury_Art_disp1.png \
  --surface $(SHARED_DATA)/shin2016_two_layer_obj.mat
SCENE_VARIANTS := ezpointer:FRACTION_BITS=4 hispointer:FRACTION_BITS=4 hispointer:COUNT_WIDTH=8 \
  hispointer:COUNT_WIDTH=12 sifh:WINDOW_CENTRED=1 sifh:COUNT_WIDTH=8 sifh:COUNT_WIDTH=12 \
  fifh:COUNT_WIDTH=8 fifh:COUNT_WIDTH=12
# A map is for training or for tests, never for both.
POOL_TRAINING_MAP := $(addprefix --disparity ,$(wildcard $(SHARED_DATA)/middlebury_Laundry_disp1.png))
POOL_NUMBERS := COARSE_SHARE=12,14,16,18 TRACK_SHARE=20,25,30,35,40 OWN_WEIGHT LEAK_SHIFT TRACK_REACH OFFSET_GEAR_0 \
  OFFSET_GEAR_1 LABEL_COST LABEL_COST_SLOPE CHOOSE_PENALTY CHOOSE_PENALTY_SLOPE LEFT_COST LEFT_COST_SLOPE RIGHT_LIMIT \
  RIGHT_LIMIT_SLOPE LATERAL_REACH RIVAL_REACH DECIDE_PENALTY DECIDE_PENALTY_SLOPE SMOOTH_DARK=768,1280 \
  SMOOTH_BRIGHT=1280,2048 SMOOTH_BRIGHT_FROM WEIGHT_0 WEIGHT_1 WEIGHT_5 WEIGHT_6 WEIGHT_7
# Small sensors and short frames: a full sweep of 20 sensors takes some minutes. Without these options it takes more than an hour.
JUDGEMENT := $(if $(SMALL),--sensors 1 --most-columns 20 --most-rows 16 --most-acquisitions 300 --sweep-pixels 500 --final-pixels 500 \
    --final-seeds 2 --finalists 2,--most-columns 48 --most-rows 40 --most-acquisitions 450 --sweep-pixels 2000 --final-pixels 3000 --final-seeds 5 \
    --finalists 5)
RIVAL_COLUMNS ?= $(if $(SMALL),2,16)
RIVAL_OPTIONS := --pooled --claims --seeds $(if $(SMALL),2 --klux 50,4) --columns $(RIVAL_COLUMNS)
PHOTON_TIMES := $(SHARED_DATA)/shin2016_two_layer_photon_times.mat \
  --surfaces $(SHARED_DATA)/shin2016_two_layer_obj.mat --shift -20

# What make real-data has the data of, published together: they are one entry of reports/reports.toml.
TMF8820 := $(SHARED_DATA)/sifferman_tmf8820_distance_data.json
REAL_DATA := $(strip $(if $(wildcard $(TMF8820)),tmf8820_plane) $(if $(wildcard $(SHARED_DATA)/ams_tmf8829_log.json.gz),tmf8829) \
  $(if $(wildcard $(SHARED_DATA)/shin2016_two_layer_photon_times.mat),photon_times photon_times_behind))

# The committed report has the maps, too: without them it stays as it is.
scenes: study-program
	@if [ -f $(SHARED_DATA)/middlebury_Art_disp1.png ]; then \
	  set -e; \
	  scripts/reports.py begin scenes; \
	  $(DTOF_STUDY) scenes --held-out $(SCENE_MAPS) $(SMALL_SCENES) --seed $(SEED) --out $(OUT)/scenes; \
	  $(DTOF_STUDY) scenes --held-out $(SCENE_MAPS) --seed $(SEED) --preset thesis --klux 14 50 --readout fifh \
	    --variant $(SCENE_VARIANTS) --columns $(if $(SMALL),4,25) --out $(OUT)/scenes_variants; \
	  scripts/publish.py scenes; \
	else \
	  echo "depth maps are not here ($(SHARED_DATA)): synthetic scenes only, in build/scenes_synthetic"; \
	  $(DTOF_STUDY) scenes --held-out $(SMALL_SCENES) --seed $(SEED) --out $(OUT)/scenes_synthetic; \
	fi

pool: study-program
	@if [ -f $(SHARED_DATA)/middlebury_Art_disp1.png ]; then \
	  set -e; \
	  scripts/reports.py begin pool; \
	  $(DTOF_STUDY) pool --held-out $(SCENE_MAPS) $(SMALL_POOL) --seed $(SEED) --out $(OUT)/pool; \
	  $(DTOF_STUDY) pool --held-out $(SCENE_MAPS) $(SMALL_POOL) --table none --seed $(SEED) --out $(OUT)/pool_without_table; \
	  scripts/publish.py pool pool_without_table; \
	else \
	  echo "depth maps are not here ($(SHARED_DATA)): synthetic scenes only, in build/pool_synthetic"; \
	  $(DTOF_STUDY) pool --held-out $(SMALL_POOL) --seed $(SEED) --out $(OUT)/pool_synthetic; \
	fi

pool-search: study-program
	@$(DTOF_STUDY) pool-search $(POOL_TRAINING_MAP) --vary $(if $(SMALL),OWN_WEIGHT --scene planes --klux 14,$(POOL_NUMBERS)) --seeds 2 --rounds 2 --out $(OUT)/pool_search

rivals: study-program
	@if [ -f $(SHARED_DATA)/middlebury_Art_disp1.png ]; then \
	  scripts/reports.py begin rivals && \
	  scripts/rivals.py $(DTOF_STUDY) --out $(OUT)/rivals --held-out $(SCENE_MAPS) --photographed $(PHOTOGRAPHED) \
	    $(RIVAL_OPTIONS) --seed $(SEED) && \
	  scripts/publish.py rivals; \
	else \
	  echo "depth maps are not here ($(SHARED_DATA)): synthetic scenes only, in build/rivals_synthetic"; \
	  scripts/rivals.py $(DTOF_STUDY) --out $(OUT)/rivals_synthetic --held-out $(RIVAL_OPTIONS) --seed $(SEED); \
	fi

claims: study-program
	@scripts/reports.py begin claims
	@$(DTOF_STUDY) claims $(if $(SMALL),--pixels 100) --seed $(SEED) --out $(OUT)/claims
	@scripts/publish.py claims

leaderboard: configure
	@ninja -C $(BUILD) dtof_core_module
	@scripts/reports.py begin leaderboard
	@scripts/leaderboard.py $(BUILD)/python --seed $(SEED)
	@scripts/publish.py leaderboard

pareto:
	@scripts/reports.py begin pareto
	@/usr/bin/python3 scripts/pareto.py
	@scripts/reports.py record pareto

trade: study-program
	@scripts/reports.py begin trade
	@/usr/bin/python3 scripts/trade.py $(DTOF_STUDY)
	@scripts/reports.py record trade

dynamic-range: study-program
	@scripts/reports.py begin dynamic_range
	@$(DTOF_STUDY) dynamic-range $(if $(SMALL),--acquisitions 333 3333 33333 --klux 2 14 --signals 1 10 --seeds 2) \
	  --seed $(SEED) --out $(OUT)/dynamic_range
	@scripts/publish.py dynamic_range

hostile-scenes: study-program
	@scripts/reports.py begin hostile_scenes
	@$(DTOF_STUDY) hostile-scenes $(if $(SMALL),--klux 14 --rows 16 --seeds 2) \
	  --seed $(SEED) --out $(OUT)/hostile_scenes
	@scripts/publish.py hostile_scenes

# 20 columns of each map: the matched filters and the histogram are most of the time.
host-filter: study-program
	@if [ -f $(SHARED_DATA)/middlebury_Art_disp1.png ]; then \
	  set -e; \
	  scripts/reports.py begin host_filter; \
	  $(DTOF_STUDY) host-filter --held-out $(SCENE_MAPS) $(HOST_FILTER) --seed $(SEED) --out $(OUT)/host_filter; \
	  scripts/publish.py host_filter; \
	else \
	  echo "depth maps are not here ($(SHARED_DATA)): synthetic scenes only, in build/host_filter_synthetic"; \
	  $(DTOF_STUDY) host-filter --held-out $(HOST_FILTER) --seed $(SEED) --out $(OUT)/host_filter_synthetic; \
	fi

detection: study-program
	@scripts/reports.py begin detection
	@$(DTOF_STUDY) detection $(if $(SMALL),--klux 14 50 --distance 4 --seeds 2) \
	  --seed $(SEED) --out $(OUT)/detection
	@scripts/publish.py detection

design-judgement: study-program
	@scripts/reports.py begin design_judgement
	@$(DTOF_STUDY) design-judgement $(JUDGEMENT) --seed $(SEED) --out $(OUT)/design_judgement
	@scripts/publish.py design_judgement

frames: study-program
	@scripts/reports.py begin frames
	@$(DTOF_STUDY) frames $(if $(SMALL),--sensors thesis --frames 2 --rtl ezpointer,--rtl poolpointer) --seed $(SEED) --out $(OUT)/frames
	@scripts/publish.py frames

walk-error: study-program
	@scripts/reports.py begin walk_error
	@$(DTOF_STUDY) walk $(if $(SMALL),--columns 4 --distances 1 --reflectivities 0.2 1 --acquisitions 333) --seed $(SEED) --out $(OUT)/walk
	@scripts/publish.py walk_error

pool-parts: study-program vectors
	@scripts/reports.py begin pool_parts
	@scripts/pool_parts.py $(DTOF_STUDY) --seed $(SEED)
	@scripts/publish.py pool_parts

pulse-widths: study-program
	@scripts/reports.py begin pulse_widths
	@scripts/pulse_widths.py $(DTOF_STUDY) --seed $(SEED)
	@scripts/publish.py pulse_widths

video: build
	@scripts/reports.py begin video
	@$(DTOF) video $(if $(SMALL),--scene room --motion light --frames 2 --array-columns 20 --array-rows 32,--scene room planes clutter poles --motion still pan roll object cut light --frames 10) -k 50 --seed $(SEED) --seeds $(if $(SMALL),1,4) --out $(OUT)/video
	@scripts/publish.py video

real-data: study-program
	@scripts/reports.py begin real_data
	@if [ -f $(TMF8820) ]; then \
	  $(DTOF_STUDY) measured $(TMF8820) --shift 2 --photons $(if $(SMALL),300,2000 500) \
	    --background $(if $(SMALL),0,0 0.15) --seed $(SEED) --out $(OUT)/tmf8820_plane; \
	else echo "TMF8820 captures are not here ($(SHARED_DATA)): skipped"; fi
	@if [ -f $(SHARED_DATA)/ams_tmf8829_log.json.gz ]; then \
	  $(DTOF_STUDY) measured $(SHARED_DATA)/ams_tmf8829_log.json.gz --photons $(if $(SMALL),300,2000 750 300) \
	    --background $(if $(SMALL),0,0 0.15) --frames $(if $(SMALL),1,4) --seed $(SEED) --out $(OUT)/tmf8829; \
	else echo "TMF8829 frames are not here ($(SHARED_DATA)): skipped"; fi
	@if [ -f $(SHARED_DATA)/shin2016_two_layer_photon_times.mat ]; then \
	  set -e; \
	  $(DTOF_STUDY) measured $(PHOTON_TIMES) --photons $(if $(SMALL),25,0 25) \
	    --background $(if $(SMALL),0,0 0.15) --seed $(SEED) --out $(OUT)/photon_times; \
	  $(DTOF_STUDY) measured $(PHOTON_TIMES) --from-tick 5200 --photons $(if $(SMALL),12,0 12) \
	    --background $(if $(SMALL),0,0 0.15) --seed $(SEED) --out $(OUT)/photon_times_behind; \
	else echo "photon times are not here ($(SHARED_DATA)): skipped"; fi
	@$(if $(REAL_DATA),scripts/publish.py $(REAL_DATA))
