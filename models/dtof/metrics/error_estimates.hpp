// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "dtof/metrics/confidence_interval.hpp"

namespace dtof {

inline constexpr double kRequirement = 0.03;   ///< largest relative error that the requirement allows
inline constexpr double kOutlierError = 0.10;  ///< relative error above which a result is worthless

/// Error figures, with intervals, of independent measurements of one target (spec section 5).
struct ErrorEstimates {
  Estimate relative_precision;  ///< standard deviation of |measured - true| / true (Eq. 3.14)
  Estimate bias_m;
  Estimate rmse_m;
  Estimate above_3_percent;  ///< share of errors above kRequirement
  Estimate outlier_rate;     ///< share of errors above kOutlierError
  /// Number of outliers by find_outliers, on which the intervals of the first three figures are based. Not
  /// the same as errors above 10 %: near targets may have such errors without outliers.
  std::uint64_t far_from_others = 0;
};

/// `range_m`: all distances that can be measured, m. Throws InputError as the interval functions do.
ErrorEstimates estimate_errors(double true_m, std::span<const double> measured_m, const Interval& range_m);

}  // namespace dtof
