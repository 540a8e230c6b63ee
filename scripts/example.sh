#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# `example.sh READOUT [BENCH]`: runs a frame of dtof_subsystem in examples/example_bench.sv, or another bench, with Icarus
# Verilog. Exits non-zero unless every result is right.
set -euo pipefail
cd "$(dirname "$0")/.."
readout=$1
bench=$(realpath "${2:-examples/example_bench.sv}")
number=$(sed -n "s/^set(DTOF_SUBSYSTEM_NUMBER_$readout \([0-9]*\))$/\1/p" cmake/readouts.cmake)
if [ -z "$number" ]; then
  echo "error: no read-out with RTL is called '$readout'" >&2
  exit 1
fi
mkdir -p build
program=$PWD/build/example_$readout.vvp
cd hdl
iverilog -g2012 -s example_bench -Pexample_bench.READOUT="$number" -o "$program" -f dtof.f "$bench"
vvp -n "$program" | tee "${program%.vvp}.log"
grep -qx PASS "${program%.vvp}.log"
