#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The main job: one frame of the room scene through the RTL of every read-out, each pixel compared with the
# model; then the TMF8820 captures where they are present. Pictures and tables go to reports/.
set -euo pipefail
dtof=$1
seed=${SEED:-1}
data=${SHARED_DATA:-../shared/data}

publish() { # folder of a run, name under reports/
  mkdir -p "reports/$2"
  cp "$1"/summary.md "$1"/summary.csv "reports/$2/"
  for picture in overview.png error.svg; do
    if [ -f "$1/$picture" ]; then cp "$1/$picture" "reports/$2/"; fi
  done
}

"$dtof" frame --scene room --readout all --engine rtl --verify --seed "$seed" --out build/frame
publish build/frame frame

captures=$data/sifferman_tmf8820_distance_data.json
if [ -f "$captures" ]; then
  "$dtof" replay "$captures" --readout all --engine rtl --verify --photons 500 --shift 2 --seed "$seed" \
    --out build/tmf8820
  publish build/tmf8820 tmf8820
else
  echo "TMF8820 captures are not here ($captures): replay skipped"
fi
