#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every test: GoogleTest programs through CTest, Python tests of the synthesis flow.
set -euo pipefail
build=$1
ctest --test-dir "$build" --output-on-failure -j "$(nproc)"
