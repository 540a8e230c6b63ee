// SPDX-License-Identifier: Apache-2.0
#include "dtof/pipeline/frame_pipeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/pixel_sampler.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

PhotonSource room(int columns = 12, int rows = 10, std::uint32_t acquisitions = 400) {
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = acquisitions;
  SceneParameters parameters;
  parameters.columns = columns;
  parameters.rows = rows;
  return {sensor, make_scene(Scene::kRoom, parameters), 14.0, 1};
}

ReadoutParameters sifh() { return default_parameters(Readout::kSifh, parse_preset("thesis")); }

TEST(FramePipeline, ResultsAreTheModelsAndDistancesThoseOfTheTable) {
  const PhotonSource scene = room();
  const ModelEngine engine({});
  const FramePipeline pipeline(scene, engine, {.region = Region::whole(12, 10)});
  const std::array readouts = {sifh()};
  const auto tabled = pipeline.tables(readouts, TableRule::kFlat);
  ASSERT_TRUE(tabled.front().table);
  const MeasuredFrame frame = pipeline.measure(tabled.front());
  EXPECT_EQ(frame.run.results, run_frame(scene, sifh()));
  for (std::size_t i = 0; i < frame.run.results.size(); ++i) {
    const PixelResult& result = frame.run.results[i];
    if (result.confidence == 0) {
      EXPECT_TRUE(std::isnan(frame.maps.depth[i]));
      continue;
    }
    const double distance = tabled.front().table->distance(result.code);
    EXPECT_EQ(frame.maps.depth[i], std::max(static_cast<float>(distance), 0.0F));
  }
  EXPECT_FALSE(pipeline.tables(readouts, TableRule::kNone).front().table);
}

TEST(FramePipeline, AFrameThatSettlesIsOneWithoutItsFirstAcquisitions) {
  const PhotonSource scene = room();
  const ModelEngine engine({});
  constexpr std::uint32_t kSettle = 150;
  const FramePipeline pipeline(scene, engine, {.region = Region::whole(12, 10), .settle = kSettle});
  const MeasuredFrame frame = pipeline.measure({sifh(), std::nullopt});
  std::size_t i = 0;
  std::vector<std::vector<PixelResult>> columns;
  for (int column = 0; column < 12; ++column) {
    columns.push_back(
        make_readout_model(sifh())->run_column(without_first(scene.column(column), kSettle), 250));
  }
  for (std::size_t row = 0; row < 10; ++row) {
    for (std::size_t column = 0; column < 12; ++column) {
      EXPECT_EQ(frame.run.results[i++], columns[column][row]);
    }
  }
  EXPECT_NE(frame.run.results, run_frame(scene, sifh()));
  EXPECT_THROW(FramePipeline(scene, engine, {.region = Region::whole(12, 10), .settle = 400}), InputError);
}

TEST(FramePipeline, ARegionHasItsOwnPixelsAndTruth) {
  const PhotonSource scene = room();
  const ModelEngine engine({});
  const FramePipeline whole(scene, engine, {.region = Region::whole(12, 10)});
  const FramePipeline part(scene, engine, {.region = {.columns = {2, 7}, .rows = {.first = 3, .count = 4}}});
  const TabledReadout readout{sifh(), std::nullopt};
  const MeasuredFrame all = whole.measure(readout);
  const MeasuredFrame some = part.measure(readout);
  ASSERT_EQ(some.run.results.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    const std::size_t pixel = (3 + i / 2) * 12 + (i % 2 == 0 ? 2 : 7);
    EXPECT_EQ(some.run.results[i], all.run.results[pixel]);
    EXPECT_EQ(part.truth().metres[i], whole.truth().metres[pixel]);
  }
}

TEST(FramePipeline, APhotonModelThatCanBeSampledIsSampledUnlessStreamsAreAskedFor) {
  const PhotonSource scene = room();
  const Region part{.columns = {2, 7}, .rows = {.first = 3, .count = 4}};
  const TabledReadout readout{sifh(), std::nullopt};
  const auto measured = [&](bool streams_only, const Region& region) {
    const ModelEngine engine({.streams_only = streams_only});
    const FramePipeline pipeline(scene, engine, {.region = region, .fidelity = Fidelity::kFast});
    return pipeline.measure(readout).run.results;
  };
  const auto fast = make_source(Fidelity::kFast, scene);
  const auto& sampled = dynamic_cast<const SampledSource&>(*fast);
  const std::vector<PixelResult> whole = run_sampled_frame(sampled, sifh());
  EXPECT_EQ(measured(false, Region::whole(12, 10)), whole);
  EXPECT_EQ(measured(true, Region::whole(12, 10)), run_frame(*fast, sifh()));
  const std::vector<PixelResult> some = measured(false, part);
  ASSERT_EQ(some.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(some[i], whole[(3 + i / 2) * 12 + (i % 2 == 0 ? 2 : 7)]);
  }
}

