// SPDX-License-Identifier: Apache-2.0
#include "faults/stream_faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace dtof {
namespace {

using testing::ElementsAre;

ColumnStream two_pixels() {
  ColumnStream column;
  column.append_row(std::vector<Detection>{{0, 50}, {0, 70}, {2, 30}});
  column.append_row(std::vector<Detection>{{1, 90}});
  return column;
}

std::vector<Detection> row(const ColumnStream& column, int index) {
  const std::span<const Detection> detections = column.row(index);
  return {detections.begin(), detections.end()};
}

TEST(StreamFaults, StuckTimestampsFillEverySlotOfEveryPixel) {
  const ColumnStream stuck = with_stuck_timestamps(two_pixels(), 2, 2, 7);
  ASSERT_EQ(stuck.rows(), 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_THAT(row(stuck, i),
                ElementsAre(Detection{0, 7}, Detection{0, 7}, Detection{1, 7}, Detection{1, 7}));
  }
}

// The third event of acquisition 0 finds no slot; in acquisition 2 the hot pixel fires after the photon.
TEST(StreamFaults, AHotPixelTakesASlotInTheOrderOfTime) {
  const ColumnStream hot = with_hot_pixel(two_pixels(), 0, 3, 2, [] { return Timestamp{60}; });
  EXPECT_THAT(row(hot, 0), ElementsAre(Detection{0, 50}, Detection{0, 60}, Detection{1, 60}, Detection{2, 30},
                                       Detection{2, 60}));
  EXPECT_EQ(row(hot, 1), row(two_pixels(), 1));
}

TEST(StreamFaults, AHotPixelAsksForACodeInEveryAcquisition) {
  Timestamp code = 0;
  const ColumnStream hot = with_hot_pixel(ColumnStream(two_pixels()), 1, 3, 2, [&] { return code++; });
  EXPECT_THAT(row(hot, 1), ElementsAre(Detection{0, 0}, Detection{1, 1}, Detection{1, 90}, Detection{2, 2}));
}

TEST(StreamFaults, ADeadPixelSeesNothing) {
  const ColumnStream dead = with_dead_pixel(two_pixels(), 0);
  EXPECT_EQ(dead.rows(), 2);
  EXPECT_TRUE(row(dead, 0).empty());
  EXPECT_EQ(row(dead, 1), row(two_pixels(), 1));
}

}  // namespace
}  // namespace dtof
