// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace dtof {

/// Two-sided confidence interval.
struct Interval {
  double low = 0.0;
  double high = 0.0;

  bool operator==(const Interval&) const = default;
};

/// A figure from a random sample with its confidence interval.
struct Estimate {
  double value = 0.0;
  Interval interval;

  /// Half the interval's width over the value; 0 for a value of 0 with an interval of width 0.
  [[nodiscard]] double relative_half_width() const;

  bool operator==(const Estimate&) const = default;
};

inline constexpr double kConfidenceLevel = 0.95;

// All intervals are closed forms at kConfidenceLevel for independent values. Values must be finite
// (InputError otherwise).

/// Mean, with Student's t. At least 2 values.
Estimate estimate_mean(std::span<const double> values);

/// Difference of two independent means over `distance` != 0, with Welch's standard error and normal quantile:
/// the slope between two points of a sweep. At least 2 values each.
Estimate estimate_slope(std::span<const double> first, std::span<const double> second, double distance);

/// Standard deviation (n - 1 in the denominator). The variance's standard error follows from the fourth
/// moment, so that outliers widen the interval; delta method on the logarithm, so that it stays above 0.
/// At least 4 values.
Estimate estimate_standard_deviation(std::span<const double> values);

/// Root of the mean square, likewise by the standard error of the squares. At least 2 values.
Estimate estimate_root_mean_square(std::span<const double> values);

/// Share of `successes` among `trials` >= 1, with Wilson's score interval (1927). Throws InputError if there
/// are more successes than trials.
Estimate estimate_share(std::uint64_t successes, std::uint64_t trials);

/// numerator / estimate: the interval's ends change places. `numerator` >= 0; infinite where the estimate is
/// 0.
Estimate reciprocal(double numerator, const Estimate& estimate);

}  // namespace dtof
