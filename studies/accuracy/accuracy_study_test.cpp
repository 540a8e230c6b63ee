// SPDX-License-Identifier: Apache-2.0
#include "accuracy/accuracy_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include "common/array_size.hpp"
#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

StudySettings small_accuracy_study() {
  StudySettings settings;
  settings.sensor = parse_preset("thesis");
  settings.distances_m = {1.0, 1.5, 2.0};
  settings.readouts = {ReadoutParameters::defaults(Readout::kEzPointer),
                       ReadoutParameters::defaults(Readout::kHisPointer)};
  settings.frames = 60;
  settings.calibration_frames = 60;
  settings.calibration_step_m = 0.1;
  settings.run.seed = test_seed();
  return settings;
}

void expect_same(const AccuracyStudy& a, const AccuracyStudy& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].relative_precision, b.points[i].relative_precision);
    EXPECT_EQ(a.points[i].rmse_m, b.points[i].rmse_m);
  }
}

TEST(AccuracyStudy, ThreadsDoNotChangeIt) {
  SCOPED_TRACE(test_seed_message());
  StudySettings settings = small_accuracy_study();
  settings.run.threads = 1;
  const AccuracyStudy one = run_accuracy_study(settings);
  settings.run.threads = 3;
  expect_same(one, run_accuracy_study(settings));
}

TEST(AccuracyStudy, AReadoutSeesTheSamePhotonsAloneOrWithOthers) {
  SCOPED_TRACE(test_seed_message());
  StudySettings settings = small_accuracy_study();
  const AccuracyStudy together = run_accuracy_study(settings);
  settings.readouts = {ReadoutParameters::defaults(Readout::kHisPointer)};
  settings.matched_filter = false;
  const AccuracyStudy alone = run_accuracy_study(settings);
  for (const AccuracyPoint& point : alone.points) {
    EXPECT_EQ(point.rmse_m, together.at("hispointer", point.distance_m).rmse_m);
  }
}

TEST(AccuracyStudy, CalibrationAndEvaluationShareNoFrame) {
  StudySettings settings = small_accuracy_study();
  settings.precision = 1e-9;
  settings.most_frames = 240;
  std::mutex mutex;
  std::multiset<std::uint32_t> frames;
  settings.make_source = [&](const SensorModel& sensor, const TargetMap& targets, double klux,
                             std::uint64_t seed, std::uint32_t frame) {
    const std::scoped_lock lock(mutex);
    frames.insert(frame);
    return make_exact_source(sensor, targets, klux, seed, frame);
  };
  (void)run_accuracy_study(settings);
  EXPECT_GT(frames.size(), 12U);  // three distances of three batches, calibration
  EXPECT_EQ(frames.size(), std::set<std::uint32_t>(frames.begin(), frames.end()).size());
}

TEST(AccuracyStudy, MatchedFilterIsNearTheBound) {
  SCOPED_TRACE(test_seed_message());
  StudySettings settings = small_accuracy_study();
  settings.frames = 800;
  settings.calibration_frames = 200;
  const AccuracyStudy study = run_accuracy_study(settings);
  for (const double distance : {1.0, 1.5, 2.0}) {
    EXPECT_NEAR(study.at("matched-filter", distance).efficiency.value, 1.0, 0.12) << distance;
    EXPECT_LT(study.at("hispointer", distance).efficiency.interval.high, 1.0) << distance;
  }
  EXPECT_NEAR(study.at("matched-filter", 1.5).slope->value, 1.0, 0.01);
}

TEST(AccuracyStudy, PrecisionStopsWhenReached) {
  SCOPED_TRACE(test_seed_message());
  StudySettings settings = small_accuracy_study();
  settings.precision = 0.06;
  settings.most_frames = 5000;
  const AccuracyStudy study = run_accuracy_study(settings);
  for (const AccuracyPoint& point : study.points) {
    EXPECT_TRUE(point.precision_reached);
    EXPECT_LE(point.rmse_m.relative_half_width(), 0.06);
    EXPECT_LE(point.relative_precision.relative_half_width(), 0.06);
    // A normal error needs 1.96^2 / 2 / 0.06^2 = 530 frames.
    EXPECT_GT(point.frames, 240U);
    EXPECT_LT(point.frames, 5000U);
  }
  settings.precision = 1e-6;
  settings.most_frames = 200;
  const AccuracyStudy hopeless = run_accuracy_study(settings);
  const AccuracyPoint& given_up = hopeless.points.front();
  EXPECT_FALSE(given_up.precision_reached);
  EXPECT_EQ(given_up.frames, 200U);
}

ErrorEstimates errors_with(double half_width, std::uint64_t far_from_others) {
  const Estimate estimate{1.0, {1.0 - half_width, 1.0 + half_width}};
  return {estimate, estimate, estimate, estimate, estimate, far_from_others};
}

