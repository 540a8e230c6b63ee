// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace dtof {

/// Two-sided confidence interval.
struct Interval {
  double low = 0.0;
  double high = 0.0;

  bool operator==(const Interval&) const = default;
};

inline constexpr double kConfidenceLevel = 0.95;
/// With fewer outliers than this, a sample does not show how many there are and how far they lie.
inline constexpr std::uint64_t kFewOutliers = 10;

/// A figure from a random sample with its confidence interval.
struct Estimate {
  double value = 0.0;
  Interval interval;
  /// Set where fewer than kFewOutliers outliers were seen. `interval` then takes outliers to be like those
  /// seen (none, if none was); this one holds whatever the outliers are that were too rare to be seen.
  std::optional<Interval> with_unseen = std::nullopt;

  /// Half the interval's width over the value; 0 for a value of 0 with an interval of width 0.
  [[nodiscard]] double relative_half_width() const;
  /// Half the interval's width in units of the normal distribution's quantile.
  [[nodiscard]] double standard_error() const;
  /// The interval that holds the true figure at kConfidenceLevel: with_unseen where it is set.
  [[nodiscard]] const Interval& covering() const { return with_unseen ? *with_unseen : interval; }

  bool operator==(const Estimate&) const = default;
};

/// Which values of a sample are outliers: more than six robust standard deviations (quartile range / 1.349)
/// from the median. One value in 5e8 of a normal distribution is.
struct Outliers {
  std::vector<bool> is_outlier;  ///< of each value
  std::uint64_t count = 0;
};
Outliers find_outliers(std::span<const double> values);

// All intervals are closed forms at kConfidenceLevel for independent values. Values must be finite
// (InputError otherwise).

/// Mean, with Student's t. At least 2 values.
Estimate estimate_mean(std::span<const double> values);

/// Difference of two independent means over `distance` != 0: the slope between two points of a sweep. The
/// interval is formed from the means' own (MOVER, Zou and Donner 2008).
Estimate estimate_slope(const Estimate& first, const Estimate& second, double distance);

/// Standard deviation (n - 1 in the denominator). The variance's standard error follows from the fourth
/// moment, so that outliers widen the interval; delta method on the logarithm, so that it stays above 0.
/// At least 4 values.
Estimate estimate_standard_deviation(std::span<const double> values);

/// Root of the mean square, likewise by the standard error of the squares. At least 2 values.
Estimate estimate_root_mean_square(std::span<const double> values);

// The same three figures of a sample that may hold rare outliers. With kFewOutliers or more, the intervals
// above. With fewer, the other values and the outliers are two populations: the former have the intervals
// above, the latter's share has Clopper and Pearson's exact interval (1934), and a hybrid interval of their
// sum is formed (MOVER, Zou and Donner 2008). `interval` has the outliers' mean size as seen; in
// `with_unseen` they may lie anywhere in `range`, which is physics and must hold all values that can occur.
// `outliers` may be those of another figure of the same measurements. Throws InputError unless it is as long
// as `values`. Samples of fewer than 8 values have the intervals above.
Estimate estimate_mean(std::span<const double> values, const Outliers& outliers, const Interval& range);
Estimate estimate_standard_deviation(std::span<const double> values, const Outliers& outliers,
                                     const Interval& range);
Estimate estimate_root_mean_square(std::span<const double> values, const Outliers& outliers,
                                   const Interval& range);

/// Share of `successes` among `trials` >= 1, with Wilson's score interval (1927). Throws InputError if there
/// are more successes than trials.
Estimate estimate_share(std::uint64_t successes, std::uint64_t trials);

/// The same of events that may be rare: with fewer than kFewOutliers successes or failures the interval is
/// Clopper and Pearson's, which is exact, and `with_unseen` is set to it.
Estimate estimate_rare_share(std::uint64_t successes, std::uint64_t trials);

/// Share of pixels over frames (or seeds) of equally many pixels, from each frame's own share, at least 2.
/// Pixels of a frame may hang together, frames do not: the interval is that of the frames' mean, and at least
/// Wilson's for independent pixels, which holds where no frame has an event.
Estimate estimate_share_of_frames(std::span<const double> frames, std::uint64_t pixels_of_a_frame);

/// numerator / estimate: the interval's ends change places. `numerator` >= 0; infinite where the estimate is
/// 0.
Estimate reciprocal(double numerator, const Estimate& estimate);

}  // namespace dtof
