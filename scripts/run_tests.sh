#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every test: Python tests of the synthesis flow and of the mutants, then the GoogleTest programs through CTest.
set -euo pipefail
build=$1
/usr/bin/python3 -m unittest discover -s synth/tests -t synth
/usr/bin/python3 -m unittest discover -s scripts/tests -t scripts
ctest --test-dir "$build" --output-on-failure -j "$(nproc)"