TEST(PrecisionReached, NeedsManyOutliersOrSurelyRareOnes) {
  // None in 3687 frames: 1 - 0.025^(1/3687) = 0.1 % at 95 %.
  EXPECT_TRUE(precision_reached(errors_with(0.049, 0), errors_with(0.049, 0), 3688, 0.05, 1e-3));
  EXPECT_FALSE(precision_reached(errors_with(0.049, 0), errors_with(0.049, 0), 3600, 0.05, 1e-3));
  EXPECT_TRUE(precision_reached(errors_with(0.049, 0), errors_with(0.049, 0), 400, 0.05, 1e-2));
  EXPECT_TRUE(precision_reached(errors_with(0.049, 10), errors_with(0.049, 10), 100, 0.05, 1e-3));
  EXPECT_FALSE(precision_reached(errors_with(0.049, 9), errors_with(0.049, 10), 100'000, 0.05, 1e-3));
  EXPECT_FALSE(precision_reached(errors_with(0.049, 10), errors_with(0.049, 1), 100'000, 0.05, 1e-3));
  EXPECT_FALSE(precision_reached(errors_with(0.051, 10), errors_with(0.049, 10), 100, 0.05, 1e-3));
  EXPECT_FALSE(precision_reached(errors_with(0.049, 10), errors_with(0.051, 10), 100, 0.05, 1e-3));
}

TEST(AccuracyStudy, TheTableDependsOnTheCalibrationSeedOnly) {
  SCOPED_TRACE(test_seed_message());
  StudySettings settings = small_accuracy_study();
  settings.frames = 8;
  std::mutex mutex;
  std::set<std::pair<std::uint64_t, double>> calibrations;  // seed, distance
  settings.make_source = [&](const SensorModel& sensor, const TargetMap& targets, double klux,
                             std::uint64_t seed, std::uint32_t frame) {
    const std::scoped_lock lock(mutex);
    if (frame >= 1U << 31U) {
      calibrations.emplace(seed, targets.at(0, 0).depth_m);
    }
    return make_exact_source(sensor, targets, klux, seed, frame);
  };
  (void)run_accuracy_study(settings);
  const auto first = calibrations;
  ++settings.run.seed;
  (void)run_accuracy_study(settings);
  EXPECT_EQ(calibrations, first);
  settings.distances_m = {1.5};  // other distances evaluated: the same runs where they are needed
  (void)run_accuracy_study(settings);
  EXPECT_EQ(calibrations, first);
  ++settings.calibration_seed;
  (void)run_accuracy_study(settings);
  EXPECT_GT(calibrations.size(), first.size());
}

TEST(AccuracyStudy, PooledPixelsAreIndependent) {
  SCOPED_TRACE(test_seed_message());
  StudySettings settings = small_accuracy_study();
  settings.distances_m = {3.0};
  settings.klux = 50.0;
  settings.frames = 8;
  settings.lookup_table = false;
  settings.readouts = {ReadoutParameters::defaults(Readout::kPoolPointer)};
  int columns = 0;
  int rows = 0;
  settings.make_source = [&](const SensorModel& sensor, const TargetMap& targets, double klux,
                             std::uint64_t seed, std::uint32_t frame) {
    columns = targets.columns();
    rows = targets.rows();
    return make_exact_source(sensor, targets, klux, seed, frame);
  };
  EXPECT_EQ(run_accuracy_study(settings).points.front().frames, 8U);
  EXPECT_EQ(columns, 8 * 6);  // one pixel counts of six columns each
  EXPECT_EQ(rows, 160);
}

TEST(AccuracyStudy, RejectionRemovesOutliers) {
  SCOPED_TRACE(test_seed_message());
  StudySettings settings = small_accuracy_study();
  settings.distances_m = {2.0, 5.0};
  settings.readouts = {ReadoutParameters::defaults(Readout::kFifh)};
  settings.matched_filter = false;
  settings.frames = 1000;
  settings.rejection = 0.01;
  const AccuracyPoint point = run_accuracy_study(settings).at("fifh", 5.0);
  EXPECT_GT(point.outlier_rate.value, 0.04);
  EXPECT_LT(point.outliers_kept->value, 0.5 * point.outlier_rate.value);
  EXPECT_LT(point.accepted->value, 1.0);
}

TEST(AccuracyStudy, Refusals) {
  const auto changed = [](auto change) {
    StudySettings settings = small_accuracy_study();
    change(settings);
    return [settings] { (void)run_accuracy_study(settings); };
  };
  EXPECT_THAT(changed([](auto& s) { s.distances_m = {NAN}; }), ThrowsMessage<InputError>(HasSubstr("nan m")));
  EXPECT_THAT(changed([](auto& s) { s.distances_m.clear(); }),
              ThrowsMessage<InputError>(HasSubstr("at least one")));
  EXPECT_THAT(changed([](auto& s) { s.frames = 3; }), ThrowsMessage<InputError>(HasSubstr("at least 4")));
  EXPECT_THAT(changed([](auto& s) { s.precision = -1.0; }), ThrowsMessage<InputError>(HasSubstr("-1")));
  EXPECT_THAT(changed([](auto& s) { s.klux = -1.0; }), ThrowsMessage<InputError>(HasSubstr("-1")));
}

TEST(AccuracyStudy, AnEngineOfColumnsIsOnePixelsAlone) {
  SCOPED_TRACE(test_seed_message());
  StudySettings settings = small_accuracy_study();
  settings.sensor.acquisitions = 500;
  settings.distances_m = {2.0};
  settings.frames = 8;
  settings.calibration_frames = 8;
  settings.calibration_step_m = 0.5;
  settings.matched_filter = false;
  settings.readouts = {ReadoutParameters::defaults(Readout::kPoolPointerLean)};
  const AccuracyStudy alone = run_accuracy_study(settings);
  settings.readouts.push_back(ReadoutParameters::defaults(Readout::kPoolPointer));
  const AccuracyStudy both = run_accuracy_study(settings);
  ASSERT_EQ(both.points.size(), 2U);
  EXPECT_EQ(both.points[0].rmse_m, alone.points[0].rmse_m) << "the same photons";
  EXPECT_LT(both.points[1].rmse_m.value, 0.06);
  settings.run.engine = "rtl";
  EXPECT_THAT([&] { (void)run_accuracy_study(settings); },
              ThrowsMessage<InputError>(HasSubstr("only its model reads it")));
}

TEST(IndependentPixels, EnginesShareNoColumn) {
  SensorModel sensor = parse_preset("thesis");
  const IndependentPixels pixels(sensor, 5, true, 6);
  EXPECT_EQ(pixels.targets({.depth_m = 1.0}).columns(), 30);
  std::set<int> columns;
  for (int index = 0; index < 5; ++index) {
    for (int place = 0; place < 6; ++place) {
      columns.insert(pixels.column(index, place));
    }
  }
  EXPECT_EQ(columns.size(), 30U);
  EXPECT_EQ(*columns.rbegin(), 29);
}

TEST(IndependentPixels, CountedPixelsShareNoNeighbour) {
  SensorModel sensor = parse_preset("thesis");
  EXPECT_EQ(IndependentPixels(sensor, 1000).pitch, 1);
  EXPECT_EQ(IndependentPixels(sensor, 1000).columns * IndependentPixels(sensor, 1000).rows, 1000);
  sensor.binning = 2;
  EXPECT_EQ(IndependentPixels(sensor, 10).pitch, 2);
  sensor.coincidence_window_s = 1e-9;
  const IndependentPixels both(sensor, 10);
  EXPECT_EQ(both.pitch, 6);
  EXPECT_EQ(both.column(1), 8);
  EXPECT_EQ(both.row(1), 8);
  EXPECT_EQ(both.targets({.depth_m = 1.0}).columns(), 6 * both.columns);
  const IndependentPixels pooled(sensor, 10, true);
  EXPECT_EQ(pooled.columns, 10);
  EXPECT_EQ(pooled.rows, 1);
  EXPECT_EQ(pooled.row(0), 6 * 80 + 2);
  EXPECT_EQ(pooled.targets({.depth_m = 1.0}).rows(), 6 * 160);
}

TEST(ArraySize, FewerSensorsGetMoreLight) {
  const SensorModel sensor = with_sensors(parse_preset("thesis"), 3200.0);
  EXPECT_DOUBLE_EQ(sensor.signal_events(1.0, 1.0), 3.0);
  EXPECT_DOUBLE_EQ(sensor.background_events(14.0, 1.0), parse_preset("thesis").background_events(14.0, 1.0));
}

TEST(ArraySize, LargestOfThoseTried) {
  const std::vector<ArrayMargin> margins = {
      {"x", "x", 8000.0, 1.2, 1.2}, {"x", "x", 4000.0, 0.9, 1.1}, {"x", "x", 2000.0, 1.1, 1.1}};
  const LargestArray by_precision = largest_array(margins, &ArrayMargin::by_precision);
  EXPECT_EQ(by_precision.sensors, 4000.0);
  EXPECT_EQ(by_precision.too_many, 8000.0);
  EXPECT_EQ(largest_array(margins, &ArrayMargin::by_rmse).sensors, 0.0);
}

}  // namespace
}  // namespace dtof
