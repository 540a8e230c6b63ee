// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace dtof {

/// Code position (bins) of one calibration measurement, or the mean of several, and its true distance (m).
struct CalibrationPoint {
  double position = 0.0;
  double distance_m = 0.0;
  double weight = 1.0;  ///< > 0, e.g. the reciprocal of the position's variance

  bool operator==(const CalibrationPoint&) const = default;
};

/// Monotone table of the host from code position to distance (thesis section 3.4).
class LookupTable {
 public:
  /// Fits an isotonic least-squares regression of distance on position (pool adjacent violators). Each pool
  /// becomes one knot at its mean position (centred isotonic regression, Oron and Flournoy 2017). So a flat
  /// part of the fit is a single point, and positions around it still map to different distances.
  ///
  /// `points` may be in any order and repeat positions. Outlying positions distort the fit as in any
  /// least-squares regression: if a read-out has outliers, calibrate with the median position per distance.
  /// Throws InputError for fewer than two points, a value that is not finite or a weight that is not above 0.
  static LookupTable fit(std::span<const CalibrationPoint> points);

  /// Distance in m, linear between knots. Beyond both ends the line continues with the table's mean slope, or
  /// stays constant if the table has one knot.
  [[nodiscard]] double distance(double position) const;

  /// Knots, strictly ascending in position and distance, at least one. The weight of a knot is that of its
  /// pool.
  [[nodiscard]] const std::vector<CalibrationPoint>& knots() const { return knots_; }

 private:
  explicit LookupTable(std::vector<CalibrationPoint> knots);

  std::vector<CalibrationPoint> knots_;
  double mean_slope_ = 0.0;
};

}  // namespace dtof
