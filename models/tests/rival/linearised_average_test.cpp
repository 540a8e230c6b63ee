// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/linearised_average.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

RivalWords read(const Rival& rival, const std::vector<Detection>& background,
                const std::vector<Detection>& lit) {
  const std::array<std::span<const Detection>, 2> frames = {background, lit};
  return rival.read_pixel(frames);
}

TEST(LinearisedAverage, BitsOfAPixel) {
  const std::unique_ptr<Rival> average = make_linearised_average(SensorModel());
  EXPECT_EQ(average->bits_per_pixel(), 10 + 12 + 22);  // L, n up to 3333, s
  EXPECT_EQ(average->frames(), 2);
  EXPECT_EQ(average->laser_off_frames(), 1);
}

TEST(LinearisedAverage, ByHand) {
  SensorModel sensor;
  sensor.acquisitions = 6;
  const std::unique_ptr<Rival> average = make_linearised_average(sensor);
  // 100; 300, which is later than 100 (50 is not); 200 is not later than 300; nothing; 700; no detection. So
  // n = 3, s = 1100 and three acquisitions end a sweep. Without laser light n0 = 1: the second 511 is not
  // later than the first.
  const RivalWords words =
      read(*average, {{0, 511}, {1, 511}}, {{0, 100}, {1, 50}, {1, 300}, {2, 200}, {4, 700}, {5, 1023}});
  EXPECT_THAT(words, ElementsAre(3, 1100, 1));
  // b = 1 * 3 / 5 = 0.6; (1100 - 0.6 * 511) / 2.4; 2.4 / sqrt(3 + 0.6 * 0.6).
  EXPECT_NEAR(average->decode(words).position, 793.4 / 2.4, 1e-9);
  EXPECT_NEAR(average->decode(words).confidence, 1.30931, 1e-5);
}

// An acquisition that is missing ends the sweep as one without a later detection does.
TEST(LinearisedAverage, AnEmptyAcquisitionEndsTheSweep) {
  const std::unique_ptr<Rival> average = make_linearised_average(SensorModel());
  EXPECT_THAT(read(*average, {}, {{0, 500}, {2, 400}}), ElementsAre(2, 900, 0));
  EXPECT_THAT(read(*average, {}, {{0, 500}, {1, 400}}), ElementsAre(1, 500, 0));
}

// Each pulse returns a photon at 100 and one at 900: their mean is 500, while the first photon is always at
// 100.
TEST(LinearisedAverage, IsNotDistortedByPileUp) {
  SensorModel sensor;
  sensor.acquisitions = 3000;
  const std::unique_ptr<Rival> average = make_linearised_average(sensor);
  std::vector<Detection> lit;
  for (std::uint32_t acquisition = 0; acquisition < sensor.acquisitions; ++acquisition) {
    lit.push_back({acquisition, 100});
    lit.push_back({acquisition, 900});
  }
  const RivalWords words = read(*average, {}, lit);
  EXPECT_THAT(words, ElementsAre(2000, 1'000'000, 0));
  EXPECT_DOUBLE_EQ(average->decode(words).position, 500.0);
}

TEST(LinearisedAverage, WithoutSignalHasNoConfidence) {
  const std::unique_ptr<Rival> average = make_linearised_average(SensorModel());
  for (const RivalWords& words : {RivalWords{0, 0, 0}, RivalWords{2, 900, 5}}) {
    EXPECT_EQ(average->decode(words).position, 511.0);
    EXPECT_EQ(average->decode(words).confidence, 0.0);
  }
}

TEST(LinearisedAverage, RefusesASumThatIsTooWide) {
  SensorModel sensor;
  sensor.np = 16;
  sensor.acquisitions = 1U << 16U;
  EXPECT_THAT([&] { (void)make_linearised_average(sensor); },
              ThrowsMessage<InputError>(HasSubstr("a sum of 33 bits, but it must be at most 31")));
}

}  // namespace
}  // namespace dtof
