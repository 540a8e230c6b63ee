// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "accuracy/accuracy_study.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

inline constexpr double kThesisSensors = 32000.0;

/// Sensor whose laser is shared by `sensors` pixels instead of 32,000, so each gets 1 / sensors of the light
/// (Eq. 3.3). Background is unchanged, since it depends on a pixel's own field of view.
SensorModel with_sensors(const SensorModel& sensor, double sensors);

/// Margin of a read-out to the customers' limits (thesis 3.4) from 0.2 to 3 m.
struct ArrayMargin {
  std::string estimator;
  std::string title;
  double sensors;
  double by_precision;  ///< largest relative precision / limit over the distances; at most 1: limits met
  double by_rmse;       ///< largest (rmse after the look-up table / distance) / limit; at most 1: limits met
};

/// Margins of every estimator for each number of sensors, sorted by estimator.
std::vector<ArrayMargin> array_margins(StudySettings settings, std::span<const double> sensors);

struct LargestArray {
  double sensors;   ///< largest number tried that meets the limits; 0: none does
  double too_many;  ///< next larger number tried, which fails; 0: the largest tried meets the limits
};
/// Largest array by the figure `margin`. `margins` must belong to one estimator.
LargestArray largest_array(std::span<const ArrayMargin> margins, double ArrayMargin::*margin);

}  // namespace dtof
