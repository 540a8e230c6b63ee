// SPDX-License-Identifier: Apache-2.0
// Maps: PNG of 8 and 16 bits, PFM and NPY, as depth, reflectivity, disparity and photograph.
#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "dtof/core/error.hpp"
#include "dtof/io/depth_image.hpp"
#include "fuzz/input_file.hpp"

namespace {

void read(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path file = dtof::fuzz::input_file(data, size);
  try {
    (void)dtof::read_reflectivity_image(file);
  } catch (const dtof::InputError&) {  // the file may still be another kind of map
  }
  try {
    (void)dtof::read_disparity_png(file, 1.0);
  } catch (const dtof::InputError&) {  // likewise
  }
  try {
    (void)dtof::read_photograph(file);
  } catch (const dtof::InputError&) {  // likewise
  }
  (void)dtof::read_depth_image(file, 0.001);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    read(data, size);
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
  return 0;
}
