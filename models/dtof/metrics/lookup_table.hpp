// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace dtof {

/// Code position (bins) of one calibration measurement, or the mean of a group, and its true distance (m).
struct CalibrationPoint {
  double position = 0.0;
  double distance_m = 0.0;
  double weight = 1.0;  ///< > 0, e.g. the reciprocal of the position's variance

  bool operator==(const CalibrationPoint&) const = default;
};

/// The host's monotone table from code position to distance (thesis section 3.4).
class LookupTable {
 public:
  /// Isotonic least-squares regression of distance on position (pool adjacent violators). Each pool becomes
  /// one knot at its mean position (centred isotonic regression, Oron and Flournoy 2017), so that a flat part
  /// of the fit stays a point and positions around it are still told apart.
  ///
  /// Points in any order, repeated positions allowed. Outlying positions pull the fit as in any least-squares
  /// regression: calibrate with the median or mean position per distance where a read-out has outliers.
  /// Throws InputError for fewer than two points, a value that is not finite or a weight that is not above 0.
  static LookupTable fit(std::span<const CalibrationPoint> points);

  /// Distance in m: linear between knots; beyond both ends the line continues with the table's mean slope
  /// (constant if the fit left one knot only).
  [[nodiscard]] double distance(double position) const;

  /// Strictly ascending in position and in distance; at least one. Weights are the pools'.
  [[nodiscard]] const std::vector<CalibrationPoint>& knots() const { return knots_; }

 private:
  explicit LookupTable(std::vector<CalibrationPoint> knots);

  std::vector<CalibrationPoint> knots_;
  double mean_slope_ = 0.0;
};

}  // namespace dtof
