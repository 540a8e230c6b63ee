// SPDX-License-Identifier: Apache-2.0
#include "dtof/host/walk_correction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kBinsPerMetre = 150.0;

/// A read-out with walk: 10 bins per decade of brightness, which falls with the distance squared. Its
/// confidence follows brightness if `tells`, else it says nothing.
TargetRun walking_run(CounterRandom& random, std::uint32_t frame, double distance_m, double reflectivity,
                      bool tells, int count = 200) {
  TargetRun run{{test_seed(), frame}, distance_m, {}};
  const double brightness = reflectivity / (distance_m * distance_m);
  std::normal_distribution<double> noise(0.0, 2.0);
  for (int i = 0; i < count; ++i) {
    const double position = kBinsPerMetre * distance_m + 50.0 - 10.0 * std::log10(brightness) + noise(random);
    const double confidence = tells ? 200.0 + 100.0 * std::log10(brightness) + noise(random) : 15.0;
    run.measurements.push_back({std::round(position), std::round(confidence)});
  }
  return run;
}

std::vector<TargetRun> walking_runs(CounterRandom& random, bool tells) {
  std::vector<TargetRun> runs;
  std::uint32_t frame = 0;
  for (int i = 1; i <= 20; ++i) {
    for (const double reflectivity : {0.02, 0.05, 0.12, 0.3, 0.6, 1.0}) {
      runs.push_back(walking_run(random, frame++, 0.2 * i, reflectivity, tells));
    }
  }
  return runs;
}

constexpr double kWindow = 0.4;

/// The table of targets of reflectivity 1.
RangeConverter bright_table(CounterRandom& random, bool tells) {
  std::vector<TargetRun> runs;
  for (int i = 1; i <= 20; ++i) {
    runs.push_back(walking_run(random, static_cast<std::uint32_t>(5000 + i), 0.2 * i, 1.0, tells));
  }
  return RangeConverter::calibrate(runs);
}

double bias(const WalkCorrection& correction, const TargetRun& run) {
  double sum = 0.0;
  for (const Measurement& measurement : run.measurements) {
    sum += correction.distance(measurement) - run.distance_m;
  }
  return sum / static_cast<double>(run.measurements.size());
}

TEST(WalkCorrection, RemovesTheWalkWhereConfidenceFollowsBrightness) {
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0);
  const RangeConverter table = bright_table(random, true);
  const WalkCorrection correction = WalkCorrection::calibrate(walking_runs(random, true), table, kWindow);
  EXPECT_GE(correction.classes(), WalkCorrection::kClasses / 2);
  // Reflectivities and distances that calibrated nothing. A decade of reflectivity is 10 bins, thus 67 mm.
  for (const double reflectivity : {0.04, 0.2, 0.8}) {
    for (const double distance : {0.7, 1.5, 2.9}) {
      const TargetRun run = walking_run(random, 9999, distance, reflectivity, true);
      EXPECT_NEAR(bias(correction, run), 0.0, 0.008) << reflectivity << " " << distance;
    }
  }
}

TEST(WalkCorrection, IsOneForAllWhereConfidenceSaysNothing) {
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0);
  const RangeConverter table = bright_table(random, false);
  const WalkCorrection correction = WalkCorrection::calibrate(walking_runs(random, false), table, kWindow);
  EXPECT_EQ(correction.classes(), 1U);
  const double bright = bias(correction, walking_run(random, 9999, 1.5, 1.0, false));
  const double dim = bias(correction, walking_run(random, 9998, 1.5, 0.02, false));
  EXPECT_NEAR(dim - bright, 10.0 / kBinsPerMetre * std::log10(50.0), 0.03);
}

/// Confidence 10: 10 bins a metre. Confidence 20: the same, 5 bins (0.5 m) later.
std::vector<TargetRun> two_classes() {
  std::vector<TargetRun> runs;
  for (const double distance : {1.0, 2.0, 3.0}) {
    for (const double late : {0.0, 5.0}) {
      TargetRun run{{1, 0}, distance, {}};
      run.measurements.assign(30, {10.0 * distance + late, late == 0.0 ? 10.0 : 20.0});
      runs.push_back(run);
    }
  }
  return runs;
}

RangeConverter ten_bins_a_metre() {
  const std::vector<TargetRun> runs = {{{2, 0}, 1.0, {{10.0, 1.0}}}, {{2, 0}, 4.0, {{40.0, 1.0}}}};
  return RangeConverter::calibrate(runs, 0.0);
}

