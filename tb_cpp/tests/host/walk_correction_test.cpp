// SPDX-License-Identifier: Apache-2.0
#include "host/walk_correction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "core/error.hpp"
#include "core/random.hpp"
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

double bias(const WalkCorrection& correction, const TargetRun& run) {
  double sum = 0.0;
  for (const Measurement& measurement : run.measurements) {
    sum += correction.distance(measurement) - run.distance_m;
  }
  return sum / static_cast<double>(run.measurements.size());
}

TEST(WalkCorrection, TakesTheWalkOutWhereConfidenceTellsBrightness) {
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0);
  const WalkCorrection correction = WalkCorrection::calibrate(walking_runs(random, true));
  EXPECT_GE(correction.classes(), WalkCorrection::kClasses / 2);
  // Reflectivities and distances that calibrated nothing. A decade is 10 bins, thus 67 mm.
  for (const double reflectivity : {0.04, 0.2, 0.8}) {
    for (const double distance : {0.7, 1.5, 2.9}) {
      const TargetRun run = walking_run(random, 9999, distance, reflectivity, true);
      EXPECT_NEAR(bias(correction, run), 0.0, 0.006) << reflectivity << " " << distance;
    }
  }
}

TEST(WalkCorrection, IsOneTableWhereConfidenceSaysNothing) {
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0);
  const WalkCorrection correction = WalkCorrection::calibrate(walking_runs(random, false));
  EXPECT_EQ(correction.classes(), 1U);
  const double bright = bias(correction, walking_run(random, 9999, 1.5, 1.0, false));
  const double dim = bias(correction, walking_run(random, 9998, 1.5, 0.02, false));
  EXPECT_NEAR(dim - bright, 10.0 / kBinsPerMetre * std::log10(50.0), 0.03);
}

TEST(WalkCorrection, InterpolatesBetweenClassesByHand) {
  // Confidence 10: 10 bins a metre. Confidence 20: the same, 5 bins later.
  std::vector<TargetRun> runs;
  for (const double distance : {1.0, 2.0, 3.0}) {
    for (const double late : {0.0, 5.0}) {
      TargetRun run{{1, 0}, distance, {}};
      run.measurements.assign(12, {10.0 * distance + late, late == 0.0 ? 10.0 : 20.0});
      runs.push_back(run);
    }
  }
  const WalkCorrection correction = WalkCorrection::calibrate(runs, 0.0);
  ASSERT_EQ(correction.classes(), 2U);
  EXPECT_NEAR(correction.distance({20.0, 10.0}), 2.0, 1e-9);
  EXPECT_NEAR(correction.distance({20.0, 20.0}), 1.5, 1e-9);
  EXPECT_NEAR(correction.distance({20.0, 14.0}), 1.8, 1e-9);
  EXPECT_NEAR(correction.distance({20.0, 3.0}), 2.0, 1e-9);   // below every class
  EXPECT_NEAR(correction.distance({20.0, 99.0}), 1.5, 1e-9);  // above
  std::ranges::reverse(runs);
  EXPECT_EQ(WalkCorrection::calibrate(runs, 0.0).distance({20.0, 14.0}), correction.distance({20.0, 14.0}));
}

TEST(WalkCorrection, LeavesOutRunsThatHardlyReachAClass) {
  // At 2 m one measurement in twenty has the other class's confidence, and a wrong position.
  std::vector<TargetRun> runs;
  for (const double distance : {1.0, 2.0, 3.0}) {
    TargetRun sure{{1, 0}, distance, {}};
    sure.measurements.assign(100, {10.0 * distance, 20.0});
    TargetRun unsure{{1, 0}, distance, {}};
    unsure.measurements.assign(100, {10.0 * distance, 10.0});
    if (distance == 2.0) {
      unsure.measurements.assign(100, {10.0 * distance, 20.0});
      std::fill_n(unsure.measurements.begin(), 5, Measurement{29.0, 10.0});
    }
    runs.push_back(sure);
    runs.push_back(unsure);
  }
  EXPECT_NEAR(WalkCorrection::calibrate(runs, 0.0).distance({20.0, 10.0}), 2.0, 1e-9);
}

TEST(WalkCorrection, RefusesWhatCannotBeFitted) {
  const TargetRun one{{1, 0}, 1.0, {{10.0, 1.0}, {11.0, 1.0}}};
  EXPECT_THAT(
      [&] {
        (void)WalkCorrection::calibrate(std::vector{one, one});
      },
      ThrowsMessage<InputError>(HasSubstr("no class of confidence has two distances")));
  EXPECT_THAT([] { (void)WalkCorrection::calibrate({}); }, ThrowsMessage<InputError>(HasSubstr("no class")));
  TargetRun bad = one;
  bad.measurements[0].confidence = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { (void)WalkCorrection::calibrate(std::vector{bad}); },
              ThrowsMessage<InputError>(HasSubstr("confidence nan is not finite")));
}

}  // namespace
}  // namespace dtof
