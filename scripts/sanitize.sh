#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every C++ test under AddressSanitizer and UndefinedBehaviorSanitizer, those that use several threads under
# ThreadSanitizer, each in a build of its own. The C++ that Verilator generates is not instrumented (it would compile
# for half an hour); the drivers and the harness around it are.
set -euo pipefail
folder=build/sanitize
# These run on several threads; the others would only repeat their code.
threaded_tests='core photon readout analytic run study rtl_pool'

build_and_run() { # name, CMake preset, tests (empty: all)
  local build=$folder/$1 tests=$3
  mkdir -p "$folder"
  cmake -S . --preset "$2" > "$folder/$1_cmake.log" 2>&1 \
    || { cat "$folder/$1_cmake.log"; exit 1; }
  if [ -z "$tests" ]; then
    ninja -C "$build"
    ctest --test-dir "$build" --output-on-failure -j "$(nproc)" -LE python
  else
    ninja -C "$build" $(printf '%s_test ' $tests)
    ctest --test-dir "$build" --output-on-failure -j "$(nproc)" -R "^($(tr ' ' '|' <<< "$tests"))(_[0-9]+)?\$"
  fi
}

# Frames of 33,333 acquisitions take long and run no line that shorter ones do not.
export GTEST_FILTER=${GTEST_FILTER:--*FrameCycles.StayBelowTheLimit*:*StaysBelowTheCycleLimit*}
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:detect_stack_use_after_return=1
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
export LSAN_OPTIONS=suppressions=$PWD/scripts/lsan_suppressions.txt:print_suppressions=0
export TSAN_OPTIONS=halt_on_error=1:suppressions=$PWD/scripts/tsan_suppressions.txt
case ${1:-all} in
  address) build_and_run address sanitize "" ;;
  thread) build_and_run thread sanitize-thread "$threaded_tests" ;;
  all)
    build_and_run address sanitize ""
    build_and_run thread sanitize-thread "$threaded_tests"
    ;;
  *)
    echo "usage: sanitize.sh [address|thread|all]" >&2
    exit 1
    ;;
esac
