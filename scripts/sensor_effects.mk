# SPDX-License-Identifier: Apache-2.0
# make sensor-effects  what measured TDC code widths, a measured pulse, dead time and hot pixels do to each read-out
#                      (sensor files: studies/sensor_effects/; those whose data are absent are skipped)
.PHONY: sensor-effects
sensor-effects: study-program
	@scripts/reports.py begin sensor_effects
	@scripts/sensor_effects.sh $(DTOF_STUDY) $(SHARED_DATA) $(SEED)
