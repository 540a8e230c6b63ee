// SPDX-License-Identifier: Apache-2.0
#include "photon_models/speed_error_curves.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

constexpr double kDistance = 2.0;

ErrorStatistics block_of(const std::vector<double>& relative_errors) {
  ErrorStatistics block;
  for (const double error : relative_errors) {
    block.add(kDistance, kDistance * (1.0 + error));
  }
  return block;
}

/// Blocks of kCurveBlock normal errors, relative to the distance.
std::vector<ErrorStatistics> normal_blocks(int count, double bias, double precision) {
  std::mt19937_64 random(test_seed());
  std::normal_distribution<double> noise(bias, precision);
  std::vector<ErrorStatistics> blocks;
  for (int i = 0; i < count; ++i) {
    std::vector<double> errors(kCurveBlock);
    for (double& error : errors) {
      error = noise(random);
    }
    blocks.push_back(block_of(errors));
  }
  return blocks;
}

double error_of_sets(const std::vector<ErrorStatistics>& blocks, std::size_t blocks_a_set,
                     const ErrorAnswer& truth) {
  AnswerError error;
  error.add_sets(blocks, blocks_a_set, kDistance, truth);
  return error.percent();
}

TEST(ErrorAnswer, IsOfAllBlocksTogetherRelativeToTheDistance) {
  const std::vector<ErrorStatistics> blocks = {block_of({0.01}), block_of({0.02, 0.03})};
  const ErrorAnswer answer = error_answer(blocks, kDistance);
  EXPECT_NEAR(answer.bias, 0.02, 1e-12);
  EXPECT_NEAR(answer.precision, 0.01, 1e-12);
  EXPECT_THROW((void)error_answer({}, kDistance), InputError);
}

TEST(AnswerError, TheTruthHasNone) {
  AnswerError error;
  error.add({.bias = 0.03, .precision = 0.2}, {.bias = 0.03, .precision = 0.2});
  EXPECT_EQ(error.percent(), 0.0);
  const std::vector<ErrorStatistics> blocks(5, block_of({-0.01, 0.04}));
  EXPECT_EQ(error_of_sets(blocks, 1, error_answer(std::span(blocks).first(1), kDistance)), 0.0);
  EXPECT_TRUE(std::isnan(AnswerError().percent()));
}

TEST(AnswerError, IsTheRootOfTheMeanSquareOfBothQuantities) {
  AnswerError error;
  error.add({.bias = 0.03, .precision = 0.10}, {.bias = 0.0, .precision = 0.14});
  EXPECT_NEAR(error.percent(), 100.0 * std::sqrt((0.03 * 0.03 + 0.04 * 0.04) / 2.0), 1e-12);
  error.add({.bias = 0.0, .precision = 0.5}, {.bias = 0.12, .precision = 0.5});
  EXPECT_NEAR(error.percent(), 100.0 * std::sqrt((0.05 * 0.05 + 0.12 * 0.12) / 4.0), 1e-12);
}

TEST(AnswerError, SetsAreDisjointNeighboursAndARestIsLeftOut) {
  std::vector<ErrorStatistics> blocks;
  for (const double error : {0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 100.0}) {
    blocks.push_back(block_of({error}));
  }
  // Biases 0.02 and 0.05, precision 0.01 in both.
  EXPECT_NEAR(error_of_sets(blocks, 3, {.bias = 0.02, .precision = 0.01}), 100.0 * std::sqrt(0.03 * 0.03 / 4),
              1e-9);
  EXPECT_TRUE(std::isnan(error_of_sets(blocks, 8, {.bias = 0.02, .precision = 0.01})));
}

TEST(AnswerError, NoiseFallsWithTheRootOfTheFrames) {
  SCOPED_TRACE(test_seed_message());
  // So far from 0 that no error changes its sign: the relative precision is the noise's.
  constexpr double kBias = 0.5;
  constexpr double kPrecision = 0.02;
  const std::vector<ErrorStatistics> blocks = normal_blocks(4000, kBias, kPrecision);
  for (const std::size_t blocks_a_set : {1U, 4U, 16U, 64U}) {
    const double percent = error_of_sets(blocks, blocks_a_set, {.bias = kBias, .precision = kPrecision});
    // Variances of mean and standard deviation of n normal numbers: sigma^2 / n and half as much.
    const auto frames = static_cast<double>(blocks_a_set * kCurveBlock);
    const double expected = 1e4 * kPrecision * kPrecision / frames * (1.0 + 0.5) / 2.0;
    const double sets = std::floor(4000.0 / static_cast<double>(blocks_a_set));
    // The sum of a chi-square and half a chi-square variable of one degree each a set; six deviations.
    const double deviation = std::sqrt((2.0 + 2.0 / 4.0) / sets) / 1.5;
    EXPECT_NEAR(percent * percent / expected, 1.0, 6.0 * deviation) << blocks_a_set;
  }
}

TEST(AnswerError, AModelsBiasStays) {
  SCOPED_TRACE(test_seed_message());
  const std::vector<ErrorStatistics> blocks = normal_blocks(640, 0.55, 0.002);
  for (const std::size_t blocks_a_set : {1U, 8U, 64U}) {
    const double percent = error_of_sets(blocks, blocks_a_set, {.bias = 0.5, .precision = 0.002});
    EXPECT_NEAR(percent, 5.0 / std::numbers::sqrt2, 0.02) << blocks_a_set;
  }
}

/// Keeps the thread's processor busy.
void work(double ms) {
  const auto thread_ms = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
  };
  const double begin = thread_ms();
  while (thread_ms() - begin < ms) {
  }
}

