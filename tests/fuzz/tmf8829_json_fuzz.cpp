// SPDX-License-Identifier: Apache-2.0
// Logs of an ams TMF8829: JSON, plain or gzip.
#include <cstddef>
#include <cstdint>

#include "dtof/core/error.hpp"
#include "dtof/recording/tmf8829_json.hpp"
#include "fuzz/input_file.hpp"

namespace {

void read(const std::uint8_t* data, std::size_t size) {
  (void)dtof::tmf8829_cube(dtof::read_tmf8829_json(dtof::fuzz::input_file(data, size)));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    read(data, size);
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
  return 0;
}
