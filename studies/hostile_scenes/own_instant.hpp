// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/metrics/confidence_interval.hpp"

namespace dtof {

inline constexpr double kMiddleOfAFrame = 0.5;

/// Own instants of estimators: the moment of the frame (0 start, 1 end) at which a moving target is at the
/// distance that the estimator reports. Depends on the target's distance at the frame's middle.
struct OwnInstants {
  std::vector<double> distances_m;  ///< ascending
  /// Instants by estimator name, one per distance; none where the estimator misses the target.
  std::map<std::string, std::vector<std::optional<double>>> instants;

  /// Instant at a distance: linear between two distances, else that of the nearest distance with an instant;
  /// 0.5 for an estimator without instants.
  [[nodiscard]] double at(const std::string& name, double distance_m) const;
};

/// Own instant, from the mean errors for a receding and for an approaching wall, both relative to the wall's
/// position at the frame's middle. An error common to both, e.g. by pile-up, cancels. `travel_m`: movement of
/// the wall in a frame.
double own_instant(double error_away_m, double error_nearer_m, double travel_m);

/// Middle of the part of the frame from which the read-out takes its position, by its definition. None if
/// that part depends on the target's distance (PiFH).
std::optional<double> middle_of_position(const ReadoutParameters& readout);

}  // namespace dtof
