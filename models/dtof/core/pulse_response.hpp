// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace dtof {

/// A measured pulse: probability density of a signal event's time, constant within equal bins, with its
/// centroid at time 0. The unit of time is the caller's.
class PulseResponse {
 public:
  /// `samples`: counts (or proportional values) of neighbouring bins of `bin_width` > 0. 1 to 1,000,000
  /// finite values, each at least 0, not all 0. Zeros at both ends are cut off. Throws InputError for other
  /// values.
  PulseResponse(std::vector<double> samples, double bin_width);

  /// Share of the pulse before `time`, 0 .. 1.
  [[nodiscard]] double share_before(double time) const;
  /// Inverse of share_before: the time before which `share` (0 .. 1) of the pulse lies.
  [[nodiscard]] double quantile(double share) const;
  /// Bounds of the pulse: all of it lies in [begin, end).
  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] double end() const;

  [[nodiscard]] double standard_deviation() const;
  /// Distance between the outermost crossings of half the maximum density.
  [[nodiscard]] double full_width_at_half_maximum() const;

  /// Copy with all times multiplied by `factor` > 0, e.g. to change the unit.
  [[nodiscard]] PulseResponse scaled(double factor) const;
  /// Copy convolved with a normal distribution of standard deviation `sigma` >= 0, cut at 6 sigma, with the
  /// same bin width. The variances add. A sigma below 0.29 bins changes nothing.
  [[nodiscard]] PulseResponse broadened(double sigma) const;

 private:
  double bin_width_;
  double begin_ = 0.0;
  std::vector<double> shares_;      // of each bin
  std::vector<double> cumulative_;  // before each bin, and 1 at the end
};

}  // namespace dtof
