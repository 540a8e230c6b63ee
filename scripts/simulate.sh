#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The main job: one frame of the room scene through the RTL of every read-out, each pixel compared with the
# model; then the TMF8820 captures where they are present. Pictures and tables go to build/.
set -euo pipefail
export DTOF_CACHE=off  # the RTL that the program is shipped with, and no more
dtof=$1
seed=${SEED:-1}
data=${SHARED_DATA:-../shared/data}
out=build
small=()
if [ -n "${SMALL:-}" ]; then
  out=build/small/build
  small=(--columns 0-9 --rows 0-19 --acquisitions 333)
fi

# Runs dtof unless it has filled the folder with the same program, arguments and files before.
run_once() { # folder below build/, arguments
  local folder=$out/$1 inputs=("$dtof") key argument
  shift
  for argument in "$@"; do
    if [ -f "$argument" ]; then inputs+=("$argument"); fi
  done
  scripts/reports.py begin "${folder#"$out/"}"
  key=$(sha256sum "${inputs[@]}" && echo "$* seed $seed")
  if [ -f "$folder/summary.md" ] && [ "$key" = "$(cat "$folder/inputs.txt" 2>/dev/null)" ]; then
    echo "$folder is up to date"
    touch "$folder/summary.md"  # for publish.py: this is what the present program prints
    return
  fi
  rm -f "$folder/inputs.txt"
  "$dtof" "$@" --seed "$seed" --out "$folder"
  echo "$key" > "$folder/inputs.txt"
}

run_once frame frame --scene room --readout all --engine rtl --verify "${small[@]}"

captures=$data/sifferman_tmf8820_distance_data.json
if [ -f "$captures" ]; then
  run_once tmf8820 replay "$captures" --readout all --engine rtl --verify --photons 500 --shift 2
else
  echo "TMF8820 captures are not here ($captures): replay skipped"
fi
