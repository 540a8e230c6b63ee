// SPDX-License-Identifier: Apache-2.0
#include "dtof/frame/frame_truth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dtof/core/error.hpp"
#include "dtof/core/physical_constants.hpp"

namespace dtof {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;

}  // namespace

double sensor_range_m(const SensorModel& sensor) { return 0.5 * kSpeedOfLight * sensor.integration_time_s; }

std::string range_phrase(const SensorModel& sensor) {
  return fmt::format("the sensor's range, {:.2f} m (light there and back in {:g} ns)", sensor_range_m(sensor),
                     sensor.integration_time_s * kNanosecondsPerSecond);
}

std::string not_judged_sentence(std::uint64_t pixels, std::string_view what) {
  return pixels == 0
             ? ""
             : fmt::format(" {} pixel{} {} and not judged.", pixels, pixels == 1 ? " is" : "s are", what);
}

std::string unreachable_phrase(double nearest, double reach_m, bool whole, std::string_view option) {
  constexpr double kLeastMillimetres = 50.0;
  const bool likely = whole && nearest >= kLeastMillimetres && nearest * 1e-3 < reach_m;
  return fmt::format("the nearest at {:g} m{}", nearest,
                     likely ? fmt::format("; if these are millimetres, use {} 0.001", option) : "");
}

bool FrameTruth::any_judged() const {
  return std::ranges::any_of(metres, [](float distance) { return !std::isnan(distance); });
}

std::string FrameTruth::sentences(const SensorModel& sensor) const {
  return not_judged_sentence(without_target, "without a true distance") +
         not_judged_sentence(beyond_range, fmt::format("beyond {},", range_phrase(sensor))) +
         not_judged_sentence(dead, "dead");
}

FrameTruth frame_truth(const TargetMap& targets, const SensorModel& sensor, std::span<const int> columns,
                       RowRange rows) {
  constexpr float kNotJudged = std::numeric_limits<float>::quiet_NaN();
  const double range_m = sensor_range_m(sensor);
  FrameTruth truth;
  for (int row = rows.first; row < rows.first + rows.count; ++row) {
    for (const int column : columns) {
      const PixelTarget& target = targets.at(column, row);
      float metres = kNotJudged;
      if (!targets.returns_signal(column, row)) {
        ++truth.without_target;
      } else if (target.depth_m >= range_m) {
        ++truth.beyond_range;
      } else if (sensor.binning == 1 && sensor.defects.is_dead(column, row)) {
        ++truth.dead;
      } else {
        metres = static_cast<float>(target.depth_m);
      }
      truth.metres.push_back(metres);
      if (targets.cube()) {
        float first = kNotJudged;
        if (!std::isnan(metres)) {
          const double nearest = targets.cube()->first_return(column, row, sensor.pulse_fwhm_s).distance_m;
          if (nearest < (1.0 - FrameTruth::kAnotherReturn) * target.depth_m) {
            first = static_cast<float>(nearest);
          }
        }
        truth.first_return.push_back(first);
      }
    }
  }
  return truth;
}

void require_reachable(const TargetMap& targets, const SensorModel& sensor, std::string_view name,
                       bool millimetres) {
  double nearest = std::numeric_limits<double>::infinity();
  bool whole = true;
  for (int row = 0; row < targets.rows(); ++row) {
    for (int column = 0; column < targets.columns(); ++column) {
      const PixelTarget& target = targets.at(column, row);
      if (target.depth_m > 0.0) {
        nearest = std::min(nearest, target.depth_m);
        whole = whole && target.depth_m == std::floor(target.depth_m);
      }
    }
  }
  if (std::isinf(nearest)) {
    throw InputError(fmt::format("{}: no pixel has a distance", name));
  }
  if (nearest < sensor_range_m(sensor)) {
    return;
  }
  throw InputError(fmt::format(
      "{}: every pixel is beyond {}, {}", name, range_phrase(sensor),
      unreachable_phrase(nearest, sensor_range_m(sensor), millimetres && whole, "--depth-scale")));
}

}  // namespace dtof
