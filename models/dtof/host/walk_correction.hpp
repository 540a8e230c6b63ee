// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dtof/host/range_converter.hpp"

namespace dtof {

/// Corrects walk error on the host. With pile-up a bright target's pulse arrives early, so a look-up table
/// fitted at one brightness is biased at others. Confidence often grows with brightness. For each class of
/// confidence this object holds the table's mean error over distance and subtracts it. Errors are linear in
/// distance and in confidence between nodes.
class WalkCorrection {
 public:
  static constexpr std::size_t kClasses = 16;

  /// Fits the correction to `runs`: targets at several distances, with several reflectivities at each
  /// distance. Runs of equal distance are taken together. A measurement counts if `table` puts it within
  /// `found_within_m` of the true distance; others missed the target.
  ///
  /// Classes hold about equally many measurements. Equal confidences stay in one class, so a confidence with
  /// few values makes few classes. At a distance, a class needs 20 measurements and ignores runs of which it
  /// holds less than a tenth. Mean errors are shrunk by their own uncertainty, so noise is not corrected.
  ///
  /// Throws InputError for a confidence that is not finite or `found_within_m` not above 0.
  static WalkCorrection calibrate(std::span<const TargetRun> runs, const RangeConverter& table,
                                  double found_within_m);

  /// Corrected distance in m. The last node holds beyond a class's nodes, the last class beyond the classes.
  [[nodiscard]] double distance(const Measurement& measurement) const;

  /// Number of classes with a correction; 0: distances are the table's.
  [[nodiscard]] std::size_t classes() const { return classes_.size(); }

 private:
  struct Node {
    double distance_m;  ///< distance by the table
    double error_m;     ///< mean error of the table there
  };
  struct Class {
    double confidence;  ///< median confidence of the class
    std::vector<Node> nodes;
    [[nodiscard]] double error_m(double distance_m) const;
  };
  WalkCorrection(RangeConverter table, std::vector<Class> classes);

  RangeConverter table_;
  std::vector<Class> classes_;  // confidence strictly ascending
};

}  // namespace dtof
