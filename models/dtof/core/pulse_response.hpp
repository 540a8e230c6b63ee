// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace dtof {

/// A measured pulse: the density of a signal event's time, constant within equal bins, its centroid at time
/// 0. Any unit of time.
class PulseResponse {
 public:
  /// `samples`: counts, or any measure in proportion, of neighbouring bins of `bin_width` (> 0); 1 to
  /// 1,000,000 finite values of at least 0, not all 0. Zeros at both ends are cut off. Throws InputError.
  PulseResponse(std::vector<double> samples, double bin_width);

  /// Share of the pulse before `time`, 0 .. 1.
  [[nodiscard]] double share_before(double time) const;
  /// Its inverse: the time before which `share` (0 .. 1) of the pulse lies.
  [[nodiscard]] double quantile(double share) const;
  /// Nothing of the pulse is outside [begin, end).
  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] double end() const;

  [[nodiscard]] double standard_deviation() const;
  /// Between the outermost places where the density passes half its maximum.
  [[nodiscard]] double full_width_at_half_maximum() const;

  /// Times multiplied by `factor` > 0, e.g. into another unit.
  [[nodiscard]] PulseResponse scaled(double factor) const;
  /// Convolved with a normal distribution of this standard deviation >= 0, cut at 6 of them, on bins of the
  /// same width; the variance is the sum of both. A sigma of less than 0.29 bins changes nothing.
  [[nodiscard]] PulseResponse broadened(double sigma) const;

 private:
  double bin_width_;
  double begin_ = 0.0;
  std::vector<double> shares_;      // of each bin
  std::vector<double> cumulative_;  // before each bin, and 1 at the end
};

}  // namespace dtof
