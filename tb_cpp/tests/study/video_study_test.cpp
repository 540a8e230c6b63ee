// SPDX-License-Identifier: Apache-2.0
#include "study/video_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/error.hpp"
#include "photon/photon_source.hpp"
#include "readout/run_frame.hpp"
#include "sensor/default_parameters.hpp"
#include "sensor/preset.hpp"

namespace dtof {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

SensorModel short_sensor() {
  SensorModel sensor = find_sensor("thesis");
  sensor.acquisitions = 600;
  return sensor;
}

std::vector<ReadoutParameters> readouts(const SensorModel& sensor) {
  return {default_parameters(Readout::kHisPointer, sensor),
          default_parameters(Readout::kPoolPointer2, sensor)};
}

Sequence sequence(Motion motion) {
  Sequence made;
  made.motion = motion;
  made.frames = 4;
  made.klux = 30.0;
  made.parameters.columns = 36;
  made.parameters.rows = 32;
  return made;
}

TEST(VideoStudy, OnlyThePriorRemembersTheLastFrame) {
  const SensorModel sensor = short_sensor();
  const VideoStudy study(sensor, readouts(sensor), 30.0, 1, 2);
  ASSERT_EQ(study.estimators().size(), 3U);
  EXPECT_EQ(study.estimators().back(), VideoStudy::kWithPrior);
  const auto still = study.measure(sequence(Motion::kStill));
  const auto cut = study.measure(sequence(Motion::kCut));
  ASSERT_EQ(still.size(), 4U);
  const auto same = [](const ErrorShares& a, const ErrorShares& b) {
    return a.pixels == b.pixels && a.above_3_percent == b.above_3_percent && a.rmse == b.rmse;
  };
  EXPECT_TRUE(same(still[0][1], still[0][2])) << "there is no frame before the first";
  EXPECT_FALSE(same(still[1][1], still[1][2])) << "the prior is heard in the second";
  for (std::size_t e = 0; e < 3; ++e) {
    EXPECT_EQ(still[0][e].pixels, 36U * 32U);
    EXPECT_TRUE(same(still[1][e], cut[1][e])) << "until the cut both videos are one";
    EXPECT_FALSE(same(still[0][e], still[1][e])) << "each frame has photons of its own";
  }
}

TEST(VideoStudy, EachFrameIsTheModelsOwn) {
  const SensorModel sensor = short_sensor();
  const std::vector<ReadoutParameters> both = readouts(sensor);
  const VideoStudy study(sensor, both, 30.0, 1, 2);
  const Sequence video = sequence(Motion::kStill);
  const auto shares = study.measure(video);
  // Another way to the third frame's share, without the study's table: both read-outs are far above 3 % here.
  const SequenceFrame third = sequence_frame(video, 2);
  const PhotonSource source(sensor, third.targets, third.klux, 1, scene_frame(2));
  const DepthScale scale(sensor.integration_time_s, sensor.np, sensor.pulse_fwhm_s);
  for (std::size_t r = 0; r < both.size(); ++r) {
    const std::vector<PixelResult> results = run_frame(source, both[r], 1);
    double outliers = 0.0;
    for (std::size_t i = 0; i < results.size(); ++i) {
      const double truth = third.targets.at(static_cast<int>(i % 36), static_cast<int>(i / 36)).depth_m;
      const double depth = scale.depth(to_measurement(results[i], both[r].fraction_bits).position);
      outliers += std::abs(depth - truth) > 0.1 * truth ? 1.0 : 0.0;
    }
    EXPECT_NEAR(shares[2][r].above_10_percent, outliers / static_cast<double>(results.size()), 0.02);
  }
}

TEST(VideoStudy, FramesArePooledByTheirPixels) {
  const std::array<ErrorShares, 2> frames = {
      {{.pixels = 100, .above_3_percent = 0.5, .above_10_percent = 0.1, .rmse = 0.3},
       {.pixels = 300, .above_3_percent = 0.1, .above_10_percent = 0.0, .rmse = 0.1}}};
  const ErrorShares both = pooled(frames);
  EXPECT_EQ(both.pixels, 400U);
  EXPECT_DOUBLE_EQ(both.above_3_percent, 0.2);
  EXPECT_DOUBLE_EQ(both.above_10_percent, 0.025);
  EXPECT_DOUBLE_EQ(both.rmse, std::sqrt((100 * 0.09 + 300 * 0.01) / 400.0));
  EXPECT_EQ(pooled({}).pixels, 0U);
}

TEST(VideoStudy, NeedsTheReadOutWithAPrior) {
  const SensorModel sensor = short_sensor();
  const std::vector<ReadoutParameters> both = readouts(sensor);
  EXPECT_THAT([&] { VideoStudy(sensor, std::span(both).first(1), 14.0, 1, 1); },
              ThrowsMessage<InputError>(HasSubstr("poolPointer 2 must be among the read-outs")));
}

}  // namespace
}  // namespace dtof
