// SPDX-License-Identifier: Apache-2.0
#include "video/video_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/pipeline/frame_pipeline.hpp"
#include "dtof/readout/pool_pointer.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"
#include "video/prior_engine.hpp"

namespace dtof {
namespace {

SensorModel short_sensor() {
  SensorModel sensor = find_sensor("thesis");
  sensor.acquisitions = 600;
  return sensor;
}

std::vector<ReadoutParameters> readouts(const SensorModel& sensor) {
  return {default_parameters(Readout::kHisPointer, sensor),
          default_parameters(Readout::kPoolPointer, sensor)};
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

TEST(VideoReader, OnlyThePriorRemembersTheLastFrame) {
  const SensorModel sensor = short_sensor();
  const VideoReader reader(sensor, readouts(sensor), 30.0, 1, 2);
  ASSERT_EQ(reader.estimators().size(), 3U);
  EXPECT_EQ(reader.estimators().back(), "poolPointer, prior");
  const auto still = reader.read(sequence(Motion::kStill));
  const auto cut = reader.read(sequence(Motion::kCut));
  ASSERT_EQ(still.size(), 4U);
  const auto same = [](const ErrorShares& a, const ErrorShares& b) {
    return a.pixels == b.pixels && a.above_3_percent == b.above_3_percent && a.rmse == b.rmse;
  };
  EXPECT_TRUE(same(still[0][1], still[0][2])) << "there is no frame before the first";
  EXPECT_FALSE(same(still[1][1], still[1][2])) << "the prior changes the second frame";
  for (std::size_t e = 0; e < 3; ++e) {
    EXPECT_EQ(still[0][e].pixels, 36U * 32U);
    EXPECT_TRUE(same(still[1][e], cut[1][e])) << "until the cut both videos are one";
    EXPECT_FALSE(same(still[0][e], still[1][e])) << "each frame has photons of its own";
  }
}

TEST(VideoReader, EachFrameIsTheModelsOwn) {
  const SensorModel sensor = short_sensor();
  const std::vector<ReadoutParameters> both = readouts(sensor);
  const VideoReader reader(sensor, both, 30.0, 1, 2);
  const Sequence video = sequence(Motion::kStill);
  const auto shares = reader.read(video);
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

TEST(VideoReader, ReadOutsThatUseOtherColumnsReadWholeEngines) {
  const SensorModel sensor = short_sensor();
  const std::vector<ReadoutParameters> all = {default_parameters(Readout::kPoolPointer, sensor),
                                              default_parameters(Readout::kPoolPointerLean, sensor)};
  Sequence video = sequence(Motion::kStill);
  video.frames = 2;
  video.parameters.columns = 60;  // engines of 34 and 26 columns, lean: of 50 and 10
  const VideoReader together(sensor, all, 30.0, 1, 2);
  const VideoReader alone(sensor, std::span(all).last(1), 30.0, 1, 1);
  std::vector<std::vector<double>> seen;
  const auto keep = [&](int /*frame*/, const VideoFrame& frame) { seen.push_back(frame.distance_m[1]); };
  const auto shares = together.read(video, nullptr, keep);
  EXPECT_FALSE(alone.without_prior().has_value()) << "lean has no prior";
  EXPECT_EQ(shares[1][1].rmse, alone.read(video)[1][0].rmse);
  // Another way to lean's distances: the frame's model, with the look-up table left out.
  const SequenceFrame second = sequence_frame(video, 1);
  const PhotonSource source(sensor, second.targets, second.klux, 1, scene_frame(1));
  const DepthScale scale(sensor.integration_time_s, sensor.np, sensor.pulse_fwhm_s);
  const std::vector<PixelResult> results = run_frame(source, all[1], 1);
  ASSERT_EQ(results.size(), seen[1].size());
  double far_off = 0.0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    // A table gives no negative distance.
    const double depth =
        std::max(scale.depth(to_measurement(results[i], all[1].fraction_bits).position), 0.0);
    far_off += std::abs(depth - seen[1][i]) > 0.2 ? 1.0 : 0.0;
  }
  EXPECT_EQ(far_off, 0.0);
}

/// Bit for bit, whatever surrounds the sensor: skew is taken away, and the table is that of a host that
/// calibrates without fog.
TEST(VideoReader, AFrameIsThatOfDtofFrame) {
  for (const char* const name : {"thesis", "thesis+column-skew+fog"}) {
    SCOPED_TRACE(name);
    SensorModel sensor = find_sensor(name);
    sensor.acquisitions = 300;
    const std::vector<ReadoutParameters> both = readouts(sensor);
    Sequence video = sequence(Motion::kStill);
    video.frames = 2;
    std::vector<std::vector<std::vector<double>>> seen;
    const VideoReader reader(sensor, both, 30.0, 7, 2);
    (void)reader.read(video, nullptr,
                      [&](int /*frame*/, const VideoFrame& frame) { seen.push_back(frame.distance_m); });
    for (int number = 0; number < 2; ++number) {
      const SequenceFrame frame = sequence_frame(video, number);
      const PhotonSource scene(sensor, frame.targets, frame.klux, 7,
                               scene_frame(static_cast<std::uint32_t>(number)));
      const ModelEngine engine({.own_rows = true, .observer = [](std::size_t, std::size_t) {}});
      const FramePipeline pipeline(scene, engine, {.region = Region::whole(36, 32), .seed = 7});
      const std::vector<TabledReadout> tabled = pipeline.tables(both, TableRule::kFlat);
      for (std::size_t r = 0; r < both.size(); ++r) {
        const std::vector<float> depth = pipeline.measure(tabled[r]).maps.depth;
        const std::vector<double>& distances = seen[static_cast<std::size_t>(number)][r];
        for (std::size_t i = 0; i < depth.size(); ++i) {
          if (!std::isnan(depth[i])) {
            ASSERT_EQ(depth[i], std::max(static_cast<float>(distances[i]), 0.0F)) << r << ", pixel " << i;
          }
        }
      }
    }
  }
}

TEST(PriorEngine, EachEngineBeginsFromItsOwnLastFrame) {
  const SensorModel sensor = short_sensor();
  const ReadoutParameters pool = default_parameters(Readout::kPoolPointer, sensor);
  constexpr int kColumns = 40;  // two engines
  constexpr int kRows = 24;
  std::vector<PoolPrior> priors;
  std::vector<PoolPrior> expected_priors;
  const PriorEngine engine(priors, 2);
  for (std::uint32_t number = 0; number < 3; ++number) {
    const PhotonSource source(sensor, make_scene(Scene::kRoom, {.columns = kColumns, .rows = kRows}), 30.0, 1,
                              scene_frame(number));
    ColumnStream stream;
    const auto column = [&](int index) -> const ColumnStream& { return stream = source.column(index); };
    const auto expected = run_pool_pointer(kColumns, column, sensor.np, sensor.acquisitions,
                                           pool_pointer_parameters(pool), &expected_priors);
    const auto results = engine.read(source, pool, Region::whole(kColumns, kRows)).results;
    for (int i = 0; i < kColumns * kRows; ++i) {
      ASSERT_EQ(results[static_cast<std::size_t>(i)],
                expected[static_cast<std::size_t>(i % kColumns)][static_cast<std::size_t>(i / kColumns)])
          << "frame " << number;
    }
    EXPECT_EQ(priors, expected_priors);
  }
}

TEST(PriorEngine, HasTheTimeGate) {
  const SensorModel sensor = short_sensor();
  ReadoutParameters pool = default_parameters(Readout::kPoolPointer, sensor);
  const PhotonSource source(sensor, make_scene(Scene::kRoom, {.columns = 6, .rows = 8}), 30.0, 1);
  const auto read = [&] {
    std::vector<PoolPrior> priors;
    return PriorEngine(priors, 1).read(source, pool, Region::whole(6, 8)).results;
  };
  const std::vector<PixelResult> without = read();
  pool.time_gate = CodeGate{100, 300};
  const std::vector<PixelResult> gated = read();
  EXPECT_NE(gated, without);
  ColumnStream kept;
  const auto column = [&](int index) -> const ColumnStream& {
    kept.clear();
    const ColumnStream all = source.column(index);
    for (int row = 0; row < all.rows(); ++row) {
      for (const Detection& detection : all.row(row)) {
        if (pool.time_gate->contains(detection.timestamp)) {
          kept.append(detection);
        }
      }
      kept.finish_row();
    }
    return kept;
  };
  std::vector<PoolPrior> priors;
  const auto expected =
      run_pool_pointer(6, column, sensor.np, sensor.acquisitions, pool_pointer_parameters(pool), &priors);
  for (std::size_t i = 0; i < gated.size(); ++i) {
    EXPECT_EQ(gated[i], expected[i % 6][i / 6]);
  }
}

TEST(PriorEngine, RefusesWhatLeavesNothingForTheNextFrame) {
  const SensorModel sensor = short_sensor();
  std::vector<PoolPrior> priors;
  const PriorEngine engine(priors, 1);
  const PhotonSource source(sensor, make_scene(Scene::kRoom, {.columns = 6, .rows = 4}), 30.0, 1);
  const ReadoutParameters pool = default_parameters(Readout::kPoolPointer, sensor);
  EXPECT_THROW((void)engine.read(source, default_parameters(Readout::kSifh, sensor), Region::whole(6, 4)),
               InputError);
  EXPECT_THROW((void)engine.read(source, pool, Region::whole(5, 4)), InputError);
  EXPECT_THROW((void)engine.read(source, pool, Region::whole(6, 3)), InputError);
}

TEST(VideoReader, ShowsEachFrameOnce) {
  const SensorModel sensor = short_sensor();
  const std::vector<ReadoutParameters> one = {default_parameters(Readout::kHisPointer, sensor)};
  const VideoReader reader(sensor, one, 30.0, 1, 2);
  std::vector<int> frames;
  const auto shares = reader.read(sequence(Motion::kPan), nullptr, [&](int frame, const VideoFrame& seen) {
    frames.push_back(frame);
    EXPECT_EQ(seen.distance_m.size(), 1U);
    EXPECT_EQ(seen.distance_m[0].size(), 36U * 32U);
  });
  EXPECT_EQ(frames, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(shares.size(), 4U);
  EXPECT_EQ(reader.estimators().size(), 1U);
}

}  // namespace
}  // namespace dtof
