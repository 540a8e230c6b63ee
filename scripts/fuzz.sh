#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every reader and the command line on damaged input: libFuzzer with AddressSanitizer and UndefinedBehaviorSanitizer, one
# program after the other, FUZZ_SECONDS each (600), all or those named. New inputs are kept in build/fuzz/corpus; one that
# breaks a program is in build/fuzz/findings, and the script fails.
set -euo pipefail
seconds=${FUZZ_SECONDS:-600}
folder=build/fuzz
mkdir -p "$folder/findings"
cmake -S . -B "$folder/cpp" -G Ninja -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DDTOF_FUZZ=ON -DCMAKE_CXX_FLAGS_RELEASE=-O1 > "$folder/cmake.log" 2>&1 \
  || { cat "$folder/cmake.log"; exit 1; }

targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  for seeds in tests/fuzz/corpus/*/; do targets+=("$(basename "$seeds")"); done
fi
ninja -C "$folder/cpp" "${targets[@]/#/fuzz_}"

# The leak check at the end of each input would take most of the time; make test-sanitize looks for leaks.
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
for target in "${targets[@]}"; do
  mkdir -p "$folder/corpus/$target"
  log=$folder/$target.log
  if ! "$folder/cpp/bin/fuzz_$target" -max_total_time="$seconds" -max_len=16384 -timeout=20 -rss_limit_mb=4096 \
      -close_fd_mask=1 -artifact_prefix="$folder/findings/$target-" -print_final_stats=1 \
      "$folder/corpus/$target" "tests/fuzz/corpus/$target" > "$log" 2>&1; then
    tail -40 "$log"
    echo "fuzz: $target has a finding, see $log and $folder/findings" >&2
    exit 1
  fi
  printf 'fuzz: %s: %s runs in %s s, no finding\n' "$target" \
    "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" "$seconds"
done
