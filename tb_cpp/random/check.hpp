// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "rtl/configuration.hpp"
#include "sources/sources.hpp"

namespace dtof {

/// What the frames of one array came to.
struct ArrayCheck {
  int frames = 0;
  std::uint64_t results = 0;
  std::uint64_t clocks = 0;
  std::string difference;  ///< empty if every result is the model's
};

/// Builds the array if it is not there, and runs frames of random streams through array and model: short and
/// long, with pauses, back-pressure, resets, another gate in each. Before, a dark frame must take the clocks
/// that predicted_frame_clocks() says. `reproduce`: the command that runs this array again.
ArrayCheck check_array(const RtlConfiguration& configuration, std::uint64_t seed,
                       const std::string& reproduce, std::span<const SourceFile> sources = project_sources());

}  // namespace dtof
