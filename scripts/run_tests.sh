#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every test, C++ and Python, by CTest. The last lines say how many tests were skipped, and why.
set -euo pipefail
build=$1
ctest --test-dir "$build" --output-on-failure -j "$(nproc)"
log=$build/Testing/Temporary/LastTest.log
skipped=$(($(sed -nE 's/^\[  SKIPPED \] ([0-9]+) tests?\.$/+\1/p; s/^OK \(skipped=([0-9]+)\)$/+\1/p' "$log" | tr -d '\n') + 0))
if [ "$skipped" = 0 ]; then
  echo "tests: all ran"
else
  sed -n '/: Skipped$/{n;p}' "$log" | sort | uniq -c | sort -rn | sed 's/^ *\([0-9]*\) /  skipped, \1 times: /'
  echo "tests: $skipped skipped, each with its reason in $log"
fi
