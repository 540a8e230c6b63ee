// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/error_shares.hpp"

#include <cmath>

namespace dtof {

void ErrorShareCounter::add(double true_m, double measured_m) {
  statistics_.add(true_m, measured_m);
  relative_error_.add((measured_m - true_m) / true_m);
}

ErrorShares ErrorShareCounter::shares() const {
  if (statistics_.count() == 0) {
    return {};
  }
  const ErrorSummary summary = statistics_.summary();
  return {statistics_.count(), summary.share_above_3_percent, summary.share_above_10_percent,
          std::sqrt(relative_error_.mean_square())};
}

ErrorShares pooled(std::span<const ErrorShares> parts) {
  ErrorShares sum;
  double squares = 0.0;
  for (const ErrorShares& part : parts) {
    const auto pixels = static_cast<double>(part.pixels);
    sum.pixels += part.pixels;
    sum.above_3_percent += part.above_3_percent * pixels;
    sum.above_10_percent += part.above_10_percent * pixels;
    squares += part.rmse * part.rmse * pixels;
  }
  if (sum.pixels > 0) {
    const auto pixels = static_cast<double>(sum.pixels);
    sum.above_3_percent /= pixels;
    sum.above_10_percent /= pixels;
    sum.rmse = std::sqrt(squares / pixels);
  }
  return sum;
}

}  // namespace dtof
