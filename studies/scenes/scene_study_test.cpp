// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/metrics/depth.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/sensor/preset.hpp"

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
  EXPECT_THAT(scene_truth({"pole", targets, 3}).single,
              ElementsAre(false, false, false, false, true, false, false, false, false));
  EXPECT_THAT(scene_truth({"pole", targets, 3}).edge,
              ElementsAre(false, true, false, true, true, true, false, true, false));
  // Only the middle column is read; its neighbours still make edges.
  const SceneTruth one = scene_truth({"pole", targets, 1});
  EXPECT_THAT(one.distance_m, ElementsAre(2.0, 3.0, 2.0));
  EXPECT_THAT(one.edge, ElementsAre(true, true, true));
}

TEST(SceneTruth, DimIsUpToAQuarterOfTheBrightest) {
  TargetMap targets(2, 2, {2.0, 0.8});
  targets.at(1, 0).reflectivity = 0.2;
  targets.at(0, 1).reflectivity = 0.21;
  EXPECT_THAT(scene_truth({"grey", targets, 2}).dim, ElementsAre(false, true, false, false));
  // The brightest target counts though its column is not read.
  TargetMap row(3, 1, {2.0, 0.2});
  EXPECT_THAT(scene_truth({"grey", row, 1}).dim, ElementsAre(false));
  row.at(0, 0).reflectivity = 0.8;
  EXPECT_THAT(scene_truth({"grey", row, 1}).dim, ElementsAre(true));
}

TEST(SceneTruth, GuessedDistancesAreNotJudgedButMakeEdges) {
  StudyScene scene{"pole", TargetMap(3, 1, {2.0, 1.0}), 3, {false, true, false}};
  scene.targets.at(1, 0).depth_m = 3.0;
  EXPECT_THAT(scene_truth(scene).distance_m, ElementsAre(2.0, 0.0, 2.0));
  EXPECT_THAT(scene_truth(scene).edge, ElementsAre(true, true, true));
}

TEST(SceneScore, SharesEdgesAndConfidenceCurve) {
  SceneTruth truth{.columns = 1, .rows = 101, .distance_m = {}, .edge = {}, .single = {}};
  SceneMeasurement measurement;
  for (int row = 0; row < 100; ++row) {
    truth.distance_m.push_back(2.0);
    truth.edge.push_back(row < 20);
    truth.single.push_back(row < 4);
    truth.dim.push_back(row >= 2 && row < 4);
    // Ten outliers, two of them at edges; five more above 3 %.
    const bool outlier = row % 10 == 3;
    const bool bad = row % 20 == 5;
    measurement.distance_m.push_back(outlier ? 3.0 : bad ? 2.1 : 2.0);
    // Half of the outliers share the lowest confidence with five good pixels, the others have the highest.
    measurement.confidence.push_back(outlier && row < 50 ? 0.0 : row % 20 == 7 ? 0.0 : outlier ? 9.0 : 5.0);
  }
  truth.distance_m.push_back(0.0);  // no target: not judged
  truth.edge.push_back(false);
  truth.single.push_back(false);
  truth.dim.push_back(false);
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
  EXPECT_EQ(score.dims.pixels, 2U);
  EXPECT_DOUBLE_EQ(score.dims.above_10_percent, 0.5);
  EXPECT_EQ(score.singles.pixels, 4U);
  EXPECT_DOUBLE_EQ(score.singles.above_10_percent, 0.25);
  const auto near = [](double value) { return DoubleNear(value, 1e-9); };
  EXPECT_THAT(score.removed,
              ElementsAre(near(0.05), near(0.10), near(0.25), near(0.5), near(0.5), near(0.5), near(0.5)));
}

TEST(SceneScore, NothingToRemoveIsNoFigure) {
  const SceneTruth truth{
      .columns = 1, .rows = 2, .distance_m = {1.0, 1.0}, .edge = {false, false}, .single = {false, false}};
  const SceneScore score = score_scene(truth, {{1.0, 1.0}, {1.0, 2.0}});
  EXPECT_TRUE(std::ranges::all_of(score.removed, [](double share) { return std::isnan(share); }));
}

TEST(SceneScore, PrecisionBesideTheBound) {
  const SceneTruth truth{.columns = 1,
                         .rows = 4,
                         .distance_m = {1.0, 2.0, 4.0, 0.0},
                         .edge = {false, false, false, false},
                         .single = {false, false, false, false}};
  const std::vector<double> bounds = {0.01, 0.01, 0.01, 0.0};
  // Errors of one, two and a hundred bounds.
  EXPECT_NEAR(median_error_over_bound(truth, bounds, {{1.01, 2.04, 8.0, 1.0}, {}}), 2.0 / 0.67449, 1e-4);
  const std::vector<double> none = {0.0, 0.0, INFINITY, 0.0};
  EXPECT_TRUE(std::isnan(median_error_over_bound(truth, none, {{1.0, 2.0, 4.0, 0.0}, {}})));
}

