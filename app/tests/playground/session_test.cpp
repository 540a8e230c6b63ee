// SPDX-License-Identifier: Apache-2.0
#include "playground/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dtof/core/error.hpp"
#include "dtof/frame/array_rows.hpp"
#include "dtof/pipeline/frame_pipeline.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::Throws;
using testing::ThrowsMessage;

PlaygroundRequest small_plane() {
  PlaygroundRequest request;
  request.scene = "plane";
  request.columns = 6;
  request.rows = 8;
  request.acquisitions = 800;
  request.seed = 3;
  request.readouts = {"poolpointer", "sifh"};
  return request;
}

/// Column by column gives what whole frames do, for pool read-outs in an array of more rows than the sensor.
TEST(PlaygroundSession, ReadsWhatAFrameReads) {
  const PlaygroundRequest request = small_plane();
  PlaygroundSession session(request);
  session.calibrate();
  for (int column = 0; column < session.columns(); ++column) {
    session.read_column(column);
  }
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 800;
  const PhotonSource scene(sensor, make_scene(Scene::kPlane, {.columns = 6, .rows = 8}), 14.0, 3);
  for (std::size_t r = 0; r < request.readouts.size(); ++r) {
    SCOPED_TRACE(request.readouts[r]);
    const Readout readout = parse_readout(request.readouts[r]);
    const ArrayRows array = array_rows(scene, {.first = 0, .count = 8}, readout);
    const PlaygroundFrame frame = session.frame(r);
    EXPECT_EQ(frame.results, array.read(run_frame(*array.source, default_parameters(readout, sensor))));
    ASSERT_EQ(frame.error_m.size(), 48U);
    // A pixel below the threshold of confidence has no depth.
    const auto pixel = static_cast<std::size_t>(
        std::ranges::find_if(frame.depth_m, [](float depth) { return !std::isnan(depth); }) -
        frame.depth_m.begin());
    ASSERT_LT(pixel, frame.depth_m.size());
    EXPECT_FLOAT_EQ(frame.depth_m[pixel] - frame.error_m[pixel], session.truth_m()[pixel]);
    EXPECT_FLOAT_EQ(session.truth_m()[5], 5.0F);
    EXPECT_EQ(frame.figures.size(), 6U);
  }
}

/// The frame of `dtof frame`, figures and distances included, also where columns are more than an engine's.
TEST(PlaygroundSession, ShowsTheFrameOfThePipeline) {
  PlaygroundRequest request = small_plane();
  request.columns = 37;
  request.readouts = {"poolpointer", "sifh", "poolpointer-lean"};
  PlaygroundSession session(request);
  session.calibrate();
  for (int column = 0; column < session.columns(); ++column) {
    session.read_column(column);
  }
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 800;
  const PhotonSource scene(sensor, make_scene(Scene::kPlane, {.columns = 37, .rows = 8}), 14.0, 3);
  const ModelEngine engine({.observer = [](std::size_t, std::size_t) {}});
  const FramePipeline pipeline(scene, engine, {.region = Region::whole(37, 8), .seed = 3});
  std::vector<ReadoutParameters> readouts;
  for (const std::string& name : request.readouts) {
    readouts.push_back(default_parameters(parse_readout(name), sensor));
  }
  const std::vector<TabledReadout> tabled = pipeline.tables(readouts, TableRule::kFlat);
  const auto same = [](const std::vector<float>& a, const std::vector<float>& b) {
    return std::ranges::equal(a, b, [](float x, float y) { return x == y || (x != x && y != y); });
  };
  for (std::size_t r = 0; r < readouts.size(); ++r) {
    SCOPED_TRACE(request.readouts[r]);
    const MeasuredFrame expected = pipeline.measure(tabled[r]);
    const PlaygroundFrame frame = session.frame(r);
    EXPECT_EQ(frame.results, expected.run.results);
    EXPECT_TRUE(same(frame.depth_m, expected.maps.depth));
    EXPECT_TRUE(same(frame.error_m, expected.maps.error));
    EXPECT_EQ(frame.figures, figure_values(expected.maps.figures, true));
  }
  EXPECT_TRUE(same(session.truth_m(), pipeline.truth().metres));
}

/// The frame of a session's only read-out.
PlaygroundFrame frame_of(const PlaygroundRequest& request, const PlaygroundFiles& files) {
  PlaygroundSession session(request, files);
  session.calibrate();
  for (int column = 0; column < session.columns(); ++column) {
    session.read_column(column);
  }
  return session.frame(0);
}

