// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/models/intensity_image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace dtof {
namespace {

using testing::DoubleEq;
using testing::Each;
using testing::ElementsAre;

TEST(IntensityImage, HasMeanAndVarianceOfTheBackground) {
  SensorModel sensor;
  const TargetMap targets(100, 80, {2.0, 0.5});
  const IntensityImage image = draw_intensity_image(sensor, targets, 50.0, 3);
  ASSERT_EQ(image.values.size(), 8000U);
  double sum = 0.0;
  double squares = 0.0;
  for (const double value : image.values) {
    sum += value;
    squares += value * value;
  }
  const double expected = static_cast<double>(sensor.acquisitions) * sensor.background_events(50.0, 0.5);
  const double mean = sum / 8000.0;
  const double variance = squares / 8000.0 - mean * mean;
  constexpr double kSigmas = 4.5;
  EXPECT_NEAR(mean, expected, kSigmas * std::sqrt(expected / 8000.0));
  EXPECT_NEAR(variance / expected, 1.0, kSigmas * std::sqrt(2.0 / 8000.0));
}

TEST(IntensityImage, FollowsFromSeedAndPixelAlone) {
  const SensorModel sensor;
  TargetMap targets(5, 4, {2.0, 0.5});
  const IntensityImage image = draw_intensity_image(sensor, targets, 50.0, 3);
  EXPECT_EQ(draw_intensity_image(sensor, targets, 50.0, 3).values, image.values);
  EXPECT_NE(draw_intensity_image(sensor, targets, 50.0, 4).values, image.values);
  targets.at(1, 2) = {3.0, 0.9};  // the depth does not matter, and no other pixel changes
  const IntensityImage changed = draw_intensity_image(sensor, targets, 50.0, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    EXPECT_EQ(changed.values[i] == image.values[i], i != 2 * 5 + 1) << i;
  }
}

TEST(IntensityImage, BrightnessIsFreeOfTheExposure) {
  EXPECT_THAT(brightness({2, 2, {1.0, 1.0, 4.0, 10.0}}),
              ElementsAre(DoubleEq(0.5), DoubleEq(0.5), DoubleEq(1.0), DoubleEq(std::sqrt(2.5))));
  EXPECT_EQ(brightness({2, 1, {3.0, 5.0}}), brightness({2, 1, {300.0, 500.0}}));
  EXPECT_THAT(brightness({2, 1, {0.0, 0.0}}), Each(0.0));
}

}  // namespace
}  // namespace dtof
