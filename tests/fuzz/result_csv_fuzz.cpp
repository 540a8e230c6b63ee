// SPDX-License-Identifier: Apache-2.0
// Results of a frame.
#include <cstddef>
#include <cstdint>

#include "dtof/core/error.hpp"
#include "dtof/io/result_csv.hpp"
#include "fuzz/input_file.hpp"

namespace {

void read(const std::uint8_t* data, std::size_t size) {
  (void)dtof::read_result_csv(dtof::fuzz::input_file(data, size));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    read(data, size);
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
  return 0;
}
