// SPDX-License-Identifier: Apache-2.0
// Words of a damaged stream, which the C driver unpacks: frames of words of all kinds, from arrays of up to
// four columns and rows.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "dtof.h"

namespace {

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

dtof_device device_of(const std::uint8_t* data) {
  dtof_device device{};
  device.columns = static_cast<std::uint16_t>(data[0] % 4 + 1);
  device.rows = static_cast<std::uint16_t>(data[0] / 4 % 4 + 1);
  device.engine_columns = static_cast<std::uint16_t>(data[0] / 16 % 4 + 1);
  device.has_schedule = (data[0] & 64U) != 0;
  device.has_raster_order = (data[0] & 128U) != 0;
  device.raw_bins = data[1] % 4 + 1U;
  return device;
}

std::size_t pixels_of(const dtof_device& device) {
  return static_cast<std::size_t>(device.rows) * device.columns;
}

/// Each pixel has one place in the order of the stream.
void check_order(const dtof_device& device) {
  std::vector<bool> seen(pixels_of(device));
  std::uint16_t row = 0;
  std::uint16_t column = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    require(dtof_pixel_at(&device, i, &row, &column) == DTOF_OK && row < device.rows &&
            column < device.columns);
    const std::size_t place = static_cast<std::size_t>(row) * device.columns + column;
    require(!seen[place]);
    seen[place] = true;
  }
  require(dtof_pixel_at(&device, seen.size(), &row, &column) == DTOF_ARGUMENT);
}

/// A frame that the driver takes has all pixels, each in its place.
void check_results(const dtof_device& device, std::size_t words_of_a_pixel,
                   const std::vector<dtof_result>& results) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    require(results[i].row == i / device.columns && results[i].column == i % device.columns);
    require(results[i].has_second == (words_of_a_pixel == 2) && !results[i].raw);
  }
}

void unpack_all(const dtof_device& device, const std::uint8_t* data,
                const std::vector<std::uint64_t>& words) {
  const std::size_t pixels = pixels_of(device);
  std::vector<dtof_result> results(pixels);
  if (dtof_unpack_frame(&device, words.data(), words.size(), results.data()) == DTOF_OK) {
    check_results(device, words.size() / pixels, results);
  }
  if (dtof_unpack_amplitude_frame(&device, words.data(), words.size(), results.data()) == DTOF_OK) {
    check_results(device, words.size() / pixels, results);
  }
  if (dtof_unpack_short_frame(&device, words.data(), words.size(), results.data()) == DTOF_OK) {
    check_results(device, 2 * words.size() > pixels + 1 || results[0].has_second ? 2 : 1, results);
  }
  const auto first = static_cast<std::uint16_t>(data[2] % 5);
  const auto last = static_cast<std::uint16_t>(data[3] % 5);
  std::vector<dtof_result> bins(5 * pixels * device.raw_bins);
  if (dtof_unpack_raw(&device, first, last, words.data(), words.size(), bins.data()) == DTOF_OK) {
    require(first <= last && last < device.rows && bins[0].raw && bins[0].row == first);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 4) {
    return 0;
  }
  const dtof_device device = device_of(data);
  check_order(device);
  std::vector<std::uint64_t> words((size - 4) / sizeof(std::uint64_t));
  if (!words.empty()) {
    std::memcpy(words.data(), data + 4, words.size() * sizeof(std::uint64_t));
  }
  unpack_all(device, data, words);
  // The checksum finds every single damaged bit.
  if (!words.empty()) {
    const std::uint32_t before = dtof_crc(words.data(), words.size());
    words[data[2] % words.size()] ^= std::uint64_t{1} << data[3] % 64U;
    require(dtof_crc(words.data(), words.size()) != before);
  }
  return 0;
}
