// SPDX-License-Identifier: Apache-2.0
// Sensor files.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "dtof/core/error.hpp"
#include "dtof/sensor/sensor_file.hpp"

namespace {

void read(const std::uint8_t* data, std::size_t size) {
  (void)dtof::parse_sensor(std::string_view(reinterpret_cast<const char*>(data), size), "sensor.toml");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    read(data, size);
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
  return 0;
}
