// SPDX-License-Identifier: Apache-2.0
// Time tags of PicoQuant, and the histograms that they become.
#include <cstddef>
#include <cstdint>
#include <string>

#include "dtof/core/error.hpp"
#include "dtof/recording/picoquant.hpp"
#include "fuzz/input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    std::string description;
    (void)dtof::picoquant_cube(dtof::fuzz::input_file(data, size), description);
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
  return 0;
}
