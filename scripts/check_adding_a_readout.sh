#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Adds the three files of docs/user/adding_a_readout.md to a fresh clone of the last commit, in build/, and runs there what
# the guide says: the generator, the new read-out's RTL against its model, the tests that every read-out must pass, and
# its synthesis.
set -euo pipefail
cd "$(dirname "$0")/.."
files=$PWD/docs/user/adding_a_readout
tree=$PWD/build/adding_a_readout
jobs=${JOBS:-$(nproc)}

rm -rf "$tree"
git clone --quiet --local . "$tree"
cd "$tree"
cat "$files/readouts.toml" >> readouts.toml
cp "$files/first_photon.cpp" models/dtof/readout/
cp "$files/dtof_first_photon_column.sv" hdl/thesis/
/usr/bin/python3 scripts/generate.py

cmake -S . --preset release > build.log
ninja -C build/cpp -j "$jobs" dtof core_test readout_test report_test rtl_readouts_test > build.log || { cat build.log; exit 1; }
build/cpp/bin/dtof frame --readout firstphoton --engine rtl --verify --columns 0-9 --rows 0-19 --out build/firstphoton
# A test of CTest is a program; of the suites that take read-outs, the new one's.
ctest --test-dir build/cpp --output-on-failure -R '^(core|readout|report)$'
build/cpp/bin/rtl_readouts_test --gtest_brief=1 --gtest_filter='*firstphoton*'
(cd scripts && /usr/bin/python3 -m unittest -q tests.test_generate tests.test_plot_style)
make --no-print-directory synth-sizes
make --no-print-directory synth CONFIGURATIONS=firstphoton
echo "adding a read-out: three files, and everything above passed"