TEST(WalkCorrection, InterpolatesBetweenClassesByHand) {
  std::vector<TargetRun> runs = two_classes();
  const WalkCorrection correction = WalkCorrection::calibrate(runs, ten_bins_a_metre(), 0.6);
  ASSERT_EQ(correction.classes(), 2U);
  EXPECT_NEAR(correction.distance({20.0, 10.0}), 2.0, 1e-9);
  EXPECT_NEAR(correction.distance({25.0, 20.0}), 2.0, 1e-9);
  EXPECT_NEAR(correction.distance({25.0, 14.0}), 2.3, 1e-9);
  EXPECT_NEAR(correction.distance({25.0, 3.0}), 2.5, 1e-9);   // below every class
  EXPECT_NEAR(correction.distance({25.0, 99.0}), 2.0, 1e-9);  // above
  EXPECT_NEAR(correction.distance({60.0, 20.0}), 5.5, 1e-9);  // beyond the farthest node
  std::ranges::reverse(runs);
  EXPECT_EQ(WalkCorrection::calibrate(runs, ten_bins_a_metre(), 0.6).distance({25.0, 14.0}),
            correction.distance({25.0, 14.0}));
}

TEST(WalkCorrection, WhatMissedTheTargetCorrectsNothing) {
  // With a window of 0.4 m the late class found nothing, and there is nothing to correct in the other.
  const WalkCorrection correction = WalkCorrection::calibrate(two_classes(), ten_bins_a_metre(), 0.4);
  EXPECT_EQ(correction.classes(), 1U);
  EXPECT_NEAR(correction.distance({25.0, 20.0}), 2.5, 1e-9);
  // Nor do misses of the same confidence as the rest.
  std::vector<TargetRun> runs = two_classes();
  for (TargetRun& run : runs) {
    for (std::size_t i = 0; i < 12; ++i) {
      run.measurements[i].position += 20.0;
    }
  }
  EXPECT_NEAR(WalkCorrection::calibrate(runs, ten_bins_a_metre(), 0.6).distance({20.0, 10.0}), 2.0, 1e-9);
  const WalkCorrection none = WalkCorrection::calibrate({}, ten_bins_a_metre(), 0.4);
  EXPECT_EQ(none.classes(), 0U);
  EXPECT_NEAR(none.distance({25.0, 20.0}), 2.5, 1e-9);
}

TEST(WalkCorrection, LeavesOutRunsThatHardlyReachAClass) {
  // One measurement in twenty at 2 m has the other class's confidence, and a bias of its own.
  std::vector<TargetRun> runs = two_classes();
  for (int i = 0; i < 20; ++i) {
    TargetRun run{{1, 0}, 2.0, {}};
    run.measurements.assign(40, {25.0, 20.0});
    run.measurements[0] = run.measurements[1] = {23.0, 10.0};
    runs.push_back(run);
  }
  const WalkCorrection correction = WalkCorrection::calibrate(runs, ten_bins_a_metre(), 0.6);
  EXPECT_NEAR(correction.distance({20.0, 10.0}), 2.0, 1e-9);
}

TEST(WalkCorrection, DoesNotCorrectNoise) {
  // Errors of +-0.3 m that cancel but for a tenth of their standard error.
  std::vector<TargetRun> runs;
  for (const double distance : {1.0, 2.0, 3.0}) {
    TargetRun run{{1, 0}, distance, {}};
    for (int i = 0; i < 100; ++i) {
      run.measurements.push_back({10.0 * distance + (i % 2 == 0 ? 3.0 : -3.0) + 0.03, 10.0});
    }
    runs.push_back(run);
  }
  const WalkCorrection correction = WalkCorrection::calibrate(runs, ten_bins_a_metre(), 0.6);
  EXPECT_EQ(correction.distance({20.0, 10.0}), ten_bins_a_metre().distance(20.0));
}

TEST(WalkCorrection, RefusesWhatIsNoNumber) {
  TargetRun bad{{1, 0}, 1.0, {{10.0, std::numeric_limits<double>::quiet_NaN()}}};
  EXPECT_THAT([&] { (void)WalkCorrection::calibrate(std::vector{bad}, ten_bins_a_metre(), 0.3); },
              ThrowsMessage<InputError>(HasSubstr("confidence nan is not finite")));
  EXPECT_THAT([] { (void)WalkCorrection::calibrate({}, ten_bins_a_metre(), 0.0); },
              ThrowsMessage<InputError>(HasSubstr("must be above 0")));
}

}  // namespace
}  // namespace dtof
