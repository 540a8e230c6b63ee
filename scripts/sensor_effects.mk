# SPDX-License-Identifier: Apache-2.0
.PHONY: sensor-effects
sensor-effects: study-program
	@scripts/reports.py begin sensor_effects
	@scripts/sensor_effects.sh $(DTOF_STUDY) $(SHARED_DATA) $(SEED)
