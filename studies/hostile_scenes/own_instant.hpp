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

/// The instant of the frame, 0 at its start and 1 at its end, at which a target is where an estimator says
/// that it is, by the target's distance at the frame's middle.
struct OwnInstants {
  std::vector<double> distances_m;  ///< rising
  /// Each estimator's, by its name; none where it does not find the target.
  std::map<std::string, std::vector<std::optional<double>>> instants;

  /// Between two distances in proportion, beyond them that of the nearest one with an instant; the frame's
  /// middle for an estimator without any.
  [[nodiscard]] double at(const std::string& name, double distance_m) const;
};

/// From the mean errors of walls that go away and of the same walls that come nearer, against where they are
/// at the frame's middle. What both have alike, e.g. by pile-up, is no matter of time. `travel_m`: how far a
/// wall moves in a frame.
double own_instant(double error_away_m, double error_nearer_m, double travel_m);

/// The middle of the part of the frame whose timestamps make the position, as integer behaviour says; none
/// for a read-out that takes the position from a part that the target's distance picks (PiFH).
std::optional<double> middle_of_position(const ReadoutParameters& readout);

}  // namespace dtof