TEST(SceneStudy, BoundsOfAWall) {
  SensorModel sensor = parse_preset("thesis");
  const SceneStudy study(sensor, 14.0, {}, 1, 1);
  TargetMap targets(1, 2, {1.0, 1.0});
  targets.at(0, 1).reflectivity = 0.0;
  const std::vector<double> bounds = study.relative_bounds({"wall", targets, 1});
  // 1000 signal events of 0.127 m standard deviation, most of them kept, over 500 background events.
  EXPECT_GT(bounds[0], 0.127 / std::sqrt(1000.0));
  EXPECT_LT(bounds[0], 1.3 * 0.127 / std::sqrt(1000.0));
  EXPECT_EQ(bounds[1], 0.0);
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
  ASSERT_EQ(measured.size(), 5U);
  for (std::size_t e = 0; e < measured.size(); ++e) {
    EXPECT_EQ(measured[e].distance_m, again[e].distance_m) << one.estimators()[e];
    EXPECT_EQ(measured[e].confidence, again[e].confidence) << one.estimators()[e];
  }
  const double his_pointer = score_scene(truth, measured[0]).all.above_3_percent;
  const double pool_pointer = score_scene(truth, measured[1]).all.above_3_percent;
  EXPECT_LT(pool_pointer, 0.5 * his_pointer);
}

// Engines are whole, however few columns are judged, and the other estimators do not notice.
TEST(SceneStudy, ReadsWholeEnginesOfColumnsThatUseEachOther) {
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 400;
  const ReadoutParameters alone = ReadoutParameters::defaults(Readout::kFifh);
  ReadoutParameters together = ReadoutParameters::defaults(Readout::kPoolPointer);
  together.pool.engine_columns = 4;
  TargetMap targets(10, 24, {2.0, 0.6});
  targets.at(5, 5).depth_m = 3.0;
  const StudyScene scene{"wall", targets, 3};
  const SceneStudy both(sensor, 14.0, std::vector{alone, together}, 5, 2, TableRule::kNone);
  const SceneStudy one(sensor, 14.0, std::vector{alone}, 5, 2, TableRule::kNone);
  const std::vector<SceneMeasurement> measured = both.measure(scene);
  const std::vector<SceneMeasurement> others = one.measure(scene);
  ASSERT_EQ(measured.size(), 5U);
  for (const std::size_t e : {0U, 2U, 3U, 4U}) {
    EXPECT_EQ(measured[e].distance_m, others[e == 0 ? 0 : e - 1].distance_m) << both.estimators()[e];
  }
  const PhotonSource photons(sensor, targets, 14.0, 5, scene_frame(0));
  const std::vector<PixelResult> whole = run_frame(photons, together);
  const DepthScale scale(sensor.integration_time_s, sensor.np, sensor.pulse_fwhm_s);
  for (std::size_t row = 0; row < 24; ++row) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto column = static_cast<std::size_t>(picked_column(scene, static_cast<int>(i)));
      const double position = code_position(whole[row * 10 + column], together.fraction_bits);
      EXPECT_EQ(measured[1].distance_m[row * 3 + i], scale.depth(position)) << column << " " << row;
    }
  }
}

TEST(SceneStudy, PoolingHelpsTheMatchedFilterWhereASinglePixelIsLost) {
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 1000;
  const StudyScene scene{"wall", TargetMap(4, 80, {4.0, 1.0}), 4};
  const SceneTruth truth = scene_truth(scene);
  const SceneStudy study(sensor, 50.0, {}, 3, 0);
  const std::vector<SceneMeasurement> measured = study.measure(scene);
  const std::vector<std::string>& names = study.estimators();
  const auto outliers = [&](std::string_view name) {
    const auto index = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    return score_scene(truth, measured.at(index)).all.above_10_percent;
  };
  EXPECT_GT(outliers("matched filter (single pixel)"), 0.1);
  EXPECT_LT(outliers("pooled matched filter"), 0.5 * outliers("matched filter (single pixel)"));
}

TEST(SceneStudy, TablesAreThoseOfTheSensorInClearConditions) {
  // A laser that is a nanosecond late all the time: no table may know, whatever reads the pixel.
  SensorModel sensor = parse_preset("thesis");
  sensor.surroundings.settling = {.delay_s = 1e-9, .time_share = 100.0};
  const std::vector<ReadoutParameters> readouts = {ReadoutParameters::defaults(Readout::kCoarseHistogram),
                                                   ReadoutParameters::defaults(Readout::kPoolPointer)};
  const SceneStudy study(sensor, 2.0, readouts, 3, 0);
  const std::vector<SceneMeasurement> measured = study.measure({"wall", TargetMap(34, 8, {2.0, 1.0}), 4});
  ASSERT_EQ(measured.size(), 5U);
  for (std::size_t e = 0; e < measured.size(); ++e) {
    std::vector<double> distances = measured[e].distance_m;
    std::ranges::nth_element(distances, distances.begin() + 16);
    EXPECT_THAT(distances[16], DoubleNear(2.15, 0.05)) << study.estimators()[e];
  }
}

}  // namespace
}  // namespace dtof
