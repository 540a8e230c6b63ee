// SPDX-License-Identifier: Apache-2.0
// MATLAB files: cells of photon times, and matrices.
#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "dtof/core/error.hpp"
#include "dtof/recording/photon_times_mat.hpp"
#include "fuzz/input_file.hpp"

namespace {

void read(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path file = dtof::fuzz::input_file(data, size);
  try {
    (void)dtof::read_mat_matrix(file, "depth");
  } catch (const dtof::InputError&) {  // the cells may still be sound
  }
  const dtof::PhotonTimes photons = dtof::read_photon_times_mat(file);
  (void)dtof::PhotonTimesStream(photons, 8e-12, {.acquisitions = 100, .photon_budget = 50.0}).column(0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    read(data, size);
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
  return 0;
}
