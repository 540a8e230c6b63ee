// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/confidence_interval.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
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

TEST(ConfidenceInterval, ShareOfFramesByHand) {
  // Shares 0.1, 0.2, 0.3 of 100 pixels: t(0.975, 2) * 0.1 / sqrt(3) is wider than Wilson's for 60 of 300.
  const Estimate spread = estimate_share_of_frames(std::vector<double>{0.1, 0.2, 0.3}, 100);
  EXPECT_NEAR(spread.value, 0.2, 1e-12);
  EXPECT_EQ(spread.interval.low, 0.0);
  EXPECT_NEAR(spread.interval.high, 0.2 + 4.302653 * 0.1 / std::sqrt(3.0), 1e-6);
  // Frames that agree say nothing of pixels that were not seen: Wilson's interval is left.
  const Estimate equal = estimate_share_of_frames(std::vector<double>{0.2, 0.2, 0.2}, 100);
  EXPECT_EQ(equal.interval, estimate_share(60, 300).interval);
  const Estimate none = estimate_share_of_frames(std::vector<double>{0.0, 0.0}, 500);
  EXPECT_EQ(none.interval, estimate_share(0, 1000).interval);
  EXPECT_GT(none.interval.high, 0.0);
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
  EXPECT_NEAR(coverage(0.0,
                       [&] {
                         return estimate_slope(estimate_mean(normal_values(random, 60)),
                                               estimate_mean(normal_values(random, 30, 3.0)), 2.0);
                       }),
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

TEST(ConfidenceInterval, HoldsTheFigureWhereOutliersMakeItSmaller) {
  std::vector<double> values(1000, -0.2);  // a bin that all detections but one fall into
  values.back() = 0.0;
  const Estimate rms = estimate_root_mean_square(values, find_outliers(values), {-1.0, 1.0});
  EXPECT_NEAR(rms.value, 0.2 * std::sqrt(0.999), 1e-12);
  EXPECT_LT(rms.interval.low, rms.value);
  EXPECT_GE(rms.interval.high, rms.value);
  EXPECT_LE(rms.interval.high, 0.2 + 1e-12);
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

TEST(ConfidenceInterval, RareShareIsExact) {
  // Clopper and Pearson, e.g. from R's binom.test.
  const Estimate one = estimate_rare_share(1, 10);
  EXPECT_NEAR(one.interval.low, 0.00252858, 1e-7);
  EXPECT_NEAR(one.interval.high, 0.4450161, 1e-7);
  EXPECT_EQ(one.with_unseen, one.interval);
  // Closed forms of the ends: 1 - 0.025^(1/n) for no success, 0.025^(1/n) for no failure.
  EXPECT_NEAR(estimate_rare_share(0, 1000).interval.high, 1.0 - std::pow(0.025, 1e-3), 1e-12);
  EXPECT_NEAR(estimate_rare_share(1000, 1000).interval.low, std::pow(0.025, 1e-3), 1e-12);
  EXPECT_EQ(estimate_rare_share(10, 1000), estimate_share(10, 1000));
  EXPECT_FALSE(estimate_rare_share(10, 1000).with_unseen);
  EXPECT_TRUE(estimate_rare_share(991, 1000).with_unseen);
}

TEST(Outliers, BeyondSixRobustDeviations) {
  // Quartiles 3 and 7, median 5: deviation 4 / 1.349, six of them 17.8.
  EXPECT_EQ(find_outliers(std::vector<double>{22.7, 2, 3, 4, 5, 6, 7, 8, 1}).count, 0U);
  const Outliers outliers = find_outliers(std::vector<double>{22.9, 2, 3, 4, 5, 6, 7, 8, 1});
  EXPECT_EQ(outliers.count, 1U);
  EXPECT_TRUE(outliers.is_outlier.front());
  EXPECT_EQ(find_outliers(std::vector<double>{9, 2, 3, 4, 5, 6, 7, 8, -12.9}).count, 1U);
  EXPECT_EQ(find_outliers(std::vector<double>{}).count, 0U);
}

// Few outliers of a normal population: `count` expected in 1,000 values, as large as what `size` draws.
std::vector<double> contaminated(CounterRandom& random, double count, const std::function<double()>& size) {
  std::vector<double> values = normal_values(random, 1000);
  for (double& value : values) {
    if (random.uniform() < count / 1000.0) {
      value = size();
    }
  }
  return values;
}

TEST(ConfidenceInterval, CoversWhateverFewOutliersAre) {
  SCOPED_TRACE(test_seed_message());
  const Interval range{-100.0, 300.0};
  CounterRandom random = make_random(6);
  struct Population {
    const char* name;
    std::function<double()> size;
    double mean;
    double mean_square;
  };
  const std::vector<Population> populations = {
      {"uniform over the range", [&] { return -100.0 + 400.0 * random.uniform(); }, 100.0,
       100.0 * 100.0 + 400.0 * 400.0 / 12.0},
      {"at the range's end", [] { return 300.0; }, 300.0, 300.0 * 300.0},
      {"just outside", [] { return -8.0; }, -8.0, 64.0}};
  for (const Population& population : populations) {
    for (const double expected : {0.05, 0.5, 2.0, 6.0, 12.0}) {
      SCOPED_TRACE(population.name + std::string(", outliers expected: ") + std::to_string(expected));
      const double share = expected / 1000.0;
      const double mean = share * population.mean;
      const double mean_square = (1.0 - share) + share * population.mean_square;
      int mean_covered = 0;
      int root_covered = 0;
      int deviation_covered = 0;
      constexpr int kFewerSets = 1000;
      for (int set = 0; set < kFewerSets; ++set) {
        const std::vector<double> values = contaminated(random, expected, population.size);
        const Outliers outliers = find_outliers(values);
        const auto covers = [](const Estimate& estimate, double truth) {
          return estimate.covering().low <= truth && truth <= estimate.covering().high ? 1 : 0;
        };
        mean_covered += covers(estimate_mean(values, outliers, range), mean);
        root_covered += covers(estimate_root_mean_square(values, outliers, range), std::sqrt(mean_square));
        deviation_covered += covers(estimate_standard_deviation(values, outliers, range),
                                    std::sqrt(mean_square - mean * mean));
      }
      constexpr int kLeast = 930;
      EXPECT_GT(mean_covered, kLeast);
      EXPECT_GT(root_covered, kLeast);
      EXPECT_GT(deviation_covered, kLeast);
    }
  }
}

TEST(ConfidenceInterval, WithoutOutliersTheNarrowIntervalIsTheUsualOne) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = make_random(7);
  const std::vector<double> values = normal_values(random, 100);
  const Outliers none = find_outliers(values);
  ASSERT_EQ(none.count, 0U);
  const Interval range{-50.0, 20.0};
  const Estimate rms = estimate_root_mean_square(values, none, range);
  const Estimate usual = estimate_root_mean_square(values);
  EXPECT_NEAR(rms.interval.low, usual.interval.low, 1e-12);
  EXPECT_NEAR(rms.interval.high, usual.interval.high, 1e-12);
  const double most = 1.0 - std::pow(0.025, 0.01);  // of the share when none of 100 was seen
  ASSERT_TRUE(rms.with_unseen);
  EXPECT_NEAR(rms.with_unseen->high, std::sqrt(usual.interval.high * usual.interval.high + most * 2500.0),
              1e-9);
  const Estimate mean = estimate_mean(values, none, range);
  EXPECT_NEAR(mean.interval.low, estimate_mean(values).interval.low, 1e-12);
  EXPECT_NEAR(mean.with_unseen->low, mean.interval.low - most * (mean.value + 50.0), 1e-9);
  EXPECT_NEAR(mean.with_unseen->high, mean.interval.high + most * (20.0 - mean.value), 1e-9);
  EXPECT_EQ(reciprocal(2.0, rms).with_unseen->low, 2.0 / rms.with_unseen->high);
  const Estimate slope = estimate_slope(mean, mean, 1.0);
  EXPECT_NEAR(slope.with_unseen->high,
              std::hypot(mean.with_unseen->high - mean.value, mean.value - mean.with_unseen->low), 1e-9);
}

TEST(ConfidenceInterval, FewOutliersMayBeBadLuck) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = make_random(8);
  std::vector<double> values = normal_values(random, 100);
  const Estimate others = estimate_root_mean_square(values);
  values.insert(values.end(), {40.0, 45.0});
  const Outliers outliers = find_outliers(values);
  ASSERT_EQ(outliers.count, 2U);
  const Estimate rms = estimate_root_mean_square(values, outliers, {-50.0, 50.0});
  ASSERT_TRUE(rms.with_unseen);
  EXPECT_GT(rms.value, 2.0 * others.value);
  EXPECT_NEAR(rms.with_unseen->low, others.interval.low, 1e-12);
}

TEST(ConfidenceInterval, TheMeanWithFewOutliersByHand) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = make_random(9);
  std::vector<double> values = normal_values(random, 98);
  const Estimate others = estimate_mean(values);
  values.insert(values.end(), {40.0, 44.0});
  const Estimate mean = estimate_mean(values, find_outliers(values), {-50.0, 50.0});
  const double above = 42.0 - others.value;
  const Interval share = estimate_rare_share(2, 100).interval;
  EXPECT_NEAR(mean.value, others.value + 0.02 * above, 1e-12);
  EXPECT_NEAR(mean.interval.high - mean.value,
              std::hypot(others.interval.high - others.value, (share.high - 0.02) * above), 1e-9);
  EXPECT_NEAR(mean.value - mean.interval.low,
              std::hypot(others.value - others.interval.low, (0.02 - share.low) * above), 1e-9);
}

TEST(ConfidenceInterval, ASlopeSaysThatEitherEndMayHaveUnseenOutliers) {
  const Estimate sure{1.0, {0.9, 1.1}};
  const Estimate rare{2.0, {1.9, 2.1}, Interval{1.8, 3.0}};
  EXPECT_FALSE(estimate_slope(sure, sure, 1.0).with_unseen);
  for (const auto& [first, second] : {std::pair(sure, rare), std::pair(rare, sure)}) {
    const Estimate slope = estimate_slope(first, second, 1.0);
    ASSERT_TRUE(slope.with_unseen);
    EXPECT_LT(slope.with_unseen->low, slope.interval.low);
  }
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
  EXPECT_THROW((void)estimate_slope({1.0, {0.0, 2.0}}, {1.0, {0.0, 2.0}}, 0.0), InputError);
  EXPECT_THROW((void)estimate_mean(std::vector<double>{1.0, 2.0}, Outliers{}, {0.0, 3.0}), InputError);
  EXPECT_THROW((void)estimate_rare_share(2, 1), InputError);
  EXPECT_THROW((void)estimate_share(0, 0), InputError);
  EXPECT_THROW((void)estimate_share(2, 1), InputError);
}

}  // namespace
}  // namespace dtof