TEST(FramePipeline, PhotonsThatAreNotKeptAreTheSame) {
  const PhotonSource scene = room();
  const ModelEngine engine({});
  const TabledReadout readout{sifh(), std::nullopt};
  const FramePipeline kept(scene, engine, {.region = Region::whole(12, 10), .keep_photons = true});
  const FramePipeline drawn(scene, engine, {.region = Region::whole(12, 10), .keep_photons = false});
  EXPECT_EQ(kept.measure(readout).run.results, drawn.measure(readout).run.results);
}

TEST(FramePipeline, StepByStepIsAtOnce) {
  SensorModel sensor = find_sensor("thesis+column-skew");
  sensor.acquisitions = 400;
  const PhotonSource scene(sensor, make_scene(Scene::kRoom, {.columns = 40, .rows = 6}), 14.0, 1);
  const ModelEngine engine({.observer = [](std::size_t, std::size_t) {}});
  FramePipeline pipeline(scene, engine, {.region = Region::whole(40, 6)});
  for (const Readout name : {Readout::kSifh, Readout::kPoolPointer}) {
    const std::array readouts = {default_parameters(name, sensor)};
    const TabledReadout readout = pipeline.tables(readouts, TableRule::kFlat).front();
    const MeasuredFrame whole = pipeline.measure(readout);
    EXPECT_EQ(pipeline.read(readout.parameters).results, whole.run.results);
    EXPECT_EQ(pipeline.read_by(engine, readout.parameters).results, whole.run.results);
    const auto some = pipeline.read(readout.parameters, {34, 39}).results;
    for (std::size_t row = 0; row < 6; ++row) {
      EXPECT_EQ(some[2 * row], whole.run.results[40 * row + 34]);
      EXPECT_EQ(some[2 * row + 1], whole.run.results[40 * row + 39]);
    }
    pipeline.drop_photons(34);
    EXPECT_EQ(pipeline.read(readout.parameters, {34, 39}).results, some);
    const FrameMaps judged = pipeline.judge(whole.run.results, readout);
    EXPECT_EQ(figure_values(judged.figures, true), figure_values(whole.maps.figures, true));
    const std::vector<double> positions = pipeline.positions(whole.run.results, readout.parameters);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (!std::isnan(whole.maps.depth[i])) {
        EXPECT_EQ(std::max(static_cast<float>(readout.table->distance(positions[i])), 0.0F),
                  whole.maps.depth[i]);
      }
    }
  }
}

TEST(FramePipeline, APrecisionTakesFramesUntilItIsReached) {
  const ModelEngine engine({});
  const FramePipeline pipeline(room(), engine, {.region = Region::whole(12, 10)});
  const TabledReadout readout{sifh(), std::nullopt};
  const MeasuredFrame given_up = pipeline.measure(readout, FramePrecision{1e-6, 5});
  EXPECT_EQ(given_up.frames, 5);
  EXPECT_FALSE(given_up.precision_reached);
  EXPECT_EQ(given_up.maps.figures.errors.count(), 5U * 120U);
  const MeasuredFrame reached = pipeline.measure(readout, FramePrecision{100.0, 50});
  EXPECT_EQ(reached.frames, 4);
  EXPECT_TRUE(reached.precision_reached);
}

TEST(FramePipeline, AnObserverReceivesEveryColumn) {
  std::vector<std::size_t> reported;
  const ModelEngine engine({.observer = [&](std::size_t done, std::size_t total) {
    EXPECT_EQ(total, 12U);
    reported.push_back(done);
  }});
  const FramePipeline pipeline(room(), engine, {.region = Region::whole(12, 10)});
  (void)pipeline.measure({sifh(), std::nullopt});
  ASSERT_EQ(reported.size(), 12U);
  EXPECT_EQ(reported.back(), 12U);
}

TEST(FramePipeline, AFlagStopsAFrame) {
  std::atomic<bool> stop = false;
  const ModelEngine engine(
      {.threads = 2, .observer = [&](std::size_t done, std::size_t) { stop = done > 3; }});
  const FramePipeline pipeline(room(200, 2), engine, {.region = Region::whole(200, 2)});
  const StopScope scope(&stop);
  EXPECT_THROW((void)pipeline.measure({sifh(), std::nullopt}), Interrupted);
}

TEST(FramePipeline, AFrameThatDoesNotFitIntoMemoryIsRefused) {
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = static_cast<std::uint32_t>(kMostAcquisitions);
  EXPECT_NO_THROW(check_frame_memory(sensor, 160));
  EXPECT_THROW(check_frame_memory(sensor, 161), InputError);
}

TEST(FramePipeline, AutoTakesTheFastModelOnlyWhereTheEngineSamples) {
  const PhotonSource scene = room(12, 10, 3333);
  const std::array readouts = {sifh()};
  const ModelEngine samples({});
  const ModelEngine streams({.streams_only = true});
  EXPECT_EQ(frame_fidelity("auto", 0.5, scene, readouts, samples), Fidelity::kFast);
  EXPECT_EQ(frame_fidelity("auto", 0.5, scene, readouts, streams), Fidelity::kExact);
  EXPECT_THROW((void)frame_fidelity("quick", 0.5, scene, readouts, streams), InputError);
}

}  // namespace
}  // namespace dtof
