// SPDX-License-Identifier: Apache-2.0
#include "dtof/host/range_converter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TargetRun run_at(std::uint32_t frame, double distance_m, std::initializer_list<double> positions) {
  TargetRun run{{1, frame}, distance_m, {}};
  for (const double position : positions) {
    run.measurements.push_back({position, 1.0});
  }
  return run;
}

// A read-out whose code is bent, with noise, and wrong altogether beyond `reach` and now and then before.
TargetRun bent_run(CounterRandom& random, std::uint32_t frame, double distance_m, double reach, int count) {
  TargetRun run{{test_seed(), frame}, distance_m, {}};
  std::normal_distribution<double> noise(0.0, 3.0);
  for (int i = 0; i < count; ++i) {
    const double position = 100.0 * distance_m + 20.0 * distance_m * distance_m + noise(random);
    const bool lost = distance_m > reach || random.uniform() < 0.1;
    run.measurements.push_back({lost ? 400.0 * random.uniform() : std::round(position), lost ? 1.0 : 9.0});
  }
  return run;
}

RangeConverter bent_converter(double reach, double farthest, int count) {
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0);
  std::vector<TargetRun> runs;
  for (std::uint32_t i = 0; 0.1 * (i + 1) <= farthest + 1e-9; ++i) {
    runs.push_back(bent_run(random, i, 0.1 * (i + 1), reach, count));
  }
  return RangeConverter::calibrate(runs);
}

TEST(RangeConverter, ResultBeatsBecomeMeasurements) {
  EXPECT_EQ(to_measurement({.code = 7, .fraction = 4, .confidence = 3}, 4), (Measurement{7.25, 3.0}));
}

TEST(RangeConverter, LineByHand) {
  const std::vector<TargetRun> runs = {run_at(0, 1.0, {10.0, 10.0, 10.0}),
                                       run_at(1, 2.0, {20.0, 20.0, 20.0})};
  const RangeConverter converter = RangeConverter::calibrate(runs);
  EXPECT_NEAR(converter.distance(10.0), 1.0, 1e-12);
  EXPECT_NEAR(converter.distance(15.0), 1.5, 1e-12);
  EXPECT_NEAR(converter.distance(25.0), 2.5, 1e-12);
  EXPECT_DOUBLE_EQ(converter.reach_m(), 2.0);
}

TEST(RangeConverter, MedianIsFinerThanACode) {
  // Three of four measurements are code 10, one is 11: the median lies in code 10, two thirds through.
  const std::vector<TargetRun> runs = {run_at(0, 1.0, {11.0, 10.0, 10.0, 10.0}),
                                       run_at(1, 2.0, {20.0, 20.0, 20.0, 20.0})};
  EXPECT_NEAR(RangeConverter::calibrate(runs).table().knots().front().position, 10.0 + 2.0 / 3.0 - 0.5,
              1e-12);
  EXPECT_NEAR(RangeConverter::calibrate(runs, 0.0).table().knots().front().position, 10.0, 1e-12);
}

TEST(RangeConverter, WeightIsTheReciprocalVarianceOfAMedian) {
  // The weight of a normal distribution with the same quartiles, here 3 and 63.
  const std::vector<TargetRun> spread = {run_at(0, 1.0, {0, 1, 3, 7, 15, 31, 63, 127, 255}),
                                         run_at(1, 2.0, {1000, 1000, 1000, 1000})};
  const RangeConverter converter = RangeConverter::calibrate(spread);
  const std::vector<CalibrationPoint>& knots = converter.table().knots();
  ASSERT_EQ(knots.size(), 2U);
  const double sigma = 60.0 / 1.349;
  EXPECT_NEAR(knots[0].weight, 9.0 / (0.5 * std::numbers::pi * sigma * sigma), 1e-9);
  EXPECT_NEAR(knots[1].weight, 4.0 / (0.5 * std::numbers::pi), 1e-9);  // no finer than a code
}

TEST(RangeConverter, ARunCountsOnlyIfItGrowsByMoreThanTwoStandardErrors) {
  // A median of n equal codes has the standard error sqrt(pi / 2 / n): 0.04 for 1000, 0.63 for 4, 0.51 for 6.
  TargetRun sure{{1, 1}, 2.0, std::vector<Measurement>(1000, Measurement{20.0, 1.0})};
  const auto reach_with = [&](std::initializer_list<double> codes) {
    return RangeConverter::calibrate(
               std::vector<TargetRun>{run_at(0, 1.0, {10.0}), sure, run_at(2, 3.0, codes)})
        .reach_m();
  };
  EXPECT_EQ(reach_with({21, 21, 21, 21}), 2.0);
  EXPECT_EQ(reach_with({21, 21, 21, 21, 21, 21}), 3.0);
}

