// SPDX-License-Identifier: Apache-2.0
#include "metrics/confidence_interval.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "core/error.hpp"
#include "core/random.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

CounterRandom make_random(std::uint32_t stream) {
  return {test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), stream, 0};
}

constexpr int kSets = 4000;  // the standard error of a coverage of 95 % is 0.34 %

// Share of sets whose interval holds the true value.
double coverage(double truth, const std::function<Estimate()>& draw) {
  int covered = 0;
  for (int set = 0; set < kSets; ++set) {
    const Interval interval = draw().interval;
    covered += interval.low <= truth && truth <= interval.high ? 1 : 0;
  }
  return static_cast<double>(covered) / kSets;
}

std::vector<double> normal_values(CounterRandom& random, int count, double sigma = 1.0) {
  std::normal_distribution<double> normal(0.0, sigma);
  std::vector<double> values(static_cast<std::size_t>(count));
  for (double& value : values) {
    value = normal(random);
  }
  return values;
}

TEST(ConfidenceInterval, MeanByHand) {
  const std::vector<double> values = {1.0, 2.0, 3.0};
  const Estimate estimate = estimate_mean(values);
  EXPECT_DOUBLE_EQ(estimate.value, 2.0);
  EXPECT_NEAR(estimate.interval.high - 2.0, 4.302653 / std::sqrt(3.0), 1e-6);  // t(0.975, 2)
  EXPECT_NEAR(estimate.relative_half_width(), 4.302653 / std::sqrt(3.0) / 2.0, 1e-6);
}

TEST(ConfidenceInterval, ShareByHand) {
  // Wilson's interval of 1 in 10, e.g. from R's prop.test without continuity correction.
  const Estimate estimate = estimate_share(1, 10);
  EXPECT_NEAR(estimate.interval.low, 0.017876, 1e-6);
  EXPECT_NEAR(estimate.interval.high, 0.404150, 1e-6);
  EXPECT_EQ(estimate_share(0, 10).interval.low, 0.0);
  EXPECT_EQ(estimate_share(10, 10).interval.high, 1.0);
}

TEST(ConfidenceInterval, StandardDeviationByHand) {
  // Relative variance of the variance: (kurtosis - (n - 3) / (n - 1)) / n, with the powers over n and the
  // unbiased variance.
  const std::vector<double> outlier = {0, 0, 0, 0, 0, 0, 0, 0, 0, 10};  // variance 10, kurtosis 6.57
  const double factor = std::exp(0.5 * 1.959964 * std::sqrt((6.57 - 7.0 / 9.0) / 10.0));
  const Estimate wide = estimate_standard_deviation(outlier);
  EXPECT_NEAR(wide.value, std::sqrt(10.0), 1e-12);
  EXPECT_NEAR(wide.interval.high, std::sqrt(10.0) * factor, 1e-5);
  EXPECT_NEAR(wide.interval.low, std::sqrt(10.0) / factor, 1e-5);
  const std::vector<double> two_points = {-1, -1, -1, -1, -1,
                                          1,  1,  1,  1,  1};  // variance 10 / 9, kurtosis 0.81
  const Estimate narrow = estimate_standard_deviation(two_points);
  EXPECT_NEAR(narrow.interval.high / narrow.value,
              std::exp(0.5 * 1.959964 * std::sqrt((0.81 - 7.0 / 9.0) / 10.0)), 1e-5);
}

TEST(ConfidenceInterval, CoverageOfMeanOfFewValues) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = make_random(1);
  EXPECT_NEAR(coverage(0.0, [&] { return estimate_mean(normal_values(random, 5)); }), 0.95, 0.015);
}

TEST(ConfidenceInterval, CoverageOfSlope) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = make_random(2);
  EXPECT_NEAR(
      coverage(
          0.0,
          [&] { return estimate_slope(normal_values(random, 60), normal_values(random, 30, 3.0), 2.0); }),
      0.95, 0.02);
}

TEST(ConfidenceInterval, CoverageOfStandardDeviationAndRootMeanSquare) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = make_random(3);
  EXPECT_NEAR(coverage(2.0, [&] { return estimate_standard_deviation(normal_values(random, 300, 2.0)); }),
              0.95, 0.015);
  EXPECT_NEAR(coverage(2.0, [&] { return estimate_root_mean_square(normal_values(random, 300, 2.0)); }), 0.95,
              0.015);
}

TEST(ConfidenceInterval, CoverageWithRareOutliers) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = make_random(4);
  // 2 % of 1000 errors are uniform and 100 times as large: what a read-out does near its reach.
  const auto draw = [&] {
    std::vector<double> values = normal_values(random, 1000);
    for (double& value : values) {
      if (random.uniform() < 0.02) {
        value = 200.0 * (random.uniform() - 0.5);
      }
    }
    return values;
  };
  const double sigma = std::sqrt(0.98 + 0.02 * 200.0 * 200.0 / 12.0);
  const double of_deviation = coverage(sigma, [&] { return estimate_standard_deviation(draw()); });
  EXPECT_GT(of_deviation, 0.90);
  EXPECT_LT(of_deviation, 0.97);
  const double of_rms = coverage(sigma, [&] { return estimate_root_mean_square(draw()); });
  EXPECT_GT(of_rms, 0.90);
  EXPECT_LT(of_rms, 0.97);
}

TEST(ConfidenceInterval, CoverageOfSmallShare) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = make_random(5);
  std::binomial_distribution<int> outliers(500, 0.01);
  const double covered =
      coverage(0.01, [&] { return estimate_share(static_cast<std::uint64_t>(outliers(random)), 500); });
  EXPECT_GT(covered, 0.925);
  EXPECT_LT(covered, 0.99);
}

TEST(ConfidenceInterval, EqualValues) {
  const std::vector<double> values(5, 0.1);
  EXPECT_EQ(estimate_standard_deviation(values), (Estimate{0.0, {0.0, 0.0}}));
  EXPECT_EQ(estimate_standard_deviation(values).relative_half_width(), 0.0);
  EXPECT_NEAR(estimate_root_mean_square(values).interval.high, 0.1, 1e-12);
  EXPECT_EQ(estimate_root_mean_square(std::vector<double>(3, 0.0)), (Estimate{0.0, {0.0, 0.0}}));
}

TEST(ConfidenceInterval, ReciprocalSwapsTheEnds) {
  const Estimate inverse = reciprocal(6.0, {3.0, {2.0, 4.0}});
  EXPECT_EQ(inverse, (Estimate{2.0, {1.5, 3.0}}));
}

TEST(ConfidenceInterval, Refusals) {
  const std::vector<double> one = {1.0};
  const std::vector<double> bad = {1.0, 2.0, 3.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_THROW((void)estimate_mean(one), InputError);
  EXPECT_THROW((void)estimate_mean(bad), InputError);
  EXPECT_THROW((void)estimate_standard_deviation(std::vector<double>{1.0, 2.0, 3.0}), InputError);
  EXPECT_THROW((void)estimate_standard_deviation(bad), InputError);
  EXPECT_THROW((void)estimate_root_mean_square(bad), InputError);
  EXPECT_THROW((void)estimate_slope(std::vector<double>{1.0, 2.0}, std::vector<double>{1.0, 2.0}, 0.0),
               InputError);
  EXPECT_THROW((void)estimate_share(0, 0), InputError);
  EXPECT_THROW((void)estimate_share(2, 1), InputError);
}

}  // namespace
}  // namespace dtof
