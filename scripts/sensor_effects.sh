#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The sensor files of studies/sensor_effects/ against the preset thesis: reports/sensor_effects.md. poolPointer takes hours:
# an independent pixel of it takes a whole column (`dtof-study sensor-effects FILE -r poolpointer`).
# Data that a sensor file names is looked for beside it, so both are linked into one folder.
set -euo pipefail
dtof=$1
data=$(realpath -m "$2")
seed=$3
folder=build/sensor_effects
small=()
if [ -n "${SMALL:-}" ]; then
  folder=build/small/$folder
  small=(--frames 4 --klux 14 --distances 1.03)
fi
rm -rf "$folder"
mkdir -p "$folder"
sensors=()
complete=yes
for name in tdc_shared tdc_per_pixel pulse_measured pulse_stretched dead_time hot_pixels; do
  cp "studies/sensor_effects/$name.toml" "$folder/"
  file=$(sed -n 's/^[a-z_]*_file = "\(.*\)"$/\1/p' "$folder/$name.toml")
  if [ -n "$file" ]; then
    if [ ! -f "$data/$file" ]; then
      echo "sensor-effects: $data/$file is not here: $name is skipped"
      complete=no
      continue
    fi
    ln -sf "$data/$file" "$folder/$file"
  fi
  sensors+=("$folder/$name.toml")
done
"$dtof" sensor-effects "${sensors[@]}" -r thesis "${small[@]}" --seed "$seed" --out "$folder"
if [ "$complete" = yes ]; then
  scripts/publish.py sensor_effects
else
  echo "sensor-effects: reports/ keeps the report of all sensors; this one is in $folder"
fi
