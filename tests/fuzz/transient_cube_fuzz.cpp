// SPDX-License-Identifier: Apache-2.0
// Transient cubes: NPY arrays, and the scenes that they become.
#include <cstddef>
#include <cstdint>

#include "dtof/core/error.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/scene/scene.hpp"
#include "fuzz/input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const dtof::NpyArray array = dtof::read_npy(dtof::fuzz::input_file(data, size));
    const dtof::TargetMap scene =
        dtof::scene_from_transient_cube(array.shape, array.values, {.bin_width_s = 1e-10}, 2e-9, 3, 2);
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