PlaygroundRequest small_sifh() {
  PlaygroundRequest request = small_plane();
  request.readouts = {"sifh"};
  return request;
}

TEST(PlaygroundSession, ASensorFileStandsForAPreset) {
  const PlaygroundFiles file{.sensor_name = "mine.toml", .sensor_text = std::string(preset_text("phone"))};
  PlaygroundRequest request = small_sifh();
  const PlaygroundFrame other = frame_of(request, {});
  const PlaygroundFrame with_file = frame_of(request, file);
  request.sensor = "phone";
  EXPECT_EQ(with_file.results, frame_of(request, {}).results);
  EXPECT_NE(with_file.results, other.results);
}

TEST(PlaygroundSession, ADepthMapStandsForAScene) {
  PlaygroundFiles files{.map_columns = 3, .map_rows = 2, .map_m = {1.0F, 2.0F, 3.0F, 0.0F, 1.5F, 2.5F}};
  const PlaygroundRequest request = small_sifh();
  const PlaygroundSession session(request, files);
  ASSERT_EQ(session.truth_m().size(), 48U);
  EXPECT_EQ(session.truth_m()[0], 1.0F);
  EXPECT_EQ(session.truth_m()[5], 3.0F);
  EXPECT_TRUE(std::isnan(session.truth_m()[24]));
  EXPECT_EQ(session.truth_m()[47], 2.5F);
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 800;
  const PhotonSource scene(
      sensor, scene_from_depth_image(3, 2, files.map_m, 6, 8, sensor.default_reflectivity), 14.0, 3);
  const ReadoutParameters readout = default_parameters(parse_readout("sifh"), sensor);
  EXPECT_EQ(frame_of(request, files).results, run_frame(scene, readout));
}

/// The photons of a pixel are those that the read-outs had.
TEST(PlaygroundSession, APixelIsARowOfItsColumn) {
  const PlaygroundSession session(small_plane());
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 800;
  const PhotonSource scene(sensor, make_scene(Scene::kPlane, {.columns = 6, .rows = 8}), 14.0, 3);
  const ColumnStream column = scene.column(4);
  const auto row = column.row(7);
  EXPECT_FALSE(row.empty());
  EXPECT_EQ(session.pixel(4, 7), std::vector<Detection>(row.begin(), row.end()));
  EXPECT_EQ(session.acquisitions(), 800U);
  EXPECT_EQ(session.codes(), 1024);
  EXPECT_THAT([&] { static_cast<void>(session.pixel(6, 0)); },
              ThrowsMessage<InputError>(HasSubstr("no pixel in column 6")));
}

TEST(PlaygroundSession, RefusesFilesThatCannotBe) {
  const auto with = [](const PlaygroundFiles& files) {
    return [files] { PlaygroundSession(small_plane(), files); };
  };
  EXPECT_THAT(with({.sensor_name = "mine.toml", .sensor_text = "[laser]\npulse = 3\n"}),
              ThrowsMessage<InputError>(HasSubstr("mine.toml")));
  EXPECT_THAT(with({.map_columns = 2, .map_rows = 1, .map_m = {1.0F, -1.0F}}), Throws<InputError>());
  const PlaygroundFiles dark{.map_name = "a.npy", .map_columns = 2, .map_rows = 1, .map_m = {0.0F, 0.0F}};
  EXPECT_THAT(with(dark), ThrowsMessage<InputError>("a.npy: no pixel has a distance"));
  const PlaygroundFiles far{.map_name = "a.npy", .map_columns = 2, .map_rows = 1, .map_m = {0.0F, 20.0F}};
  EXPECT_THAT(with(far), ThrowsMessage<InputError>(
                             HasSubstr("a.npy: every pixel is beyond the sensor's range, 6.75 m")));
}

TEST(PlaygroundSession, RefusesWhatCannotBe) {
  const auto with = [](auto change) {
    PlaygroundRequest request = small_plane();
    change(request);
    return [request] { PlaygroundSession{request}; };
  };
  EXPECT_THAT(with([](PlaygroundRequest& r) { r.far_m = 7.0; }),
              ThrowsMessage<InputError>(HasSubstr("beyond the sensor's range, 6.75 m")));
  EXPECT_THAT(with([](PlaygroundRequest& r) { r.readouts = {"sihf"}; }),
              ThrowsMessage<InputError>(HasSubstr("sihf")));
  EXPECT_THAT(with([](PlaygroundRequest& r) { r.scene = "roof"; }),
              ThrowsMessage<InputError>(HasSubstr("roof")));
}

}  // namespace
}  // namespace dtof
