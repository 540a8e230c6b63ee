// SPDX-License-Identifier: Apache-2.0
#include "pool/pool_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"
#include "pool/pool_search.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

SensorModel short_frames() {
  SensorModel sensor = find_sensor("thesis");
  sensor.acquisitions = 600;
  return sensor;
}

/// A wall at 2 m and another at 3 m to its right.
StudyScene two_walls(int columns, int rows) {
  TargetMap targets(columns, rows, {2.0, 0.7});
  for (int column = columns / 2; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      targets.at(column, row).depth_m = 3.0;
    }
  }
  return {"two walls", targets, columns};
}

double share_near(const SceneTruth& truth, const SceneMeasurement& measurement) {
  double near = 0.0;
  for (std::size_t i = 0; i < truth.distance_m.size(); ++i) {
    near += std::abs(measurement.distance_m[i] - truth.distance_m[i]) < 0.1 * truth.distance_m[i] ? 1.0 : 0.0;
  }
  return near / static_cast<double>(truth.distance_m.size());
}

TEST(PoolDesign, ChangesTheNamedNumbersOnly) {
  PoolNumbers expected;
  EXPECT_EQ(parse_pool_design(""), expected);
  expected.leak_shift = 2;
  expected.left_cost.slope = 7;
  EXPECT_EQ(parse_pool_design("LEAK_SHIFT=2,LEFT_COST_SLOPE=7"), expected);
  EXPECT_EQ(pool_design_number(expected, "LEFT_COST_SLOPE"), 7);
  EXPECT_EQ(with_pool_design_number({}, "LEAK_SHIFT", 2).leak_shift, 2);
  for (const std::string& name : pool_design_names()) {
    EXPECT_NE(with_pool_design_number({}, name, 99), PoolNumbers()) << name;
  }
}

TEST(PoolDesign, RefusesUnknownNames) {
  EXPECT_THAT(
      [] { (void)parse_pool_design("LEAK=2"); },
      ThrowsMessage<InputError>(HasSubstr("poolPointer has no LEAK to change; known are COUNT_WIDTH,")));
  for (const char* text : {"LEAK_SHIFT", "LEAK_SHIFT=", "LEAK_SHIFT=x", "LEAK_SHIFT=2;"}) {
    EXPECT_THAT([&] { (void)parse_pool_design(text); },
                ThrowsMessage<InputError>(HasSubstr("expected NAME=NUMBER,...")))
        << text;
  }
  EXPECT_THAT([] { (void)parse_pool_design("LABELS=9"); },
              ThrowsMessage<InputError>(HasSubstr("LABELS must be 2 to 8, not 9")));
}

TEST(PoolStudy, EveryEstimatorFindsTwoWalls) {
  const StudyScene scene = two_walls(6, 24);
  const SceneTruth truth = scene_truth(scene);
  for (const TableRule table : {TableRule::kNone, TableRule::kFlat}) {
    const PoolStudy study(short_frames(), 2.0, std::vector<std::string>{"", "SMOOTH_DARK=0"}, true, 5, 1,
                          table);
    EXPECT_THAT(study.estimators(),
                ElementsAre("matched filter (single pixel)", "matched filter, S1", "pooled matched filter",
                            "poolPointer, no S1", "poolPointer", "poolPointer SMOOTH_DARK=0, no S1",
                            "poolPointer SMOOTH_DARK=0"));
    const std::vector<SceneMeasurement> measured = study.measure(scene);
    ASSERT_EQ(measured.size(), study.estimators().size());
    for (std::size_t e = 0; e < measured.size(); ++e) {
      EXPECT_GT(share_near(truth, measured[e]), 0.95) << study.estimators()[e];
    }
    // S1 moves something, and within no distance it moves nothing, nor where pointers start; the tables of
    // both may differ.
    EXPECT_NE(measured[0].distance_m, measured[1].distance_m);
    EXPECT_NE(measured[3].distance_m, measured[4].distance_m);
    if (table == TableRule::kNone) {
      EXPECT_NE(measured[5].distance_m, measured[3].distance_m);
      EXPECT_EQ(measured[6].distance_m, measured[5].distance_m);
    }
  }
}

// T is 0.105 m in dark groups: a step of 0.15 m between rows stays, whatever the smoothing.
TEST(PoolStudy, TheMatchedFiltersS1KeepsStepsBeyondItsReach) {
  TargetMap targets(6, 24, {2.0, 0.7});
  for (int column = 0; column < 6; ++column) {
    for (int row = 12; row < 24; ++row) {
      targets.at(column, row).depth_m = 2.15;
    }
  }
  const PoolStudy study(short_frames(), 2.0, std::vector<std::string>{""}, true, 5, 1, TableRule::kNone);
  const std::vector<SceneMeasurement> measured = study.measure({"step", targets, 6});
  double approach_m = 0.0;  // of the two rows at the step, mean of the columns
  double largest_m = 0.0;
  for (std::size_t column = 0; column < 6; ++column) {
    const auto moved = [&](std::size_t row) {
      return measured[1].distance_m[row * 6 + column] - measured[0].distance_m[row * 6 + column];
    };
    approach_m += (moved(11) - moved(12)) / 6.0;
    largest_m = std::max(largest_m, std::abs(moved(5)));
  }
  EXPECT_GT(largest_m, 0.0);
  EXPECT_LT(approach_m, 0.035) << "a quarter of the step from both sides would be 0.075";
}

TEST(PoolStudy, ReadsWholeMapsOnly) {
  StudyScene scene = two_walls(6, 4);
  scene.columns = 3;
  const PoolStudy study(short_frames(), 2.0, std::vector<std::string>{""}, false, 5, 1, TableRule::kNone);
  EXPECT_THAT(
      [&] { (void)study.measure(scene); },
      ThrowsMessage<InputError>(HasSubstr("two walls: poolPointer reads all 6 columns of a map, not 3")));
}

TEST(PoolSearch, ScoresADesignOnTheMiddleOfAScene) {
  const SensorModel sensor = short_frames();
  const std::vector<TrainingFrame> frames =
      draw_training_frames(sensor, {two_walls(10, 16)}, {2.0, 50.0}, 3, 4, 1);
  ASSERT_EQ(frames.size(), 2U);
  ASSERT_EQ(frames[0].photons.engines.size(), 1U);
  EXPECT_EQ(frames[0].photons.engines[0].size(), 4U);
  EXPECT_EQ(frames[0].truth.distance_m.front(), 2.0);
  EXPECT_EQ(frames[0].truth.distance_m.back(), 3.0);
  EXPECT_TRUE(frames[0].truth.edge[1]);

  const DesignScore score = score_design(sensor, frames, {}, 1);
  EXPECT_EQ(score.by_light.size(), 2U);
  EXPECT_LT(score.by_light[0], score.by_light[1]);
  EXPECT_NEAR(score.objective(), std::sqrt(score.by_light[0] * score.by_light[1]), 1e-9);
  // Without a track phase worth its name there are more errors.
  EXPECT_GT(score_design(sensor, frames, parse_pool_design("TRACK_SHARE=1"), 1).objective(),
            score.objective());
  EXPECT_THAT([&] { (void)draw_training_frames(sensor, {two_walls(10, 4)}, {2.0}, 3, 12, 1); },
              ThrowsMessage<InputError>(HasSubstr("two walls: 10 columns, but an engine has 12")));
}

}  // namespace
}  // namespace dtof
