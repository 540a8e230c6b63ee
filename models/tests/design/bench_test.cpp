// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/bench.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

SensorModel small_sensor() {
  SensorModel sensor = parse_preset("thesis");
  sensor.columns = 36;
  sensor.rows = 16;
  sensor.acquisitions = 600;
  return sensor;
}

double farthest(const TargetMap& targets) {
  double most = 0.0;
  for (int column = 0; column < targets.columns(); ++column) {
    for (int row = 0; row < targets.rows(); ++row) {
      most = std::max(most, targets.at(column, row).depth_m);
    }
  }
  return most;
}

TEST(Bench, DistancesAreInProportionToTheRange) {
  SensorModel sensor = small_sensor();
  const double thesis = farthest(scaled_scene(Scene::kRoom, sensor, 1));
  sensor.integration_time_s = sensor.pulse_fwhm_s + 3.0 * (sensor.integration_time_s - sensor.pulse_fwhm_s);
  EXPECT_NEAR(farthest(scaled_scene(Scene::kRoom, sensor, 1)), 3.0 * thesis, 1e-9);
  EXPECT_NEAR(thesis, farthest(make_scene(Scene::kRoom, {.columns = 36, .rows = 16})), 1e-9);
}

TEST(Bench, SmallArraysAreReadInMoreFrames) {
  BenchSettings settings;
  settings.sensor = small_sensor();  // 576 pixels
  settings.scenes = {Scene::kRoom, Scene::kPoles};
  EXPECT_EQ(bench_frames(settings, 2), 4);
  EXPECT_EQ(bench_frames(settings, 6), 6);
  settings.sensor.columns = 1;
  settings.sensor.rows = 1;
  EXPECT_EQ(bench_frames(settings, 2), 2000);
  settings.sensor = parse_preset("thesis");
  EXPECT_EQ(bench_frames(settings, 2), 2);
}

TEST(Bench, ColumnsAreAllOrThoseOfSomeParts) {
  SensorModel sensor = small_sensor();
  EXPECT_EQ(bench_columns(sensor, 1e9).size(), 36U);
  EXPECT_EQ(bench_columns(sensor, 16 * 6), (std::vector<int>{5, 6, 17, 18, 29, 30}));
  EXPECT_EQ(bench_columns(sensor, 16 * 2), (std::vector<int>{9, 27}));
  EXPECT_EQ(bench_columns(sensor, 1), (std::vector<int>{18}));
  sensor.columns = 2;
  EXPECT_EQ(bench_columns(sensor, 16 * 2), (std::vector<int>{0, 1}));
}

TEST(Bench, ColumnsAreThoseOfWholeEngines) {
  SensorModel sensor = parse_preset("thesis");
  const auto ranges = [&](double pixels, int engine_columns) {
    std::vector<std::pair<int, int>> found;
    for (const int column : bench_columns(sensor, pixels, engine_columns)) {
      if (found.empty() || column != found.back().second) {
        found.emplace_back(column, column);
      }
      ++found.back().second;
    }
    return found;
  };
  using Ranges = std::vector<std::pair<int, int>>;
  EXPECT_EQ(ranges(160 * 6, 34), (Ranges{{68, 102}}));
  EXPECT_EQ(ranges(160 * 70, 34), (Ranges{{34, 68}, {136, 170}}));
  EXPECT_EQ(ranges(160 * 150, 34), (Ranges{{0, 34}, {68, 102}, {136, 170}}));
  EXPECT_EQ(ranges(160 * 60, 10), (Ranges{{20, 40}, {90, 110}, {160, 180}}));
  EXPECT_EQ(ranges(160 * 6, 100), (Ranges{{100, 200}}));
  EXPECT_EQ(ranges(160 * 200, 100), (Ranges{{0, 200}}));
  EXPECT_EQ(ranges(160 * 200, 34), (Ranges{{0, 200}}));
  EXPECT_EQ(ranges(160 * 199, 34), (Ranges{{0, 34}, {68, 102}, {136, 170}}));
  sensor.columns = 110;  // the last engine has fewer columns
  EXPECT_EQ(ranges(160 * 100, 30), (Ranges{{0, 60}, {90, 110}}));
}

