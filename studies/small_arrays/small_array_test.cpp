// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/small_array.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

SensorModel short_frames(int columns, int rows) {
  SensorModel sensor = find_sensor("thesis");
  sensor.acquisitions = 1000;
  sensor.columns = columns;
  sensor.rows = rows;
  return sensor;
}

TargetMap slope(int columns, int rows) {
  TargetMap map(columns, rows);
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      map.at(column, row) = {1.0 + 0.05 * column, 0.3 + 0.02 * row};
    }
  }
  return map;
}

TEST(SmallArray, TheLasersPowerIsTheSameAndTheBackgroundStays) {
  const SensorModel sensor = find_sensor("thesis");
  for (const auto& [columns, rows] : {std::pair{200, 160}, {100, 80}, {80, 64}, {50, 40}}) {
    const SensorModel shared = sharing_the_laser(sensor, make_spot_grid(200, 160, columns, rows));
    EXPECT_EQ(shared.columns, columns);
    EXPECT_EQ(shared.rows, rows);
    EXPECT_NEAR(shared.signal_events_1m * columns * rows, sensor.signal_events_1m * 32000.0, 1e-6);
    EXPECT_EQ(shared.background_events(50.0, 0.5), sensor.background_events(50.0, 0.5));
    EXPECT_EQ(shared.acquisitions, sensor.acquisitions);
  }
}

TEST(SmallArray, MeasuresWhatABrighterArrayOfItsSizeWould) {
  const std::vector<std::string> readouts = {"hispointer", "histogram32", "poolpointer"};
  const TargetMap targets = slope(16, 12);
  const SpotGrid grid = make_spot_grid(16, 12, 8, 6);
  const SmallArray small(short_frames(16, 12), grid, 50.0, readouts, 3, 1);
  SensorModel brighter = short_frames(8, 6);
  brighter.signal_events_1m *= 4.0;
  const SmallArray same(brighter, make_spot_grid(8, 6, 8, 6), 50.0, readouts, 3, 2);
  const std::vector<SmallMap> maps = small.measure(targets, 5);
  const std::vector<SmallMap> others = same.measure(spots_of(targets, grid), 5);
  ASSERT_EQ(maps.size(), 3U);
  ASSERT_EQ(others.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(maps[i].grid.x, grid.x);
    EXPECT_EQ(maps[i].distance_m, others[i].distance_m) << readouts[i];
    EXPECT_EQ(maps[i].confidence, others[i].confidence) << readouts[i];
  }
  EXPECT_NE(small.measure(targets, 6)[0].distance_m, maps[0].distance_m);
}

TEST(SmallArray, EachReadOutGivesTheDistancesByItsOwnTable) {
  const std::vector<std::string> readouts = {"hispointer", "histogram32", "poolpointer"};
  SensorModel sensor = short_frames(16, 12);
  sensor.acquisitions = 4000;
  const SmallArray small(sensor, make_spot_grid(16, 12, 8, 6), 1.0, readouts, 3, 1);
  EXPECT_THAT(small.titles(), ElementsAre("hisPointer", HasSubstr("32"), "poolPointer"));
  const TargetMap targets = slope(16, 12);
  const std::vector<SmallMap> maps = small.measure(targets, 5);
  for (std::size_t i = 0; i < 3; ++i) {
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 8; ++column) {
        const double right = targets.at(2 * column + 1, 2 * row + 1).depth_m;
        EXPECT_NEAR(maps[i].distance(column, row) / right, 1.0, 0.06) << readouts[i];
      }
    }
  }
}

TEST(SmallArray, RefusesWhatItCannotReadOut) {
  const SpotGrid grid = make_spot_grid(16, 12, 8, 6);
  const auto made_with = [&](const std::string& name) {
    return [=] { const SmallArray array(short_frames(16, 12), grid, 50.0, std::vector{name}, 3, 1); };
  };
  EXPECT_THAT(made_with("hispinter"), ThrowsMessage<InputError>(HasSubstr("hispinter")));
  EXPECT_THAT(made_with("guided"), ThrowsMessage<InputError>(HasSubstr("frames, not one")));
}

}  // namespace
}  // namespace dtof
