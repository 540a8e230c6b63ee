// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/recording_format.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "dtof/io/input_file.hpp"
#include "dtof/recording/picoquant.hpp"
#include "dtof/recording/tmf882x_log.hpp"
#include "dtof/recording/vl53l8ch_log.hpp"

namespace dtof {
namespace {

/// What a name ends with, and the kind of file that has it.
struct NameEnding {
  std::string_view ending;
  const char* format;
};

/// Whether the name ends with `ending`, in upper or lower case; `ending` is in lower case.
bool name_ends(std::string name, std::string_view ending) {
  std::ranges::transform(name, name.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return name.ends_with(ending);
}

}  // namespace

char first_character(std::string_view contents) {
  const std::string_view text = without_byte_order_mark(contents);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  return begin == std::string_view::npos ? ' ' : text[begin];
}

std::string format_of_contents(std::string_view contents) {
  const std::string_view start = contents.substr(0, kStartOfRecording);
  const char first = first_character(start);
  if (contents.starts_with("\x93NUMPY")) {
    return "npy";
  }
  if (contents.starts_with("MATLAB")) {
    return "mat";
  }
  if (is_picoquant(contents)) {
    return "picoquant";
  }
  if (contents.starts_with("PK\x03\x04") || contents.starts_with("PK\x05\x06")) {
    return "npz";
  }
  if (first == '{') {  // a TMF8829 log is an object, the TMF8820 captures are an array
    return "tmf8829";
  }
  if (first == '[' || is_tmf882x_log(start)) {
    return "tmf8820";
  }
  if (is_vl53l8ch_log(start)) {
    return "vl53l8ch";
  }
  if (contents.substr(0, contents.find('\n')).find("acquisition") != std::string_view::npos) {
    return "csv";
  }
  return "";
}

std::string find_recording_format(const std::string& name, std::string_view contents) {
  constexpr std::array<NameEnding, 8> kEndings = {{{".csv", "csv"},
                                                   {".csv.gz", "csv"},
                                                   {".npy", "npy"},
                                                   {".npy.gz", "npy"},
                                                   {".mat", "mat"},
                                                   {".mat.gz", "mat"},
                                                   {".json", "tmf8820"},
                                                   {".json.gz", "tmf8820"}}};
  std::string found_in_contents = format_of_contents(contents);
  if (!found_in_contents.empty()) {
    return found_in_contents;
  }
  const auto* const found =
      std::ranges::find_if(kEndings, [&](const NameEnding& known) { return name_ends(name, known.ending); });
  return found == kEndings.end() ? "" : found->format;
}

}  // namespace dtof
