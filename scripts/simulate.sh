#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The main job: one frame of the room scene through the RTL of every read-out, each pixel compared with the
# model; then the TMF8820 captures where they are present. Pictures and tables go to build/.
set -euo pipefail
dtof=$1
seed=${SEED:-1}
data=${SHARED_DATA:-../shared/data}

"$dtof" frame --scene room --readout all --engine rtl --verify --seed "$seed" --out build/frame

captures=$data/sifferman_tmf8820_distance_data.json
if [ -f "$captures" ]; then
  "$dtof" replay "$captures" --readout all --engine rtl --verify --photons 500 --shift 2 --seed "$seed" \
    --out build/tmf8820
else
  echo "TMF8820 captures are not here ($captures): replay skipped"
fi