TEST(LeastCpuMs, IsTheCheapestRun) {
  int run = 0;
  const std::vector<double> ms = {60.0, 10.0, 80.0};
  const double least = least_cpu_ms([&] { work(ms[static_cast<std::size_t>(run++)]); }, 3);
  EXPECT_EQ(run, 3);
  EXPECT_GE(least, 9.9);
  EXPECT_LT(least, 50.0);
}

TEST(LeastCpuMs, AddsThreadsUpAndDoesNotCountWaiting) {
  const double two = least_cpu_ms(
      [] {
        std::thread other([] { work(20.0); });
        work(20.0);
        other.join();
      },
      1);
  EXPECT_GE(two, 39.9);
  const double asleep = least_cpu_ms([] { std::this_thread::sleep_for(std::chrono::milliseconds(50)); }, 1);
  EXPECT_LT(asleep, 25.0);
}

TEST(ErrorCurveSettings, RefusesNumbersOfFramesThatAreNoBlocks) {
  EXPECT_NO_THROW(ErrorCurveSettings().validate());
  for (const std::vector<int>& frames :
       {std::vector<int>{100, 250}, {200, 100}, {100, 100}, {0, 100}, {-100}}) {
    EXPECT_THAT([&] { ErrorCurveSettings{.frames = frames}.validate(); },
                ThrowsMessage<InputError>(HasSubstr("multiples of 100")));
  }
  EXPECT_THROW(ErrorCurveSettings{.frames = {}}.validate(), InputError);
  EXPECT_THROW(ErrorCurveSettings{.distances_m = {}}.validate(), InputError);
  EXPECT_THROW(ErrorCurveSettings{.reference_frames = 150}.validate(), InputError);
}

const SensorModel kSensor = parse_preset("thesis");

TEST(SpeedErrorCurves, MoreFramesCostMoreAndErrLess) {
  SCOPED_TRACE(test_seed_message());
  const ErrorCurveSettings settings{.distances_m = {1.0}, .frames = {100, 3200}, .reference_frames = 12'800};
  const std::vector<ErrorCurve> curves = speed_error_curves(kSensor, settings, test_seed(), 0);
  ASSERT_THAT(curves, SizeIs(4));
  for (std::size_t model = 0; model < 3; ++model) {
    const ErrorCurve& curve = curves[model];
    SCOPED_TRACE(curve.model);
    EXPECT_THAT(curve.frames, ElementsAre(100, 3200));
    ASSERT_THAT(curve.cpu_ms, SizeIs(2));
    ASSERT_THAT(curve.error_percent, SizeIs(2));
    // 32 times the frames; processor time is shared with what else the machine does.
    EXPECT_GT(curve.cpu_ms[1], 8.0 * curve.cpu_ms[0]);
    // A fifth is expected, but from one set, in which a few terms outweigh the others: 1e-5 to be above 0.7.
    EXPECT_LT(curve.error_percent[1], 0.7 * curve.error_percent[0]);
    EXPECT_GT(curve.error_percent[1], 0.0);
  }
  EXPECT_EQ(curves[0].model, "exact");
  EXPECT_EQ(curves[1].model, "fast stream");
  EXPECT_EQ(curves[2].model, "fast sampler");
  EXPECT_EQ(curves[3].model, "analytic");
  EXPECT_THAT(curves[3].frames, IsEmpty());
  ASSERT_THAT(curves[3].cpu_ms, SizeIs(1));
  EXPECT_GT(curves[3].cpu_ms[0], 0.0);
  // No noise of its own: below a hundred frames.
  ASSERT_THAT(curves[3].error_percent, SizeIs(1));
  EXPECT_LT(curves[3].error_percent[0], curves[0].error_percent[0]);
}

TEST(SpeedErrorCurves, ErrorsDependOnTheSeedAndNotOnTheThreads) {
  const ErrorCurveSettings settings{.distances_m = {2.0}, .frames = {100, 300}, .reference_frames = 300};
  const auto errors = [&](std::uint64_t seed, int threads) {
    std::vector<std::vector<double>> all;
    for (const ErrorCurve& curve : speed_error_curves(kSensor, settings, seed, threads)) {
      all.push_back(curve.error_percent);
    }
    return all;
  };
  const auto once = errors(1, 1);
  EXPECT_EQ(errors(1, 3), once);
  const auto other = errors(2, 1);
  for (std::size_t model = 0; model < once.size(); ++model) {
    EXPECT_NE(other[model], once[model]) << model;
  }
  // The truth comes from other frames: as many of the exact model are not right.
  EXPECT_GT(once[0][1], 0.0);
}

ErrorCurve falling(const std::string& model, double cost) {
  // Error 1 % at `cost`, and a tenth of it for a hundred times the cost, as noise falls.
  return {
      .model = model, .frames = {100, 10'000}, .cpu_ms = {cost, 100.0 * cost}, .error_percent = {1.0, 0.1}};
}

TEST(ErrorCurve, CostOfAnErrorBetweenThePoints) {
  const ErrorCurve curve = falling("exact", 5.0);
  EXPECT_DOUBLE_EQ(cost_to_reach(curve, 1.0), 5.0);
  EXPECT_NEAR(cost_to_reach(curve, 0.5), 5.0 * 4.0, 1e-9);
  EXPECT_NEAR(cost_to_reach(curve, 0.1), 500.0, 1e-9);
  EXPECT_TRUE(std::isnan(cost_to_reach(curve, 0.05)));
}

}  // namespace
}  // namespace dtof
