#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian packages the project needs, if any is missing: with apt-get as root, else with sudo.
# Where neither works it names the missing packages and fails.
set -euo pipefail

packages=(
  # C++ build
  cmake ninja-build g++ ccache pkg-config make
  libcli11-dev libfmt-dev libgtest-dev libgmock-dev libbenchmark-dev nlohmann-json3-dev librandom123-dev
  libboost-dev libmatio-dev libpng-dev libcairo2-dev fonts-dejavu-core zlib1g-dev libtbb-dev libtomlplusplus-dev
  # RTL: simulation, lint, synthesis, timing
  verilator yosys iverilog opensta qflow-tech-osu018
  # scripts, plots, checks
  python3 python3-numpy python3-markdown python3-yaml python3-pyflakes gnuplot-nox clang-format clang-tidy gcovr
)

for purpose in "$@"; do
  case $purpose in
    fuzz) packages+=(clang libclang-rt-dev) ;;  # libFuzzer, for make fuzz only
    fpga) packages+=(nextpnr-ice40 fpga-icestorm fpga-icestorm-chipdb) ;;  # places and routes the demonstrator, for make fpga only
    layout) packages+=(qflow) ;;                # with graywolf, qrouter, Magic, Netgen, for make layout only
    wave) packages+=(gtkwave) ;;                # names the signals of a waveform, and shows it, for make wave only
    sweep) packages+=(snakemake) ;;             # runs the jobs of a sweep, for make sweep only
    slurm) packages+=(snakemake slurm-wlm munge) ;;  # a cluster of one node, for make sweep-test only
    browser) packages+=(chromium) ;;            # opens the pages, for make test only
    learning) packages+=(libdlib-dev) ;;        # trains the enlarger's weights, for make train-enlarger only
    playground)  # the models as WebAssembly, for make playground only
      packages+=(emscripten librange-v3-dev) ;;
    *) echo "error: $purpose: packages for fuzz, fpga, layout, wave, sweep, slurm, browser, learning and playground are known" >&2; exit 2 ;;
  esac
done

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if [ "$(id -u)" -eq 0 ]; then
  as_root=()
elif command -v sudo >/dev/null && sudo -n true 2>/dev/null || { [ -t 0 ] && command -v sudo >/dev/null; }; then
  as_root=(sudo)
else
  echo "error: missing Debian packages, and neither root nor sudo to install them: ${missing[*]}" >&2
  exit 1
fi

echo "Installing: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
