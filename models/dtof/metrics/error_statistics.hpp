// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dtof {

/// Mean and variance of a sequence, one value at a time (Welford 1962); merging after Chan et al. 1979.
class RunningMoments {
 public:
  void add(double value);
  void merge(const RunningMoments& other);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// 0 for no values.
  [[nodiscard]] double mean() const { return mean_; }
  /// With n - 1 in the denominator; 0 for fewer than two values. Never negative.
  [[nodiscard]] double variance() const;
  /// Mean of the squared values.
  [[nodiscard]] double mean_square() const;

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0.0;
  double squared_deviations_ = 0.0;
};

/// Errors of a set of measured distances (spec section 5).
struct ErrorSummary {
  std::uint64_t count;
  double relative_precision;      ///< standard deviation of |measured - true| / true (Eq. 3.14)
  double bias_m;                  ///< mean of measured - true
  double standard_deviation_m;    ///< of measured - true
  double rmse_m;                  ///< sqrt of the mean of (measured - true)^2
  double share_above_3_percent;   ///< share of |measured - true| > 3 % of true
  double share_above_10_percent;  ///< outlier rate
};

/// Collects errors in constant memory; parts collected by several threads are merged.
class ErrorStatistics {
 public:
  /// Distances in m. Throws InputError unless both are finite and `true_m` is above 0.
  void add(double true_m, double measured_m);
  void merge(const ErrorStatistics& other);

  [[nodiscard]] std::uint64_t count() const { return error_.count(); }
  /// Throws InputError if nothing was added.
  [[nodiscard]] ErrorSummary summary() const;

 private:
  RunningMoments error_;
  RunningMoments relative_error_;
  std::uint64_t above_3_percent_ = 0;
  std::uint64_t above_10_percent_ = 0;
};

/// Summary of equally long, non-empty sets; throws InputError as ErrorStatistics does.
ErrorSummary summarise_errors(std::span<const double> true_m, std::span<const double> measured_m);

/// Middle value, the upper one of two. Throws InputError if there is none.
double median(std::vector<double> values);

struct LinearFit {
  double slope;
  double intercept;
};

/// Least-squares line y = slope x + intercept, e.g. of measured against true distance. Throws InputError
/// unless the sets are equally long and finite and hold at least two different x.
LinearFit fit_line(std::span<const double> x, std::span<const double> y);

}  // namespace dtof
