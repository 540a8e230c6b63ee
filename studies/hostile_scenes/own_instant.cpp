// SPDX-License-Identifier: Apache-2.0
#include "hostile_scenes/own_instant.hpp"

#include <cstddef>

namespace dtof {

double OwnInstants::at(const std::string& name, double distance_m) const {
  const auto found = instants.find(name);
  if (found == instants.end()) {
    return kMiddleOfAFrame;
  }
  std::optional<std::size_t> below;
  for (std::size_t i = 0; i < distances_m.size(); ++i) {
    if (!found->second[i]) {
      continue;
    }
    if (distances_m[i] > distance_m) {
      if (!below) {
        return *found->second[i];
      }
      const double share = (distance_m - distances_m[*below]) / (distances_m[i] - distances_m[*below]);
      return *found->second[*below] + share * (*found->second[i] - *found->second[*below]);
    }
    below = i;
  }
  return below ? *found->second[*below] : kMiddleOfAFrame;
}

double own_instant(double error_away_m, double error_nearer_m, double travel_m) {
  return kMiddleOfAFrame + (error_away_m - error_nearer_m) / (2.0 * travel_m);
}

std::optional<double> middle_of_position(const ReadoutParameters& readout) {
  constexpr double kShares = 64.0;
  constexpr double kEnd = 1.0;
  switch (readout.readout) {
    case Readout::kPoolPointer:
    case Readout::kPoolPointerLean:
      return ((readout.pool.coarse_share + readout.pool.track_share) / kShares + kEnd) / 2.0;
    case Readout::kSifh:
    case Readout::kFifh:
    case Readout::kThreeSteps:
    case Readout::kHisPointer1:
    case Readout::kHisPointer:
      return (kMiddleOfAFrame + kEnd) / 2.0;
    case Readout::kPifh:
      return std::nullopt;
    default:
      return kMiddleOfAFrame;
  }
}

}  // namespace dtof