TEST(RangeConverter, BentCodesWithOutliers) {
  SCOPED_TRACE(test_seed_message());
  const RangeConverter converter = bent_converter(10.0, 4.0, 400);
  for (double distance = 0.3; distance < 4.0; distance += 0.37) {
    EXPECT_NEAR(converter.distance(100.0 * distance + 20.0 * distance * distance), distance, 0.01)
        << distance;
  }
}

TEST(RangeConverter, DistancesThatAreNotFoundDoNotBendTheTable) {
  SCOPED_TRACE(test_seed_message());
  const RangeConverter converter = bent_converter(2.0, 4.0, 400);
  EXPECT_GE(converter.reach_m(), 1.9);
  EXPECT_LT(converter.reach_m(), 2.3);
  for (double distance = 0.3; distance < 1.95; distance += 0.17) {
    EXPECT_NEAR(converter.distance(100.0 * distance + 20.0 * distance * distance), distance, 0.02)
        << distance;
  }
}

TEST(RangeConverter, CalibrationRunsCannotEvaluate) {
  const std::vector<TargetRun> runs = {run_at(3, 1.0, {10.0}), run_at(2, 2.0, {20.0})};
  const RangeConverter converter = RangeConverter::calibrate(runs);
  EXPECT_THROW((void)converter.evaluate(runs[0]), std::logic_error);
  EXPECT_THROW((void)converter.evaluate(run_at(2, 1.7, {12.0})), std::logic_error);
  EXPECT_THAT(converter.evaluate(run_at(4, 1.5, {15.0, 10.0})),
              testing::ElementsAre(testing::DoubleNear(1.5, 1e-9), testing::DoubleNear(1.0, 1e-9)));
  TargetRun other_seed = runs[0];
  other_seed.identity.seed = 2;
  EXPECT_EQ(converter.evaluate(other_seed).size(), 1U);
}

TEST(RangeConverter, RejectsByConfidence) {
  RangeConverter converter =
      RangeConverter::calibrate(std::vector<TargetRun>{run_at(0, 1.0, {10.0}), run_at(1, 2.0, {20.0})});
  EXPECT_TRUE(converter.convert({10.0, -1e9}).has_value());
  converter.set_least_confidence(5.0);
  EXPECT_FALSE(converter.convert({10.0, 4.0}).has_value());
  EXPECT_NEAR(converter.convert({10.0, 5.0}).value(), 1.0, 1e-9);
}

TEST(RangeConverter, ChoosesTheLowestThresholdThatKeepsTheShare) {
  RangeConverter converter =
      RangeConverter::calibrate(std::vector<TargetRun>{run_at(0, 1.0, {10.0}), run_at(1, 2.0, {20.0})});
  TargetRun run{{1, 9}, 1.0, {}};
  run.measurements = {{10.0, 9.0}, {10.0, 8.0}, {40.0, 8.0}, {10.0, 7.0}, {10.0, 6.0}, {40.0, 1.0}};
  const std::vector<TargetRun> runs = {run};
  EXPECT_TRUE(converter.choose_least_confidence(runs, 0.2));
  EXPECT_EQ(converter.least_confidence(), 6.0);  // one wrong in five
  EXPECT_TRUE(converter.choose_least_confidence(runs, 0.0));
  EXPECT_EQ(converter.least_confidence(), 9.0);
  EXPECT_TRUE(converter.choose_least_confidence(runs, 0.5));
  EXPECT_EQ(converter.least_confidence(), 1.0);
  run.measurements = {{40.0, 9.0}, {10.0, 9.0}};
  EXPECT_FALSE(converter.choose_least_confidence(std::vector<TargetRun>{run}, 0.1));
  EXPECT_EQ(converter.least_confidence(), 1.0);
}

TEST(RangeConverter, RefusesBadCalibrations) {
  const TargetRun good = run_at(0, 1.0, {10.0});
  const auto calibrate = [](const std::vector<TargetRun>& runs) {
    return [runs] { (void)RangeConverter::calibrate(runs); };
  };
  EXPECT_THAT(calibrate({good}), ThrowsMessage<InputError>(HasSubstr("at least 2 runs")));
  EXPECT_THAT(calibrate({good, run_at(1, 2.0, {})}), ThrowsMessage<InputError>(HasSubstr("2 m has no")));
  EXPECT_THAT(calibrate({good, run_at(1, -2.0, {20.0})}), ThrowsMessage<InputError>(HasSubstr("-2 m")));
  EXPECT_THAT(calibrate({good, run_at(1, 2.0, {std::numeric_limits<double>::quiet_NaN()})}),
              ThrowsMessage<InputError>(HasSubstr("not finite")));
}

}  // namespace
}  // namespace dtof
