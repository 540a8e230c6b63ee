// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/error_estimates.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dtof {

ErrorEstimates estimate_errors(double true_m, std::span<const double> measured_m, const Interval& range_m) {
  std::vector<double> errors;
  std::vector<double> relative;
  errors.reserve(measured_m.size());
  relative.reserve(measured_m.size());
  std::uint64_t above_3_percent = 0;
  std::uint64_t above_10_percent = 0;
  for (const double measured : measured_m) {
    errors.push_back(measured - true_m);
    relative.push_back(std::abs(errors.back()) / true_m);
    above_3_percent += relative.back() > kRequirement ? 1 : 0;
    above_10_percent += relative.back() > kOutlierError ? 1 : 0;
  }
  const Outliers outliers = find_outliers(errors);
  const Interval error_range{range_m.low - true_m, range_m.high - true_m};
  const double farthest = std::max(std::abs(error_range.low), std::abs(error_range.high)) / true_m;
  return {.relative_precision = estimate_standard_deviation(relative, outliers, {0.0, farthest}),
          .bias_m = estimate_mean(errors, outliers, error_range),
          .rmse_m = estimate_root_mean_square(errors, outliers, error_range),
          .above_3_percent = estimate_rare_share(above_3_percent, measured_m.size()),
          .outlier_rate = estimate_rare_share(above_10_percent, measured_m.size()),
          .far_from_others = outliers.count};
}

}  // namespace dtof
