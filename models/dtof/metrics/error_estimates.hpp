// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "dtof/metrics/confidence_interval.hpp"

namespace dtof {

inline constexpr double kRequirement = 0.03;   ///< relative error
inline constexpr double kOutlierError = 0.10;  ///< relative error above which a result is worthless

/// Errors of independent measurements of one target, with intervals (spec section 5).
struct ErrorEstimates {
  Estimate relative_precision;  ///< standard deviation of |measured - true| / true (Eq. 3.14)
  Estimate bias_m;
  Estimate rmse_m;
  Estimate above_3_percent;  ///< share of errors above kRequirement
  Estimate outlier_rate;     ///< share of errors above kOutlierError
  /// Measurements far from the others (find_outliers): what the first three figures' intervals go by. At near
  /// targets these are fewer than errors above 10 %, which the others may have as well.
  std::uint64_t far_from_others = 0;
};

/// `range_m`: distances that can be measured at all. Throws InputError as the intervals do.
ErrorEstimates estimate_errors(double true_m, std::span<const double> measured_m, const Interval& range_m);

}  // namespace dtof
