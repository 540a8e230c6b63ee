// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/error_statistics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(RunningMoments, ByHand) {
  RunningMoments moments;
  EXPECT_EQ(moments.mean(), 0.0);
  EXPECT_EQ(moments.variance(), 0.0);
  moments.add(2.0);
  EXPECT_EQ(moments.variance(), 0.0);
  moments.add(4.0);
  moments.add(9.0);
  EXPECT_DOUBLE_EQ(moments.mean(), 5.0);
  EXPECT_DOUBLE_EQ(moments.variance(), 13.0);
  EXPECT_DOUBLE_EQ(moments.mean_square(), 101.0 / 3.0);
}

TEST(RunningMoments, SpreadOfNearlyEqualNumbers) {
  RunningMoments moments;
  for (int i = 0; i < 3000; ++i) {
    moments.add(1e9 + i % 3);  // the textbook sum of squares loses all of 2/3
  }
  EXPECT_NEAR(moments.variance(), 2.0 / 3.0 * 3000.0 / 2999.0, 1e-8);
  RunningMoments equal;
  for (int i = 0; i < 1000; ++i) {
    equal.add(0.1);
  }
  EXPECT_GE(equal.variance(), 0.0);
  EXPECT_LT(equal.variance(), 1e-30);
}

TEST(RunningMoments, MergedPartsAreTheWhole) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0);
  RunningMoments whole;
  RunningMoments merged;
  for (int part = 0; part < 20; ++part) {
    RunningMoments moments;
    for (int i = 0; i < part * part; ++i) {
      const double value = 1e6 + random.uniform();
      moments.add(value);
      whole.add(value);
    }
    merged.merge(moments);
  }
  EXPECT_EQ(merged.count(), whole.count());
  EXPECT_NEAR(merged.mean(), whole.mean(), 1e-8);
  EXPECT_NEAR(merged.variance(), whole.variance(), 1e-9);
}

TEST(ErrorStatistics, ByHand) {
  const std::vector<double> truth = {1.0, 2.0, 4.0, 1.0};
  const std::vector<double> measured = {1.02, 1.8, 4.5, 1.0};
  const ErrorSummary summary = summarise_errors(truth, measured);
  // Errors 0.02, -0.2, 0.5, 0; relative 0.02, 0.1, 0.125, 0.
  EXPECT_EQ(summary.count, 4U);
  EXPECT_NEAR(summary.bias_m, 0.08, 1e-15);
  EXPECT_NEAR(summary.rmse_m, std::sqrt((0.0004 + 0.04 + 0.25) / 4.0), 1e-15);
  EXPECT_NEAR(summary.standard_deviation_m, std::sqrt((0.0036 + 0.0784 + 0.1764 + 0.0064) / 3.0), 1e-15);
  const double mean = 0.06125;
  const double squares =
      std::pow(0.02 - mean, 2) + std::pow(0.1 - mean, 2) + std::pow(0.125 - mean, 2) + mean * mean;
  EXPECT_NEAR(summary.relative_precision, std::sqrt(squares / 3.0), 1e-15);
  EXPECT_EQ(summary.share_above_3_percent, 0.5);
}

TEST(ErrorStatistics, SharesCountErrorsOfEitherSignAboveTheLimit) {
  ErrorStatistics statistics;
  for (const double error : {2.99, -2.99, 3.01, -3.01, 9.99, -9.99, 10.01, -10.01}) {
    statistics.add(100.0, 100.0 + error);
  }
  EXPECT_EQ(statistics.summary().share_above_3_percent, 0.75);
  EXPECT_EQ(statistics.summary().share_above_10_percent, 0.25);
}

TEST(ErrorStatistics, AConstantRelativeErrorHasNoSpread) {
  // What Eq. 3.14 flatters: 30 % wrong everywhere, "precision" 0.
  ErrorStatistics statistics;
  for (int i = 1; i <= 100; ++i) {
    statistics.add(i, 1.3 * i);
  }
  EXPECT_LT(statistics.summary().relative_precision, 1e-15);
  EXPECT_EQ(statistics.summary().share_above_10_percent, 1.0);
}

