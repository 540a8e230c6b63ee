// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dtof/host/range_converter.hpp"

namespace dtof {

/// Corrects walk error on the host: with pile-up a bright target's pulse arrives early, so that a look-up
/// table that was fitted at one brightness is biased at others. Where a read-out's confidence grows with
/// brightness it tells how much: for each class of confidence this has the table's mean error over distance,
/// which it takes from the table's distances, linear in distance and in confidence between its nodes.
class WalkCorrection {
 public:
  static constexpr std::size_t kClasses = 16;

  /// `runs`: targets at several distances, each distance with several reflectivities; runs of one distance
  /// are taken together. Only measurements that `table` puts within `found_within_m` of the truth count: the
  /// others missed the target. Classes hold about equally many measurements, and equal confidences are never
  /// parted, so a confidence with few values makes few classes. At a distance, a class ignores runs of which
  /// it holds less than a tenth, and needs 20 measurements. Mean errors are shrunk by their own uncertainty,
  /// so that what is not known is not corrected. Throws InputError for a confidence that is not finite or a
  /// window that is not above 0.
  static WalkCorrection calibrate(std::span<const TargetRun> runs, const RangeConverter& table,
                                  double found_within_m);

  /// Distance in m. Beyond a class's nodes its last one holds, beyond the classes the last class.
  [[nodiscard]] double distance(const Measurement& measurement) const;

  /// Classes that correct anything; with none, distances are the table's.
  [[nodiscard]] std::size_t classes() const { return classes_.size(); }

 private:
  struct Node {
    double distance_m;  ///< by the table
    double error_m;     ///< its mean error there
  };
  struct Class {
    double confidence;  ///< median of its measurements
    std::vector<Node> nodes;
    [[nodiscard]] double error_m(double distance_m) const;
  };
  WalkCorrection(RangeConverter table, std::vector<Class> classes);

  RangeConverter table_;
  std::vector<Class> classes_;  // confidence strictly ascending
};

}  // namespace dtof
