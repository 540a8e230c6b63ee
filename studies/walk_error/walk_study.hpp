// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Settings of a study of walk error: flat targets of several reflectivities, with a look-up table calibrated
/// at one of them.
struct WalkSettings {
  SensorModel sensor;
  double klux = 14.0;
  std::vector<ReadoutParameters> readouts;
  std::vector<double>
      reflectivities;  ///< judged, above 0; the correction is fitted on others between their ends
  std::vector<double> distances_m;  ///< judged, above 0
  int columns = 8;                  ///< columns of 160 pixels for each reflectivity and distance, at least 4
  std::uint64_t seed = 1;
  int threads = 0;
};

/// Errors with one conversion to distances. Bias and rmse cover the pixels that found the target: their
/// distance by the table is within the pulse's width (c/2 FWHM) of the true distance. Intervals follow from
/// the columns' means, which are independent for every read-out.
struct WalkErrors {
  Estimate bias_m;
  double rmse_m = 0.0;
  double above_3_percent = 0.0;
  double above_10_percent = 0.0;
};

/// Figures of one read-out at one reflectivity and distance.
struct WalkPoint {
  double reflectivity = 0.0;
  double distance_m = 0.0;
  double found = 0.0;   ///< share of pixels that found the target
  bool judged = false;  ///< true if at least half of each column's pixels found the target
  WalkErrors before;    ///< with the table at the sensor's default reflectivity (FlatCalibration)
  WalkErrors after;     ///< with WalkCorrection by the result's confidence
};

struct WalkReadout {
  std::string name;
  std::string title;
  std::size_t classes;  ///< confidence classes of the correction
  double at_top;        ///< share of the correction's calibration results with the largest confidence
  std::vector<WalkPoint> points;  ///< by reflectivity, then by distance

  [[nodiscard]] std::size_t judged() const;
  /// Walk in m: the largest minus the smallest bias over the judged reflectivities of a distance, as root
  /// mean square over the distances with at least two of them; 0 without such distances. A correction that
  /// shifts all reflectivities equally does not change it.
  [[nodiscard]] double walk_before_m() const;
  [[nodiscard]] double walk_after_m() const;
  /// Root mean square of the judged points' biases, m; 0 without judged points.
  [[nodiscard]] double rms_bias_before_m() const;
  [[nodiscard]] double rms_bias_after_m() const;
  /// Number of points whose |bias| is smaller after the correction (next function: larger), beyond both
  /// intervals.
  [[nodiscard]] std::size_t better() const;
  [[nodiscard]] std::size_t worse() const;
};

/// Runs the study. Table, correction and judgement each use their own frame. Throws InputError for settings
/// out of range.
std::vector<WalkReadout> run_walk_study(const WalkSettings& settings);

}  // namespace dtof
