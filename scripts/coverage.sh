#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What the tests reach: a build of its own that counts, every C++ test, and reports/coverage.md from the counts.
# Annotated sources: build/coverage/hdl (RTL), build/coverage/html (C++).
set -euo pipefail
folder=build/coverage
build=$folder/cpp
counts=$folder/counts

mkdir -p "$folder"
cmake -S . --preset coverage > "$folder/cmake.log" 2>&1 || { cat "$folder/cmake.log"; exit 1; }
ninja -C "$build" all long_tests
find "$build" -name '*.gcda' -delete
rm -rf "$counts" "$folder/hdl" "$folder/html"
mkdir "$counts" "$folder/html"

# Frames of 33,333 acquisitions take long and run no line that shorter ones do not.
DTOF_RTL_COVERAGE=$PWD/$counts GTEST_FILTER='-*FrameCycles.StayBelowTheLimit*:*StaysBelowTheCycleLimit*' \
  ctest --test-dir "$build" -C long --output-on-failure -j "$(nproc)" -LE python -E '^rtl_pool_[0-9]$'  # rtl_pool_long has its arrays, too

# One place in the source is one point, whatever the module's parameters and wherever it is instantiated. Keys and
# values of a point are separated by the characters 1 and 2.
find "$counts" -name '*.dat' -print0 | xargs -0 -P "$(nproc)" -n 20 sed -i \
  -e $'s#\001f\002[^\001]*/\\(hdl\\|tb_cpp\\)/#\001f\002\\1/#' \
  -e $'s#\001page\002\\(v_[a-z]*\\)/[^\001\']*#\001page\002\\1#' \
  -e $'s#\001h\002[^\001\']*##'
verilator_coverage --write "$folder/rtl.dat" "$counts"/*.dat > "$folder/merge.log"
verilator_coverage --annotate "$folder/hdl" --annotate-min 1 "$folder/rtl.dat" > "$folder/annotate.log"

gcovr --root . --object-directory "$build" --filter '(models|tb_cpp|app|studies)/' --exclude-throw-branches --exclude-unreachable-branches \
  --json-summary "$folder/cpp.json" --html-details "$folder/html/index.html" -j "$(nproc)" 2> "$folder/gcovr.log"
/usr/bin/python3 scripts/coverage.py "$folder/rtl.dat" "$folder/cpp.json" "${SMALL:+build/small/}reports/coverage.md"
