// SPDX-License-Identifier: Apache-2.0
// Logs of lines, plain or gzip: of TMF8820, TMF8821 and TMF8828 in each mode, and of VL53L8CH.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "dtof/core/error.hpp"
#include "dtof/recording/tmf882x_log.hpp"
#include "dtof/recording/vl53l8ch_log.hpp"
#include "fuzz/input_file.hpp"

namespace {

template <typename Read>
void read_or_refuse(const std::filesystem::path& file, const Read& read) {
  try {
    dtof::LineReader lines(file);
    std::string description;
    (void)read(lines, description);
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path file = dtof::fuzz::input_file(data, size);
  for (const auto mode :
       {dtof::Tmf882xMode::kOneCapture, dtof::Tmf882xMode::kTwoCaptures, dtof::Tmf882xMode::kEightByEight}) {
    read_or_refuse(file, [&](dtof::LineReader& lines, std::string& description) {
      return dtof::read_tmf882x_log(lines, {.mode = mode, .bin_width_s = 1e-10}, description);
    });
  }
  read_or_refuse(file, [](dtof::LineReader& lines, std::string& description) {
    return dtof::read_tmf882x_log(lines, {}, description);
  });
  read_or_refuse(file, [](dtof::LineReader& lines, std::string& description) {
    return dtof::read_vl53l8ch_log(lines, 1e-9, description);
  });
  return 0;
}
