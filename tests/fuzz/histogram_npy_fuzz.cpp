// SPDX-License-Identifier: Apache-2.0
// NPY arrays, and the histogram streams that they become.
#include <cstddef>
#include <cstdint>

#include "dtof/core/error.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/recording/histogram_stream.hpp"
#include "fuzz/input_file.hpp"

namespace {

void read(const std::uint8_t* data, std::size_t size) {
  const dtof::NpyArray array = dtof::read_npy(dtof::fuzz::input_file(data, size));
  const dtof::HistogramCube cube = dtof::histogram_cube(array, 1e-10);
  dtof::Resampling resampling{.acquisitions = 100, .photon_budget = 50.0, .background = 0.1};
  (void)dtof::HistogramStream(cube, resampling).column(cube.columns - 1);
  // Without a budget each count is a photon: up to 1e7 of them would take the fuzzer a second.
  double photons = 0.0;
  for (const double count : cube.counts) {
    photons += count;
  }
  if (photons < 1e4 || photons > dtof::kLargestPhotonNumber) {
    resampling.photon_budget.reset();
    (void)dtof::HistogramStream(cube, resampling).column(0);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    read(data, size);
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
  return 0;
}
