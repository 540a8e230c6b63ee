// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"

namespace dtof {

/// Distance whose light returns after T_int, m.
double sensor_range_m(const SensorModel& sensor);
/// Text, e.g. "the sensor's range, 6.75 m (light there and back in 45 ns)".
std::string range_phrase(const SensorModel& sensor);

/// Text, e.g. " 3 pixels are dead and not judged." for `what` = "dead"; empty for 0 pixels.
std::string not_judged_sentence(std::uint64_t pixels, std::string_view what);
/// End of an error text for targets that are all beyond `reach_m`; names the distance of the `nearest` one.
/// If `whole` (all distances are whole numbers) and they could be millimetres, the text suggests `option`
/// 0.001.
std::string unreachable_phrase(double nearest, double reach_m, bool whole, std::string_view option);

/// True distances of the rows of some columns, by which results are judged.
struct FrameTruth {
  /// True distances in m, row-major; NaN for pixels that are not judged, which the members below count.
  std::vector<float> metres;
  std::uint64_t without_target = 0;  ///< pixels whose target returns no light, or without a target
  std::uint64_t beyond_range = 0;    ///< pixels whose target is beyond the sensor's range
  std::uint64_t dead = 0;            ///< dead pixels with a target in range; 0 with binning

  /// With a transient cube: distance of the first return, m, of each judged pixel whose first return is more
  /// than kAnotherReturn nearer than its truth, the strongest return; NaN for the others. Empty without a
  /// cube.
  std::vector<float> first_return = {};

  static constexpr double kAnotherReturn = 0.1;  ///< share of the true distance

  [[nodiscard]] bool any_judged() const;
  /// Sentences for summaries, one for each kind of pixel that is not judged, each after a blank. E.g. " 3
  /// pixels are beyond the sensor's range, 6.75 m (light there and back in 45 ns), and not judged."; empty if
  /// all are judged.
  [[nodiscard]] std::string sentences(const SensorModel& sensor) const;
};

FrameTruth frame_truth(const TargetMap& targets, const SensorModel& sensor, std::span<const int> columns,
                       RowRange rows);

/// Throws InputError that begins with `name` unless some target is within the sensor's range. With
/// `millimetres`, the text suggests a scale if all distances are whole numbers of 50 or more.
void require_reachable(const TargetMap& targets, const SensorModel& sensor, std::string_view name,
                       bool millimetres = false);

}  // namespace dtof
