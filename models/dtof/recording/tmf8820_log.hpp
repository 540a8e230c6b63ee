// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "dtof/recording/tmf8820_json.hpp"

namespace dtof {

/// Captures in the serial output of the manufacturer's TMF8820 firmware while it dumps histograms.
struct Tmf8820Log {
  std::vector<Tmf8820Capture> captures;  ///< true distances are unknown
  std::size_t incomplete = 0;            ///< number of captures with missing lines, which are left out
};

/// True if some line of the text begins with "#Raw,".
bool is_tmf8820_log(std::string_view text);

/// Parses a log. A line "#Raw,<address>,<index>" with 128 numbers holds one byte of each bin of one channel.
/// The channel is index % 10: 0 is the reference, 1 to 9 are the zones. The byte is index / 10, least
/// significant first. Index 0 begins a capture of 30 lines. Other lines are ignored. `path` is for error
/// messages. Throws InputError "<path>:<line>: <reason>" for a malformed line, and for a log without a
/// complete capture.
Tmf8820Log parse_tmf8820_log(const std::filesystem::path& path, std::string_view text);

}  // namespace dtof
