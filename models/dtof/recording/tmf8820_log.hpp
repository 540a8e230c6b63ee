// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "dtof/recording/tmf8820_json.hpp"

namespace dtof {

/// What the firmware of the TMF8820's makers prints on its serial line while histograms are dumped.
struct Tmf8820Log {
  std::vector<Tmf8820Capture> captures;  ///< of unknown distance
  std::size_t incomplete = 0;            ///< captures of which lines are missing, and which are left out
};

/// Whether a text is such a log: a line of it begins with "#Raw,".
bool is_tmf8820_log(std::string_view text);

/// Reads a log. A line "#Raw,<address>,<index>" and 128 numbers holds one byte of each bin of a channel:
/// channel index % 10, of which 0 is the reference and 1 to 9 are the zones, and byte index / 10, the lowest
/// one first. Index 0 begins a capture of 30 lines; other lines say nothing about histograms. `path` is for
/// messages. Throws InputError "<path>:<line>: <reason>" for a line of another shape, and for a log without a
/// whole capture.
Tmf8820Log parse_tmf8820_log(const std::filesystem::path& path, std::string_view text);

}  // namespace dtof
