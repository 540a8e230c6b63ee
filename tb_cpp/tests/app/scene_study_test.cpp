// SPDX-License-Identifier: Apache-2.0
#include "app/scene_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace dtof {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

TEST(SceneTruth, EdgesAreWhereANeighbourDiffersByTenPercent) {
  TargetMap targets(3, 3, {2.0, 1.0});
  targets.at(1, 1).depth_m = 2.1;
  EXPECT_THAT(scene_truth({"nearly flat", targets, 3}).edge,
              ElementsAre(false, false, false, false, false, false, false, false, false));
  targets.at(1, 1).depth_m = 3.0;
  EXPECT_THAT(scene_truth({"pole", targets, 3}).edge,
              ElementsAre(false, true, false, true, true, true, false, true, false));
  // Only the middle column is read; its neighbours still make edges.
  const SceneTruth one = scene_truth({"pole", targets, 1});
  EXPECT_THAT(one.distance_m, ElementsAre(2.0, 3.0, 2.0));
  EXPECT_THAT(one.edge, ElementsAre(true, true, true));
}

TEST(SceneScore, SharesEdgesAndConfidenceCurve) {
  SceneTruth truth{.columns = 1, .rows = 101, .distance_m = {}, .edge = {}};
  SceneMeasurement measurement;
  for (int row = 0; row < 100; ++row) {
    truth.distance_m.push_back(2.0);
    truth.edge.push_back(row < 20);
    // Ten outliers, two of them at edges; five more above 3 %.
    const bool outlier = row % 10 == 3;
    const bool bad = row % 20 == 5;
    measurement.distance_m.push_back(outlier ? 3.0 : bad ? 2.1 : 2.0);
    // Half of the outliers share the lowest confidence with five good pixels, the others have the highest.
    measurement.confidence.push_back(outlier && row < 50 ? 0.0 : row % 20 == 7 ? 0.0 : outlier ? 9.0 : 5.0);
  }
  truth.distance_m.push_back(0.0);  // no target: not judged
  truth.edge.push_back(false);
  measurement.distance_m.push_back(1.0);
  measurement.confidence.push_back(0.0);

  const SceneScore score = score_scene(truth, measurement);
  EXPECT_EQ(score.all.pixels, 100U);
  EXPECT_DOUBLE_EQ(score.all.above_3_percent, 0.15);
  EXPECT_DOUBLE_EQ(score.all.above_10_percent, 0.10);
  EXPECT_NEAR(score.all.rmse, std::sqrt((10 * 0.25 + 5 * 0.0025) / 100.0), 1e-9);
  EXPECT_EQ(score.edges.pixels, 20U);
  EXPECT_DOUBLE_EQ(score.edges.above_10_percent, 0.10);
  EXPECT_EQ(score.rest.pixels, 80U);
  const auto near = [](double value) { return DoubleNear(value, 1e-9); };
  EXPECT_THAT(score.removed,
              ElementsAre(near(0.05), near(0.10), near(0.25), near(0.5), near(0.5), near(0.5), near(0.5)));
}

TEST(SceneScore, NothingToRemoveIsNoFigure) {
  const SceneTruth truth{.columns = 1, .rows = 2, .distance_m = {1.0, 1.0}, .edge = {false, false}};
  const SceneScore score = score_scene(truth, {{1.0, 1.0}, {1.0, 2.0}});
  EXPECT_TRUE(std::ranges::all_of(score.removed, [](double share) { return std::isnan(share); }));
}

TEST(SceneStudy, RanksEstimatorsTheSameWhateverTheThreads) {
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 1000;
  const std::vector<ReadoutParameters> readouts = {ReadoutParameters::defaults(Readout::kHisPointer),
                                                   ReadoutParameters::defaults(Readout::kPoolPointer)};
  const StudyScene scene{"wall", TargetMap(4, 40, {3.0, 1.0}), 4};
  const SceneTruth truth = scene_truth(scene);
  const SceneStudy one(sensor, 14.0, readouts, 3, 1);
  const SceneStudy two(sensor, 14.0, readouts, 3, 2);
  const std::vector<SceneMeasurement> measured = one.measure(scene);
  const std::vector<SceneMeasurement> again = two.measure(scene);
  ASSERT_EQ(measured.size(), 4U);
  for (std::size_t e = 0; e < measured.size(); ++e) {
    EXPECT_EQ(measured[e].distance_m, again[e].distance_m) << one.estimators()[e];
    EXPECT_EQ(measured[e].confidence, again[e].confidence) << one.estimators()[e];
  }
  const double his_pointer = score_scene(truth, measured[0]).all.above_3_percent;
  const double pool_pointer = score_scene(truth, measured[1]).all.above_3_percent;
  EXPECT_LT(pool_pointer, 0.5 * his_pointer);
}

}  // namespace
}  // namespace dtof
