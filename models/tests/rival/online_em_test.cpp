// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/online_em.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <vector>

#include "tests/rival/test_pixels.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;

TEST(OnlineEm, StagesOfTheFrame) {
  EXPECT_EQ(online_em_stage(0, 80), 0U);
  EXPECT_EQ(online_em_stage(9, 80), 0U);
  EXPECT_EQ(online_em_stage(10, 80), 1U);
  EXPECT_EQ(online_em_stage(59, 80), 5U);
  EXPECT_EQ(online_em_stage(60, 80), 6U);
  EXPECT_EQ(online_em_stage(79, 80), 6U);
}

TEST(OnlineEm, StartsInTheMiddleWithTheLeastWeight) {
  const std::unique_ptr<Rival> em = make_online_em(SensorModel());
  EXPECT_THAT(read_one_frame(*em, {}), ElementsAre(512 * 64, 1024));
  EXPECT_EQ(em->bits_per_pixel(), 32);
}

// By hand: sigma 256, one detection 256 codes after the middle, step 8 of the table.
TEST(OnlineEm, OneDetection) {
  const std::unique_ptr<Rival> em = make_online_em(SensorModel());
  // g = 16 * 1024 / (256 sqrt(2 pi)) exp(-(8.5 / 8)^2 / 2) = 14.5 -> 15 sixteenths; r = 255 * 1024 * 15 /
  // (1024 * 15 + 64512 * 16) = 3.74 -> 4; mu += 256 * 64 * 4 * 257 / (1024 * 16) = 1028; w += (257 * 4 -
  // 1024) / 16 = 0.25 -> 0.
  EXPECT_THAT(read_one_frame(*em, one_each(std::array{768})), ElementsAre(512 * 64 + 1028, 1024));
}

/// The recursion in floating point.
std::array<double, 2> reference(const SensorModel& sensor, const std::vector<Detection>& detections) {
  const double range = std::ldexp(1.0, sensor.np);
  const double pulse = sensor.pulse_sigma_s() / sensor.time_resolution_s();
  double mu = range / 2.0;
  double w = 1.0 / 64.0;
  for (const Detection& detection : detections) {
    const auto stage = static_cast<double>(online_em_stage(detection.acquisition, sensor.acquisitions));
    const double sigma = 0.25 * range * std::pow(pulse / (0.25 * range), stage / 6.0);
    const double gain = std::exp2(-(stage < 6.0 ? 4.0 + std::floor(stage / 2.0) : 7.0));
    const double z = (detection.timestamp - mu) / sigma;
    const double g = std::abs(z) < 4.0
                         ? range / (sigma * std::sqrt(2.0 * std::numbers::pi)) * std::exp(-0.5 * z * z)
                         : 0.0;
    const double r = w * g / (w * g + 1.0 - w);
    mu += gain * r * (detection.timestamp - mu) / w;
    w = std::max(1.0 / 64.0, w + gain * (r - w));
  }
  return {mu, w};
}

TEST(OnlineEm, FollowsTheRecursion) {
  SensorModel sensor;
  sensor.acquisitions = 6000;
  const std::unique_ptr<Rival> em = make_online_em(sensor);
  for (const double centre : {150.0, 400.0, 800.0}) {
    std::vector<Detection> pixel = noise_free_pulse(sensor, centre, 2500.0, 2);
    ASSERT_LE(pixel.size(), 6000U);
    const RivalWords words = read_one_frame(*em, pixel);
    const auto [mu, w] = reference(sensor, pixel);
    EXPECT_NEAR(words[0] / 64.0, mu, 4.0) << centre;
    EXPECT_NEAR(words[1] / 65536.0, w, 0.06) << centre;
    EXPECT_NEAR(em->decode(words).position, centre, 4.0) << centre;
    EXPECT_GT(em->decode(words).confidence, 0.0);
  }
}

// A pulse that is gone leaves the least weight, so that the next one is still looked for.
TEST(OnlineEm, TheWeightNeverFallsBelowTheLeast) {
  const std::unique_ptr<Rival> em = make_online_em(SensorModel());
  std::vector<int> timestamps(2500, 100);
  timestamps.resize(3333, 900);
  EXPECT_EQ(read_one_frame(*em, one_each(timestamps))[1], 1024);
}

TEST(OnlineEm, StaysInItsWords) {
  SensorModel sensor;
  const std::unique_ptr<Rival> em = make_online_em(sensor);
  for (const int timestamp : {0, 1022}) {
    const RivalWords words = read_one_frame(*em, one_each(std::vector<int>(3333, timestamp)));
    EXPECT_GE(words[0], 0);
    EXPECT_LT(words[0], 1024 * 64);
    EXPECT_LE(words[1], 65535);
    EXPECT_NEAR(words[0] / 64.0, timestamp, 2.0);
  }
}

}  // namespace
}  // namespace dtof
