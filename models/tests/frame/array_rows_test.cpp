// SPDX-License-Identifier: Apache-2.0
#include "dtof/frame/array_rows.hpp"

#include <gtest/gtest.h>

#include "dtof/photon/photon_source.hpp"

namespace dtof {
namespace {

constexpr RowRange kRegion = {.first = 3, .count = 6};

PhotonSource scene() {
  SensorModel sensor;
  sensor.acquisitions = 10;
  TargetMap targets(2, 12);
  for (int row = 0; row < 12; ++row) {
    targets.at(0, row) = targets.at(1, row) = {.depth_m = 1.0, .reflectivity = 1.0};
  }
  return {sensor, targets, 14.0, 1};
}

/// A frame of two columns whose codes are numbers of pixels.
std::vector<PixelResult> counted(int rows) {
  std::vector<PixelResult> frame(2 * static_cast<std::size_t>(rows));
  for (std::size_t pixel = 0; pixel < frame.size(); ++pixel) {
    frame[pixel].code = static_cast<std::uint16_t>(pixel);
  }
  return frame;
}

TEST(ArrayRows, IndependentPixelsAreThoseOfTheRegion) {
  const PhotonSource source = scene();
  const ArrayRows array = array_rows(source, kRegion, Readout::kSifh);
  EXPECT_EQ(array.source->rows(), 6);
  EXPECT_EQ(array.first, 3);
  EXPECT_EQ(array.read(counted(6)), counted(6));
}

TEST(ArrayRows, AnArrayOfAPoolReadoutMayHaveTheSensorsRowsAlone) {
  const PhotonSource source = scene();
  const ArrayRows array = array_rows(source, kRegion, Readout::kPoolPointer, true);
  EXPECT_EQ(array.source->rows(), 12);
  const std::vector<PixelResult> read = array.read(counted(12));
  ASSERT_EQ(read.size(), 12U);
  EXPECT_EQ(read.front().code, 6);
}

TEST(ArrayRows, AnArrayOfAPoolReadoutIsWholeAndItsRegionIsRead) {
  const PhotonSource source = scene();
  const ArrayRows array = array_rows(source, kRegion, Readout::kPoolPointer);
  EXPECT_EQ(array.source->rows(), kArrayRows);
  EXPECT_EQ(array.first, 0);
  const std::vector<PixelResult> read = array.read(counted(kArrayRows));
  ASSERT_EQ(read.size(), 12U);
  EXPECT_EQ(read.front().code, 6);
  EXPECT_EQ(read.back().code, 17);
}

}  // namespace
}  // namespace dtof
