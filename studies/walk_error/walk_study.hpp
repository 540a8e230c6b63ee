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

/// Walk error: flat targets of several reflectivities, judged with a look-up table that is calibrated at one.
struct WalkSettings {
  SensorModel sensor;
  double klux = 14.0;
  std::vector<ReadoutParameters> readouts;
  std::vector<double>
      reflectivities;  ///< judged, above 0; the correction is fitted on others between their ends
  std::vector<double> distances_m;  ///< judged, above 0
  int columns = 8;                  ///< of 160 pixels for each reflectivity and distance, at least 4
  std::uint64_t seed = 1;
  int threads = 0;
};

/// Errors with one way to distances. Bias and rmse are of the pixels that found the target: those whose
/// distance by the table is within the pulse's width (c/2 FWHM) of the truth. Intervals come from the
/// columns' means, which are independent for every read-out.
struct WalkErrors {
  Estimate bias_m;
  double rmse_m = 0.0;
  double above_3_percent = 0.0;
  double above_10_percent = 0.0;
};

/// One read-out at one reflectivity and distance.
struct WalkPoint {
  double reflectivity = 0.0;
  double distance_m = 0.0;
  double found = 0.0;   ///< share of pixels
  bool judged = false;  ///< at least half of each column's pixels found the target
  WalkErrors before;    ///< table at the sensor's default reflectivity (FlatCalibration)
  WalkErrors after;     ///< WalkCorrection by the result's confidence
};

struct WalkReadout {
  std::string name;
  std::string title;
  std::size_t classes;  ///< of confidence that the correction tells apart
  double at_top;        ///< share of the correction's calibration results that have the largest confidence
  std::vector<WalkPoint> points;  ///< reflectivity by reflectivity

  [[nodiscard]] std::size_t judged() const;
  /// The walk itself, m: largest less smallest bias over the judged reflectivities of a distance; root of the
  /// mean square over distances with at least two of them; 0 if there is none. A correction that only moves
  /// all reflectivities alike leaves it as it is.
  [[nodiscard]] double walk_before_m() const;
  [[nodiscard]] double walk_after_m() const;
  /// Root of the mean square of the judged points' biases, m; 0 if none is.
  [[nodiscard]] double rms_bias_before_m() const;
  [[nodiscard]] double rms_bias_after_m() const;
  /// Points where the |bias| is smaller (larger) after the correction, beyond both intervals.
  [[nodiscard]] std::size_t better() const;
  [[nodiscard]] std::size_t worse() const;
};

/// Table, correction and judgement each draw from a frame of their own. Throws InputError for settings out of
/// range.
std::vector<WalkReadout> run_walk_study(const WalkSettings& settings);

}  // namespace dtof
