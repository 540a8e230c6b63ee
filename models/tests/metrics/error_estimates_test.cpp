// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/error_estimates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "dtof/metrics/error_statistics.hpp"

namespace dtof {
namespace {

TEST(ErrorEstimates, ValuesAreThoseOfTheSummary) {
  std::vector<double> measured(30, 2.0);
  measured.insert(measured.end(), {2.01, 1.99, 2.07, 1.93, 2.3, 1.5, 6.0, 0.1});
  const std::vector<double> truth(measured.size(), 2.0);
  const ErrorSummary summary = summarise_errors(truth, measured);
  const ErrorEstimates estimates = estimate_errors(2.0, measured, {0.0, 7.0});
  EXPECT_NEAR(estimates.relative_precision.value, summary.relative_precision, 1e-12);
  EXPECT_NEAR(estimates.bias_m.value, summary.bias_m, 1e-12);
  EXPECT_NEAR(estimates.rmse_m.value, summary.rmse_m, 1e-12);
  EXPECT_NEAR(estimates.above_3_percent.value, summary.share_above_3_percent, 1e-12);
  EXPECT_NEAR(estimates.outlier_rate.value, summary.share_above_10_percent, 1e-12);
  EXPECT_EQ(estimates.far_from_others, 8U);  // the quartiles are equal: whatever is not the median is far
}

TEST(ErrorEstimates, UnseenOutliersReachTheEndsOfTheRange) {
  const std::vector<double> measured = {1.99, 2.0, 2.01, 2.02, 1.98, 2.0, 2.01, 1.99, 2.0, 2.0};
  const ErrorEstimates estimates = estimate_errors(2.0, measured, {-0.5, 6.0});
  EXPECT_EQ(estimates.far_from_others, 0U);
  const double most = 1.0 - std::pow(0.025, 0.1);
  EXPECT_NEAR(estimates.rmse_m.with_unseen->high, 4.0 * std::sqrt(most), 0.01);
  EXPECT_NEAR(estimates.relative_precision.with_unseen->high, 2.0 * std::sqrt(most), 0.01);
  EXPECT_NEAR(estimates.bias_m.with_unseen->low, -2.5 * most, 0.02);
  EXPECT_NEAR(estimates.bias_m.with_unseen->high, 4.0 * most, 0.02);
}

}  // namespace
}  // namespace dtof
