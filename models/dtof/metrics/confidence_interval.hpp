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
/// With fewer outliers than this, a sample shows neither their share nor their size reliably.
inline constexpr std::uint64_t kFewOutliers = 10;

/// A figure estimated from a random sample, with its confidence interval.
struct Estimate {
  double value = 0.0;
  Interval interval;
  /// Set if the sample has fewer than kFewOutliers outliers. `interval` then assumes that all outliers
  /// resemble those in the sample. This wider interval also allows outliers that were too rare to appear.
  std::optional<Interval> with_unseen = std::nullopt;

  /// Half the interval's width divided by the value; 0 if value and width are 0.
  [[nodiscard]] double relative_half_width() const;
  /// Standard error: half the interval's width divided by the normal distribution's quantile.
  [[nodiscard]] double standard_error() const;
  /// Interval that holds the true figure at kConfidenceLevel: with_unseen if it is set, else interval.
  [[nodiscard]] const Interval& covering() const { return with_unseen ? *with_unseen : interval; }

  bool operator==(const Estimate&) const = default;
};

/// Outliers of a sample: values more than six robust standard deviations (quartile range / 1.349) from the
/// median. In a normal distribution one value in 5e8 is an outlier.
struct Outliers {
  std::vector<bool> is_outlier;  ///< for each value
  std::uint64_t count = 0;
};
Outliers find_outliers(std::span<const double> values);

// All intervals are closed forms at kConfidenceLevel for independent values. All functions throw InputError
// for values that are not finite or fewer values than stated.

/// Mean with Student's t interval. At least 2 values.
Estimate estimate_mean(std::span<const double> values);

/// Slope between two points of a sweep: difference of two independent means divided by `distance` != 0. The
/// interval combines the means' intervals (MOVER, Zou and Donner 2008).
Estimate estimate_slope(const Estimate& first, const Estimate& second, double distance);

/// Standard deviation (n - 1 in the denominator). At least 4 values. The standard error of the variance
/// follows from the fourth moment, so outliers widen the interval. The delta method is applied to the
/// logarithm, so the interval stays above 0.
Estimate estimate_standard_deviation(std::span<const double> values);

/// Root mean square; the interval follows from the standard error of the squares. At least 2 values.
Estimate estimate_root_mean_square(std::span<const double> values);

// The three figures above for a sample that may hold rare outliers.
// With kFewOutliers outliers or more, or fewer than 8 values, the intervals are those above. Otherwise
// outliers and other values are two populations. The others have the intervals above, and the outliers' share
// has the exact interval of Clopper and Pearson (1934). Both are combined to a hybrid interval (MOVER, Zou
// and Donner 2008).
// `interval` uses the outliers' mean size in the sample. In `with_unseen` outliers may lie anywhere in
// `range`, which must contain every value that is physically possible.
// `outliers` may come from another figure of the same measurements. Throws InputError unless it is as long as
// `values`.
Estimate estimate_mean(std::span<const double> values, const Outliers& outliers, const Interval& range);
Estimate estimate_standard_deviation(std::span<const double> values, const Outliers& outliers,
                                     const Interval& range);
Estimate estimate_root_mean_square(std::span<const double> values, const Outliers& outliers,
                                   const Interval& range);

/// Share of `successes` among `trials` >= 1, with Wilson's score interval (1927). Throws InputError if
/// successes exceed trials.
Estimate estimate_share(std::uint64_t successes, std::uint64_t trials);

/// Share of events that may be rare. With fewer than kFewOutliers successes or failures, `interval` is the
/// exact interval of Clopper and Pearson (1934), and `with_unseen` equals it; otherwise as estimate_share.
Estimate estimate_rare_share(std::uint64_t successes, std::uint64_t trials);

/// Share of pixels over several frames (or seeds), at least 2, from the share in each frame. Pixels of one
/// frame may be correlated, frames are independent. The interval is that of the mean over frames, but never
/// narrower than Wilson's interval for independent pixels, which matters if no frame has an event.
Estimate estimate_share_of_frames(std::span<const double> frames, std::uint64_t pixels_of_a_frame);

/// numerator / estimate; the ends of the interval change places. `numerator` >= 0. Infinite where the
/// estimate is 0.
Estimate reciprocal(double numerator, const Estimate& estimate);

}  // namespace dtof