TEST(ErrorStatistics, MergeAddsEverything) {
  ErrorStatistics left;
  ErrorStatistics right;
  ErrorStatistics whole;
  for (int i = 0; i < 10; ++i) {
    const double measured = 2.0 + 0.05 * i;
    (i < 4 ? left : right).add(2.0, measured);
    whole.add(2.0, measured);
  }
  left.merge(right);
  left.merge(ErrorStatistics());
  EXPECT_EQ(left.count(), 10U);
  EXPECT_NEAR(left.summary().rmse_m, whole.summary().rmse_m, 1e-15);
  EXPECT_NEAR(left.summary().relative_precision, whole.summary().relative_precision, 1e-15);
  EXPECT_EQ(left.summary().share_above_10_percent, whole.summary().share_above_10_percent);
  EXPECT_EQ(left.summary().share_above_3_percent, whole.summary().share_above_3_percent);
}

TEST(ErrorStatistics, RefusesWhatHasNoError) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([] { (void)ErrorStatistics().summary(); },
              ThrowsMessage<InputError>(HasSubstr("at least one measured distance")));
  EXPECT_THAT([] { ErrorStatistics().add(0.0, 1.0); },
              ThrowsMessage<InputError>(HasSubstr("true distance is 0 m")));
  EXPECT_THAT([=] { ErrorStatistics().add(nan, 1.0); },
              ThrowsMessage<InputError>(HasSubstr("true distance is nan m")));
  EXPECT_THAT([=] { ErrorStatistics().add(1.0, nan); },
              ThrowsMessage<InputError>(HasSubstr("measured distance is nan m")));
  EXPECT_THAT(
      [] {
        summarise_errors(std::vector{1.0, 2.0}, std::vector{1.0});
      },
      ThrowsMessage<InputError>(HasSubstr("2 values cannot be compared with 1")));
}

TEST(FitLine, ExactLineFarFromTheOrigin) {
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < 50; ++i) {
    x.push_back(1e6 + i);
    y.push_back(0.9 * (1e6 + i) - 3.0);
  }
  const LinearFit fit = fit_line(x, y);
  EXPECT_NEAR(fit.slope, 0.9, 1e-11);
  EXPECT_NEAR(fit.intercept, -3.0, 1e-4);
}

TEST(FitLine, LeastSquaresByHand) {
  const LinearFit fit = fit_line(std::vector{0.0, 1.0, 2.0}, std::vector{1.0, 0.0, 5.0});
  EXPECT_DOUBLE_EQ(fit.slope, 2.0);
  EXPECT_DOUBLE_EQ(fit.intercept, 0.0);
}

TEST(FitLine, RefusesAVerticalLine) {
  EXPECT_THAT(
      [] {
        fit_line(std::vector{1.0, 1.0}, std::vector{1.0, 2.0});
      },
      ThrowsMessage<InputError>(HasSubstr("at least two different x")));
  EXPECT_THAT([] { fit_line({}, {}); }, ThrowsMessage<InputError>(HasSubstr("at least two different x")));
  EXPECT_THAT(
      [] {
        fit_line(std::vector{1.0, 2.0}, std::vector{1.0});
      },
      ThrowsMessage<InputError>(HasSubstr("2 values cannot be compared with 1")));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(
      [=] {
        fit_line(std::vector{1.0, 2.0}, std::vector{nan, 1.0});
      },
      ThrowsMessage<InputError>(HasSubstr("point 0 of a line fit is not finite")));
}

TEST(Median, IsTheMiddleValueOrTheUpperOfTwo) {
  EXPECT_EQ(median({5.0}), 5.0);
  EXPECT_EQ(median({9.0, -1.0, 4.0}), 4.0);
  EXPECT_EQ(median({1.0, 4.0, 2.0, 3.0}), 3.0);
  EXPECT_THROW((void)median({}), InputError);
}

}  // namespace
}  // namespace dtof
