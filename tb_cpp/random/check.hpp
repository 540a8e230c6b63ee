// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "rtl/configuration.hpp"
#include "sources/sources.hpp"

namespace dtof {

/// Result of comparing an array with its model.
struct ArrayCheck {
  int frames = 0;
  std::uint64_t results = 0;
  std::uint64_t clocks = 0;
  std::string difference;  ///< empty if every result equals the model's
};

/// Builds the array if necessary, and compares it with the model. First a dark frame must take
/// predicted_frame_clocks() clocks. Then frames of random streams follow, short and long, with pauses,
/// back-pressure, resets and changing gates. `reproduce`: command that checks this array again.
ArrayCheck check_array(const RtlConfiguration& configuration, std::uint64_t seed,
                       const std::string& reproduce, std::span<const SourceFile> sources = project_sources());

}  // namespace dtof
