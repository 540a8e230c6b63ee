#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The models by emscripten, then the page around them.
set -euo pipefail
build=build/playground/cmake
mkdir -p "$build"
export NODE_PATH=/usr/share/nodejs  # Debian's JavaScript libraries, whichever Node.js is the first one found
emcmake cmake -S . -B "$build" -G Ninja -DCMAKE_CXX_FLAGS_RELEASE=-O2 > "$build.log" 2>&1 || { cat "$build.log"; exit 1; }
ninja -C "$build"
/usr/bin/python3 -B scripts/playground_page.py
