// SPDX-License-Identifier: Apache-2.0
#include "common/map_accuracy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/sensor/preset.hpp"
#include "run/readout_run.hpp"

namespace dtof {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Three columns at 1, 2 and 4 m, the last row without a target.
MapAccuracySettings small_map() {
  MapAccuracySettings settings;
  settings.sensor = parse_preset("thesis");
  settings.sensor.acquisitions = 500;
  settings.targets = TargetMap(3, 21, {1.0, 1.0});
  for (int row = 0; row < 21; ++row) {
    settings.targets.at(1, row).depth_m = 2.0;
    settings.targets.at(2, row).depth_m = 4.0;
  }
  for (int column = 0; column < 3; ++column) {
    settings.targets.at(column, 20).depth_m = 0.0;
  }
  settings.readouts = {ReadoutParameters::defaults(Readout::kHisPointer)};
  settings.band_edges_m = {0.5, 1.5, 3.0, 3.5, 4.0};
  settings.frames = 5;
  return settings;
}

TEST(MapAccuracy, BandsHoldTheirPixelsAndTheLastIsClosed) {
  const std::vector<BandAccuracy> rows = run_map_accuracy(small_map());
  ASSERT_EQ(rows.size(), 4U);  // no pixel from 3 to 3.5 m; the whole range last
  EXPECT_EQ(rows[0].pixels, 20U);
  EXPECT_EQ(rows[0].to_m, 1.5);
  EXPECT_EQ(rows[1].pixels, 20U);
  EXPECT_EQ(rows[2].from_m, 3.5);
  EXPECT_EQ(rows[2].pixels, 20U);
  EXPECT_EQ(rows[3].pixels, 60U);
  EXPECT_EQ(rows[3].from_m, 0.5);
  EXPECT_EQ(rows[3].to_m, 4.0);
  EXPECT_NEAR(
      rows[3].above_3_percent.value,
      (rows[0].above_3_percent.value + rows[1].above_3_percent.value + rows[2].above_3_percent.value) / 3.0,
      1e-12);
}

TEST(MapAccuracy, FiguresAreThoseOfThePixelsErrors) {
  MapAccuracySettings settings = small_map();
  const std::vector<BandAccuracy> rows = run_map_accuracy(settings);
  const FlatCalibration calibration(settings.sensor);
  const auto flats = [&](const TargetMap& targets) {
    return std::make_unique<PhotonSource>(settings.sensor, targets, 14.0, 1, FlatCalibration::kFrame);
  };
  const RangeConverter table = calibration.fit(flats, settings.readouts, 1, 1).front();
  ErrorStatistics far;
  for (int frame = 0; frame < settings.frames; ++frame) {
    const PhotonSource source(settings.sensor, settings.targets, 14.0, 1,
                              scene_frame(static_cast<std::uint32_t>(frame)));
    const ReadoutRun run = run_readout(source, settings.readouts[0], {}, Region::whole(3, 21), "");
    for (std::size_t row = 0; row < 20; ++row) {
      far.add(4.0, table.distance(code_position(run.results[row * 3 + 2], 0)));
    }
  }
  const ErrorSummary expected = far.summary();
  EXPECT_NEAR(rows[2].bias_m.value, expected.bias_m, 1e-12);
  EXPECT_NEAR(rows[2].rmse_m.value, expected.rmse_m, 1e-12);
  EXPECT_DOUBLE_EQ(rows[2].above_3_percent.value, expected.share_above_3_percent);
  EXPECT_DOUBLE_EQ(rows[2].above_10_percent.value, expected.share_above_10_percent);
}

TEST(MapAccuracy, IntervalsHoldTheValueAndNoShareIsCertain) {
  for (const BandAccuracy& row : run_map_accuracy(small_map())) {
    for (const Estimate& e : {row.bias_m, row.rmse_m, row.above_3_percent, row.above_10_percent}) {
      EXPECT_LE(e.interval.low, e.value);
      EXPECT_GE(e.interval.high, e.value);
    }
    EXPECT_GT(row.above_10_percent.interval.high, 0.0);
    EXPECT_LE(row.above_3_percent.interval.high, 1.0);
  }
}

TEST(MapAccuracy, EqualBandsSpanTheMap) {
  const MapAccuracySettings settings = small_map();
  const std::vector<double> edges = equal_bands(settings.targets);
  ASSERT_EQ(edges.size(), 11U);
  EXPECT_DOUBLE_EQ(edges.front(), 1.0);
  EXPECT_DOUBLE_EQ(edges[1], 1.3);
  EXPECT_DOUBLE_EQ(edges.back(), 4.0);
  EXPECT_THAT(equal_bands(TargetMap(2, 2, {2.0, 1.0})), ElementsAre(2.0, DoubleNear(2.0, 1e-12)));
  EXPECT_THAT(
      [] {
        (void)equal_bands(TargetMap(2, 2, {0.0, 1.0}));
      },
      ThrowsMessage<InputError>(HasSubstr("no pixel of the map has a target")));
}

TEST(MapAccuracy, RefusesBadBandsAndTooFewFrames) {
  for (const std::vector<double>& edges :
       {std::vector<double>{1.0}, {2.0, 1.0}, {1.0, 1.0}, {-1.0, 2.0}, {1.0, INFINITY}, {NAN, 2.0}}) {
    MapAccuracySettings settings = small_map();
    settings.band_edges_m = edges;
    EXPECT_THAT([&] { (void)run_map_accuracy(settings); },
                ThrowsMessage<InputError>(HasSubstr("ascending edges")));
  }
  MapAccuracySettings settings = small_map();
  settings.band_edges_m = {5.0, 6.0};
  EXPECT_THAT([&] { (void)run_map_accuracy(settings); },
              ThrowsMessage<InputError>(HasSubstr("no pixel of the map lies between 5 and 6 m")));
  settings = small_map();
  settings.frames = 3;
  EXPECT_THAT([&] { (void)run_map_accuracy(settings); },
              ThrowsMessage<InputError>(HasSubstr("at least 4 frames")));
}

}  // namespace
}  // namespace dtof
