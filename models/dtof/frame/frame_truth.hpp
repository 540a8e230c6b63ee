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

/// Distance from which light returns after T_int, m.
double sensor_range_m(const SensorModel& sensor);
/// "the sensor's range, 6.75 m (light there and back in 45 ns)".
std::string range_phrase(const SensorModel& sensor);

/// " 3 pixels are dead and not judged." for `what` = "dead"; empty for no pixels.
std::string not_judged_sentence(std::uint64_t pixels, std::string_view what);
/// Why distances cannot be measured, if not even the `nearest` of them can: to end a refusal with. If
/// `whole`, all are whole numbers, it asks whether those of 50 and more are millimetres, which `option` would
/// say.
std::string unreachable_phrase(double nearest, double reach_m, bool whole, std::string_view option);

/// What a read-out can be judged by, of the rows of some columns.
struct FrameTruth {
  /// True distances in m, row-major; NaN of a pixel that is not judged: of those that are counted below.
  std::vector<float> metres;
  std::uint64_t without_target = 0;  ///< nothing returns light
  std::uint64_t beyond_range = 0;    ///< the sensor's
  std::uint64_t dead = 0;            ///< of the sensor's defects, with a target in range; none with binning

  [[nodiscard]] bool any_judged() const;
  /// One sentence for each kind of pixel that is not judged, each behind a blank, e.g. " 3 pixels are beyond
  /// the sensor's range, 6.75 m (light there and back in 45 ns), and not judged."; empty if all are judged.
  [[nodiscard]] std::string sentences(const SensorModel& sensor) const;
};

FrameTruth frame_truth(const TargetMap& targets, const SensorModel& sensor, std::span<const int> columns,
                       RowRange rows);

/// Throws InputError, which begins with `name`, unless a target is within the sensor's range. If
/// `millimetres`, the refusal asks whether distances of 50 and more, all whole numbers, are millimetres.
void require_reachable(const TargetMap& targets, const SensorModel& sensor, std::string_view name,
                       bool millimetres = false);

}  // namespace dtof
