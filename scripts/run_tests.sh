#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every test, C++ and Python, by CTest. The last line says how many tests were skipped, because what they need is not here.
set -euo pipefail
build=$1
ctest --test-dir "$build" --output-on-failure -j "$(nproc)"
log=$build/Testing/Temporary/LastTest.log
skipped=$(($(sed -nE 's/^\[  SKIPPED \] ([0-9]+) tests?\.$/+\1/p; s/^OK \(skipped=([0-9]+)\)$/+\1/p' "$log" | tr -d '\n') + 0))
if [ "$skipped" = 0 ]; then
  echo "tests: all ran"
else
  echo "tests: $skipped skipped, for what they need is not here ($log says which)"
fi
