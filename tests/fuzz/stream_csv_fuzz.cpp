// SPDX-License-Identifier: Apache-2.0
// Recorded TDC streams. The first byte chooses what the stream is checked against.
#include <cstddef>
#include <cstdint>

#include "dtof/core/error.hpp"
#include "dtof/recording/stream_csv.hpp"
#include "fuzz/input_file.hpp"

namespace {

void read(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return;
  }
  dtof::StreamCsvOptions options{.np = 1 + (data[0] & 15), .slots = 1 + (data[0] >> 4 & 3)};
  if ((data[0] & 0x40) != 0) {
    options.columns = 3;
    options.rows = 2;
  }
  if ((data[0] & 0x80) != 0) {
    options.acquisitions = 100;
  }
  (void)dtof::read_stream_csv(dtof::fuzz::input_file(data + 1, size - 1), options);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    read(data, size);
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
  return 0;
}
