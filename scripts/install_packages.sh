#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# install_packages.sh [PURPOSE]...: installs the Debian packages the project needs, if any is missing: with apt-get as root, else
# with sudo. Where neither works it names the missing packages and fails, and so it does where the Debian release has no such
# package. What only some targets need is a purpose: the target that needs it installs it.
set -euo pipefail

packages=(
  # C++ build
  cmake ninja-build g++ ccache pkg-config make
  libcli11-dev libfmt-dev libgtest-dev libgmock-dev libbenchmark-dev nlohmann-json3-dev libkainjow-mustache-dev librandom123-dev
  libboost-dev libmatio-dev libpng-dev libcairo2-dev fonts-dejavu-core zlib1g-dev libtbb-dev libtomlplusplus-dev
  libhdf5-dev libarchive-dev  # reads HDF5 and MAT v7.3, reads and writes NPZ
  pybind11-dev python3-dev  # the Python module
  # RTL: simulation, lint, synthesis, timing
  verilator yosys iverilog opensta
  # scripts, plots, checks
  python3 python3-numpy python3-markdown python3-yaml python3-pyflakes mypy gnuplot-nox clang-format
)

optional=()  # taken where the release has them

for purpose in "$@"; do
  case $purpose in
    lint) packages+=(clang-tidy) ;;             # static analysis, for make lint only
    coverage) packages+=(gcovr) ;;              # counts of lines that run, for make coverage only
    clang) packages+=(clang) ;;                 # the second compiler of the C++ package, for make test only
    fuzz) packages+=(clang libclang-rt-dev) ;;  # libFuzzer, for make fuzz only
    fpga) packages+=(nextpnr-ice40 fpga-icestorm fpga-icestorm-chipdb) ;;  # places and routes the demonstrator, for make fpga only
    layout) packages+=(qflow qflow-tech-osu018) ;;  # with graywolf, qrouter, Magic, Netgen, for make layout only
    osu018) optional+=(qflow-tech-osu018) ;;    # a second library for make synth-check, which goes on without
    wave) packages+=(gtkwave) ;;                # names the signals of a waveform, and shows it, for make wave only
    sweep) packages+=(snakemake) ;;             # runs the jobs of a sweep, for make sweep only
    slurm) packages+=(snakemake slurm-wlm munge) ;;  # a cluster of one node, for make sweep-test only
    browser) packages+=(chromium) ;;            # opens the pages, for make test only
    python)  # installs the Python module, draws the examples' pictures, runs the notebooks, brings files for tests of the readers, for make test only
      packages+=(python3-venv python3-pip python3-setuptools python3-wheel python3-matplotlib python3-scipy python3-h5py-serial
        python3-nbformat python3-nbclient python3-ipykernel) ;;
    learning) packages+=(libdlib-dev) ;;        # trains the enlarger's weights, for make train-enlarger only
    page) packages+=(npm) ;;                    # fetches the plotting library of make report's pages, for .ci/pages only
    slang) packages+=(npm) ;;                   # fetches slang, for make lint-slang only
    playground)  # the models as WebAssembly, for make playground only
      packages+=(emscripten librange-v3-dev) ;;
    *)
      echo "error: $purpose: packages for lint, coverage, clang, fuzz, fpga, layout, osu018, wave, sweep, slurm, browser, python, learning," \
        "page, slang and playground are known" >&2
      exit 2
      ;;
  esac
done

is_installed() {
  dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep 'install ok installed' > /dev/null
}

missing=()
wanted=()  # the optional ones that are missing
for package in "${packages[@]}"; do
  is_installed "$package" || missing+=("$package")
done
for package in "${optional[@]}"; do
  is_installed "$package" || wanted+=("$package")
done
[ ${#missing[@]} -eq 0 ] && [ ${#wanted[@]} -eq 0 ] && exit 0

if [ "$(id -u)" -eq 0 ]; then
  as_root=()
elif command -v sudo >/dev/null && sudo -n true 2>/dev/null || { [ -t 0 ] && command -v sudo >/dev/null; }; then
  as_root=(sudo)
elif [ ${#missing[@]} -eq 0 ]; then
  exit 0
else
  echo "error: missing Debian packages, and neither root nor sudo to install them: ${missing[*]}" >&2
  exit 1
fi

export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
release=$(. /etc/os-release && echo "${PRETTY_NAME:-this system}")

# Whether the release has the package.
is_offered() {
  apt-cache policy "$1" | grep 'Candidate: [^(]' > /dev/null  # -q would end apt-cache early, and the pipe with it
}

absent=()
for package in "${missing[@]}"; do
  is_offered "$package" || absent+=("$package")
done
if [ ${#absent[@]} -gt 0 ]; then
  echo "error: $release has no package ${absent[*]}, which this target needs" >&2
  exit 1
fi
for package in "${wanted[@]}"; do
  if is_offered "$package"; then
    missing+=("$package")
  else
    echo "$release has no package $package: the target goes on without it"
  fi
done
[ ${#missing[@]} -gt 0 ] || exit 0

echo "Installing: ${missing[*]}"
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