TEST(Bench, RowsAreFewerOnlyWhereOneEngineHasTooManyPixels) {
  const SensorModel sensor = parse_preset("thesis");
  const auto rows = [&](double pixels) {
    const RowRange range = bench_region(sensor, pixels, 34).rows;
    return std::pair(range.first, range.count);
  };
  EXPECT_EQ(rows(160 * 34), std::pair(0, 160));
  EXPECT_EQ(rows(1e9), std::pair(0, 160));
  EXPECT_EQ(rows(34 * 130), std::pair(0, 128));
  EXPECT_EQ(rows(34 * 100), std::pair(32, 96));
  EXPECT_EQ(rows(34), std::pair(32, 64));
  EXPECT_EQ(bench_region(small_sensor(), 34, 34).rows.count, 16);
  SensorModel odd = sensor;
  odd.rows = 100;  // no multiple of 32
  EXPECT_EQ(bench_region(odd, 34 * 101, 34).rows.count, 100);
  EXPECT_EQ(bench_region(odd, 34 * 99, 34).rows.count, 96);
}

TEST(Bench, TablesAreFittedOnceForEachLightAndReadout) {
  const BenchSettings settings{.sensor = small_sensor(), .scenes = {Scene::kRoom}, .klux = {2.0}};
  const std::vector<ReadoutParameters> readouts = {default_parameters(Readout::kEzPointer, settings.sensor),
                                                   default_parameters(Readout::kSifh, settings.sensor)};
  const auto above = [&](std::span<const ReadoutParameters> some, BenchTables* tables) {
    return run_bench(settings, some, {.frames = 2}, nullptr, tables).back().worst().above_3_percent.value;
  };
  const double first = above(readouts, nullptr);
  BenchTables tables;
  EXPECT_EQ(above(std::span(readouts).last(1), &tables), first);
  EXPECT_EQ(above(readouts, &tables), first);
  EXPECT_EQ(above(readouts, &tables), first);
  // A table of another distance shows that the tables are those that were kept.
  const auto before = tables.of(settings.sensor, 2.0, readouts, settings);
  SensorModel farther = settings.sensor;
  farther.integration_time_s *= 2.0;
  const auto kept = tables.of(farther, 2.0, readouts, settings);
  const auto fitted = tables.of(farther, 50.0, readouts, settings);
  EXPECT_EQ(kept.back().distance(300.0), before.back().distance(300.0));
  EXPECT_NE(fitted.back().distance(300.0), before.back().distance(300.0));
}

TEST(Bench, MeasuresTheKnownErrorsOfTheReadouts) {
  const BenchSettings settings{.sensor = small_sensor(), .scenes = {Scene::kRoom}, .klux = {2.0, 50.0}};
  const std::vector<ReadoutParameters> readouts = {default_parameters(Readout::kPoolPointer, settings.sensor),
                                                   default_parameters(Readout::kEzPointer, settings.sensor)};
  const std::vector<ReadoutScore> scores =
      run_bench(settings, readouts, {.pixels = 1e9, .frames = 3, .detection = true});
  ASSERT_EQ(scores.size(), 2U);
  const LightScore& pool = scores[0].worst();
  const LightScore& pointer = scores[1].worst();
  EXPECT_DOUBLE_EQ(pool.klux, 50.0);
  EXPECT_LT(pool.above_3_percent.value, pointer.above_3_percent.value);
  EXPECT_LE(pool.above_10_percent.value, pool.above_3_percent.value);
  EXPECT_LE(pool.above_3_percent.interval.low, pool.above_3_percent.value);
  EXPECT_GE(pool.above_3_percent.interval.high, pool.above_3_percent.value);
  ASSERT_TRUE(pool.detected && pool.false_alarms);
  EXPECT_GT(pool.detected->value, 0.2);
  EXPECT_LE(pool.detected->value, 1.0 - pool.above_10_percent.value + 1e-9);
  EXPECT_LT(pool.false_alarms->value, 0.02) << "the threshold lets 0.1 % pass of another sky";
  EXPECT_GT(*scores[0].threshold, 0);
}

TEST(Bench, SameSeedSameScores) {
  BenchSettings settings{.sensor = small_sensor(), .scenes = {Scene::kPoles}, .klux = {14.0}};
  const std::vector<ReadoutParameters> readouts = {default_parameters(Readout::kSifh, settings.sensor)};
  const auto above = [&] { return run_bench(settings, readouts, {}).front().worst().above_3_percent.value; };
  const double first = above();
  EXPECT_DOUBLE_EQ(above(), first);
  settings.seed = 2;
  EXPECT_NE(above(), first);
}

}  // namespace
}  // namespace dtof
