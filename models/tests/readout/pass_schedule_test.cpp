// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pass_schedule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <span>
#include <vector>

#include "dtof/core/pixel_sampler.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(FramePart, HalvesOfShortFrames) {
  EXPECT_EQ(measurement_1(0), (AcquisitionRange{0, 0}));
  EXPECT_EQ(measurement_2(0), (AcquisitionRange{0, 0}));
  EXPECT_EQ(measurement_1(1), (AcquisitionRange{0, 0}));
  EXPECT_EQ(measurement_2(1), (AcquisitionRange{0, 1}));
  EXPECT_EQ(measurement_1(7), (AcquisitionRange{0, 3}));
  EXPECT_EQ(measurement_2(7), (AcquisitionRange{3, 7}));
}

TEST(FramePart, PartsCoverTheFrameWithoutOverlap) {
  for (const std::uint32_t count : {1U, 2U, 3U, 16U, 32768U}) {
    for (const std::uint32_t acquisitions :
         {0U, 1U, 2U, 7U, 33333U, std::numeric_limits<std::uint32_t>::max()}) {
      std::uint32_t next = 0;
      for (std::uint32_t index = 0; index < count; ++index) {
        const AcquisitionRange part = frame_part(acquisitions, index, count);
        ASSERT_EQ(part.begin, next);
        ASSERT_LE(part.size(), std::uint64_t{acquisitions} / count + 1);
        next = part.end;
      }
      ASSERT_EQ(next, acquisitions);
    }
  }
}

TEST(PassCursor, DropsNoDetectionAndStopsAtThePassEnd) {
  const std::vector<Detection> row = {{0, 3}, {0, 15}, {1, 4}, {4, 5}, {4, 6}, {5, 15}};
  PassCursor cursor(row, 15);
  const auto take = [&cursor](std::uint32_t end) {
    std::vector<std::uint32_t> taken;
    cursor.advance_to(end, 0, 16, [&taken](std::uint32_t timestamp) { taken.push_back(timestamp); });
    return taken;
  };
  EXPECT_THAT(take(1), ElementsAre(3));
  EXPECT_THAT(take(1), IsEmpty());
  EXPECT_THAT(take(4), ElementsAre(4));
  EXPECT_THAT(take(100), ElementsAre(5, 6));
}

TEST(PassCursor, EmptyRow) {
  PassCursor cursor({}, 15);
  cursor.advance_to(100, 0, 16,
                    [](std::uint32_t /*timestamp*/) { FAIL() << "an empty row has no timestamp"; });
}

// Draws what it was asked for and the no-detection code of 4 bits.
class EchoSampler final : public PixelSampler {
 public:
  void start_pixel(int /*column*/, int /*row*/) override {}
  std::span<const Timestamp> draw(std::uint32_t acquisitions, std::int32_t first,
                                  std::int32_t last) override {
    codes_ = {static_cast<Timestamp>(acquisitions), 15, static_cast<Timestamp>(first),
              static_cast<Timestamp>(last)};
    return codes_;
  }

 private:
  std::vector<Timestamp> codes_;
};

TEST(SampledCursor, DrawsEachPassOnceAndDropsNoDetection) {
  EchoSampler sampler;
  SampledCursor cursor(sampler, 15);
  const auto take = [&cursor](std::uint32_t end) {
    std::vector<std::uint32_t> taken;
    cursor.advance_to(end, 7, 9, [&taken](std::uint32_t timestamp) { taken.push_back(timestamp); });
    return taken;
  };
  EXPECT_THAT(take(3), ElementsAre(3, 7, 9));
  EXPECT_THAT(take(3), IsEmpty());
  EXPECT_THAT(take(5), ElementsAre(2, 7, 9));
}

}  // namespace
}  // namespace dtof
