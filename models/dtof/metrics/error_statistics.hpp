// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dtof {

/// Running mean and variance (Welford 1962); merging after Chan et al. 1979.
class RunningMoments {
 public:
  void add(double value);
  void merge(const RunningMoments& other);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// Mean; 0 without values.
  [[nodiscard]] double mean() const { return mean_; }
  /// Variance with n - 1 in the denominator; never negative, 0 for fewer than two values.
  [[nodiscard]] double variance() const;
  /// Mean of the squared values.
  [[nodiscard]] double mean_square() const;

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0.0;
  double squared_deviations_ = 0.0;
};

/// Error figures of measured distances (spec section 5).
struct ErrorSummary {
  std::uint64_t count;
  double relative_precision;      ///< standard deviation of |measured - true| / true (Eq. 3.14)
  double bias_m;                  ///< mean of measured - true
  double standard_deviation_m;    ///< standard deviation of measured - true
  double rmse_m;                  ///< sqrt of the mean of (measured - true)^2
  double share_above_3_percent;   ///< share of pixels with |measured - true| > 3 % of true
  double share_above_10_percent;  ///< outlier rate: share with |measured - true| > 10 % of true
};

/// Accumulates errors in constant memory. Parts from several threads can be merged.
class ErrorStatistics {
 public:
  /// Adds one pair of distances in m. Throws InputError unless both are finite and `true_m` > 0.
  void add(double true_m, double measured_m);
  void merge(const ErrorStatistics& other);

  [[nodiscard]] std::uint64_t count() const { return error_.count(); }
  /// Figures of all pairs added. Throws InputError if there is none.
  [[nodiscard]] ErrorSummary summary() const;

 private:
  RunningMoments error_;
  RunningMoments relative_error_;
  std::uint64_t above_3_percent_ = 0;
  std::uint64_t above_10_percent_ = 0;
};

/// Figures of pairs of distances in m. Throws InputError for sets of different lengths, for empty sets, and
/// as ErrorStatistics does.
ErrorSummary summarise_errors(std::span<const double> true_m, std::span<const double> measured_m);

/// Median; the upper of the two middle values. Throws InputError without values.
double median(std::vector<double> values);

struct LinearFit {
  double slope;
  double intercept;
};

/// Least-squares line y = slope x + intercept, e.g. of measured against true distance. Throws InputError
/// unless both sets are finite, equally long and hold at least two different x.
LinearFit fit_line(std::span<const double> x, std::span<const double> y);

}  // namespace dtof
