// SPDX-License-Identifier: Apache-2.0
// Transient cubes: NPY, NPZ, HDF5 and MATLAB 7.3 as their reader reads them, and the scenes that they become.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "dtof/core/error.hpp"
#include "dtof/recording/transient_file.hpp"
#include "dtof/scene/scene.hpp"
#include "fuzz/input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const dtof::TransientFile file = dtof::read_transient_file(dtof::fuzz::input_file(data, size).string());
    if (file.array->count() == 0) {
      std::abort();
    }
    constexpr std::size_t kMostElements = std::size_t{1}
                                          << 24U;  // a dataset without chunks may say any number
    if (file.array->count() > kMostElements) {
      return 0;
    }
    const dtof::TargetMap scene = dtof::scene_from_transient_cube(
        file.array->shape(), [&](std::span<double> values) { file.array->next(values); },
        {.bin_width_s = file.bin_width_s.value_or(1e-10), .start_s = file.start_s.value_or(0.0)}, 2e-9, 3, 2);
    for (int column = 0; column < scene.columns(); ++column) {
      if (scene.returns_signal(column, 0)) {
        (void)scene.cube()->first_return(column, 0, 2e-9);
        (void)scene.cube()->light(column, 0).quantile(0.999);
      }
    }
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
  return 0;
}
