// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"

namespace dtof {

/// Part of a frame in which a read-out uses every acquisition in the same way.
struct ReadoutPhase {
  std::string name;
  std::uint32_t end;  ///< first acquisition after the phase

  bool operator==(const ReadoutPhase&) const = default;
};

/// Phases of a read-out's frame in their order; the last one ends with the frame.
std::vector<ReadoutPhase> readout_phases(const ReadoutParameters& parameters, std::uint32_t acquisitions);

}  // namespace dtof
