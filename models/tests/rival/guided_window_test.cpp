// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/guided_window.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "dtof/core/error.hpp"
#include "tests/rival/test_pixels.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

RivalWords read(const Rival& rival, const std::vector<Detection>& first, const std::vector<Detection>& second,
                const std::vector<Detection>& third) {
  return rival.read_pixel(std::vector<std::span<const Detection>>{first, second, third});
}

TEST(GuidedWindow, NarrowsAroundTheFirstFramesHighestBin) {
  const std::unique_ptr<Rival> rival = make_guided_window(SensorModel(), {});
  EXPECT_EQ(rival->bits_per_pixel(), 8 * 10 + 10);
  EXPECT_EQ(rival->frames(), 3);
  // Bin 3 of 128 codes; second window 448 - 128 .. 576; nothing there, so its lowest code is the guide.
  const std::vector<Detection> first = one_each(std::array{400, 500, 401, 1023, 1023, 1023});
  EXPECT_THAT(read(*rival, first, {}, one_each(std::array{256, 271, 272, 383, 384, 255, 1023})),
              ElementsAre(256, 2, 1, 0, 0, 0, 0, 0, 1));
}

TEST(GuidedWindow, StaysInTheRange) {
  const std::unique_ptr<Rival> rival = make_guided_window(SensorModel(), {});
  const std::vector<Detection> near = one_each(std::array{3, 3});
  EXPECT_THAT(read(*rival, near, near, near), ElementsAre(0, 2, 0, 0, 0, 0, 0, 0, 0));
  const std::vector<Detection> far = one_each(std::array{1022, 1022});
  EXPECT_THAT(read(*rival, far, far, far), ElementsAre(896, 0, 0, 0, 0, 0, 0, 0, 2));
}

TEST(GuidedWindow, AFullBinStaysFull) {
  const std::unique_ptr<Rival> rival = make_guided_window(SensorModel(), {.count_bits = 2});
  const std::vector<Detection> pixel = one_each(std::vector<int>(9, 3));
  EXPECT_EQ(read(*rival, pixel, pixel, pixel)[1], 3);
}

TEST(GuidedWindow, FindsANoiseFreePulse) {
  SensorModel sensor;
  sensor.acquisitions = 20000;
  const std::unique_ptr<Rival> rival = make_guided_window(sensor, {.count_bits = 12});
  for (const double centre : {100.0, 256.0, 300.5, 511.5, 800.0}) {
    for (const int floor : {0, 2}) {
      const std::vector<Detection> pixel = noise_free_pulse(sensor, centre, 4000.0, floor);
      const RivalWords words = read(*rival, pixel, pixel, pixel);
      EXPECT_NEAR(rival->decode(words).position, centre, 1.0) << centre << " " << floor;
      const std::vector<double> evidence = rival->evidence(words);
      EXPECT_EQ(evidence[0], 0.0) << "nothing is known beyond the window";
    }
  }
}

// What is guided to the wrong place stays there.
TEST(GuidedWindow, AWrongFirstFrameIsKept) {
  SensorModel sensor;
  sensor.acquisitions = 20000;
  const std::unique_ptr<Rival> rival = make_guided_window(sensor, {});
  const std::vector<Detection> wrong = noise_free_pulse(sensor, 800.0, 500.0, 0);
  const std::vector<Detection> right = noise_free_pulse(sensor, 200.0, 500.0, 1);
  EXPECT_GT(rival->decode(read(*rival, wrong, right, right)).position, 600.0);
  EXPECT_NEAR(rival->decode(read(*rival, right, right, right)).position, 200.0, 1.5);
}

TEST(GuidedWindow, RefusesAnOlderFrameToo) {
  const std::unique_ptr<Rival> rival = make_guided_window(SensorModel(), {});
  EXPECT_THAT([&] { (void)read(*rival, one_each(std::array{1024}), {}, {}); },
              ThrowsMessage<InputError>(HasSubstr("timestamp 1024")));
  EXPECT_THAT([] { (void)make_guided_window(SensorModel(), {.count_bits = 0}); },
              ThrowsMessage<InputError>(HasSubstr("bins of 0 bits")));
}

}  // namespace
}  // namespace dtof
