// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/range_converter.hpp"

namespace dtof {

/// Corrects walk error on the host: with pile-up a bright target's pulse arrives early, so that one look-up
/// table for all brightnesses is wrong for most. A read-out whose confidence grows with brightness tells
/// which table to take: this one has a table for each class of confidence, fitted on targets of several
/// reflectivities, and interpolates between the classes.
class WalkCorrection {
 public:
  static constexpr std::size_t kClasses = 12;

  /// `runs`: targets at several distances, each distance with several reflectivities; runs of one distance
  /// are taken together. Classes hold about equally many measurements; equal confidences are never parted, so
  /// a confidence with few values makes few classes. A class ignores a run of which it holds less than a
  /// tenth (those are its outliers), and has a table if two distances are left. `code_step` as
  /// RangeConverter::calibrate. Throws InputError for runs that RangeConverter::calibrate refuses, or if no
  /// class has a table.
  static WalkCorrection calibrate(std::span<const TargetRun> runs, double code_step = 1.0);

  /// Distance in m: linear in confidence between the tables of neighbouring classes, those at the ends
  /// beyond.
  [[nodiscard]] double distance(const Measurement& measurement) const;

  /// Classes that have a table, at least one.
  [[nodiscard]] std::size_t classes() const { return classes_.size(); }

 private:
  struct Class {
    double confidence;  ///< median of its measurements
    RangeConverter table;
  };
  explicit WalkCorrection(std::vector<Class> classes);

  std::vector<Class> classes_;  // confidence strictly ascending
};

}  // namespace dtof
