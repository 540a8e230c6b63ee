// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "accuracy/accuracy_study.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

inline constexpr double kThesisSensors = 32000.0;

/// The laser's light shared by `sensors` instead of 32,000 (Eq. 3.3: each gets 1 / sensors of it). Background
/// stays: it comes by a sensor's own field of view.
SensorModel with_sensors(const SensorModel& sensor, double sensors);

/// How far a read-out is within the customers' limits (thesis 3.4) from 0.2 to 3 m.
struct ArrayMargin {
  std::string estimator;
  std::string title;
  double sensors;
  double by_precision;  ///< largest relative precision / limit over the distances; at most 1 meets them
  double by_rmse;       ///< the same of rmse after the look-up table over distance
};

/// Margins of every estimator for each number of sensors, estimator by estimator.
std::vector<ArrayMargin> array_margins(StudySettings settings, std::span<const double> sensors);

struct LargestArray {
  double sensors;   ///< largest of those tried that meets the limits; 0: none does
  double too_many;  ///< next larger one tried, which does not; 0: the largest tried meets them
};
/// `margin` picks the figure. `margins` are one estimator's.
LargestArray largest_array(std::span<const ArrayMargin> margins, double ArrayMargin::*margin);

}  // namespace dtof
