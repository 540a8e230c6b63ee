// SPDX-License-Identifier: Apache-2.0
// poolPointer's array and model on photons of a scene: ten columns, and a frame of several engines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/preset.hpp"
#include "rtl/run_frame.hpp"
#include "scoreboard/scoreboard.hpp"
#include "tests/rtl/pool_surfaces.hpp"
#include "tests/rtl/pool_video.hpp"
#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

// Photons of the thesis's sensor.
class TenColumnsOfTheRoom : public testing::Test {
 protected:
  static constexpr std::uint32_t kAcquisitions = 700;

  /// Configurations of ten columns with the whole array's rows.
  static std::vector<RtlConfiguration> ten_columns(Readout readout, bool prior) {
    return configurations_with([&](const RtlConfiguration& configuration) {
      return configuration.parameters.readout == readout && configuration.parameters.pool.prior == prior &&
             configuration.pixels_per_sram == 160 && configuration.sram_num == 10;
    });
  }

  /// Ten columns of the room.
  static std::vector<ColumnStream> room(const ReadoutParameters& parameters, double klux, int first,
                                        std::uint64_t seed) {
    SensorModel sensor = parse_preset("thesis");
    sensor.np = parameters.np;
    sensor.slots = parameters.slots;
    sensor.acquisitions = kAcquisitions;
    SceneParameters scene;
    scene.reflectivity = sensor.default_reflectivity;
    const PhotonSource source(sensor, make_scene(Scene::kRoom, scene), klux, seed);
    std::vector<ColumnStream> columns(10);
    for (int column = 0; column < 10; ++column) {
      columns[static_cast<std::size_t>(column)] = source.column(first + column);
    }
    return columns;
  }
};

class PoolPointerPhotons : public TenColumnsOfTheRoom, public testing::WithParamInterface<Readout> {};

INSTANTIATE_TEST_SUITE_P(Both, PoolPointerPhotons,
                         testing::Values(Readout::kPoolPointer, Readout::kPoolPointerLean));

TEST_P(PoolPointerPhotons, AgreeWithModel) {
  SCOPED_TRACE(test_seed_message());
  const std::vector<RtlConfiguration> found = ten_columns(GetParam(), false);
  ASSERT_EQ(found.size(), 1U);
  for (const double klux : {2.0, 14.0, 100.0}) {
    SCOPED_TRACE(testing::Message() << klux << " klux");
    RtlReadout rtl(found.front());
    ASSERT_TRUE(agrees_with_model(rtl, room(found.front().parameters, klux, 95, test_seed()), kAcquisitions,
                                  default_options(test_seed())));
  }
}

TEST_F(TenColumnsOfTheRoom, AgreeWithModelInAVideo) {
  SCOPED_TRACE(test_seed_message());
  const std::vector<RtlConfiguration> found = ten_columns(Readout::kPoolPointer, true);
  ASSERT_EQ(found.size(), 1U);
  PoolVideo video(found.front());
  RtlRunOptions options = default_options(test_seed());
  options.prior = true;
  for (std::uint32_t frame = 0; frame < 3; ++frame) {
    SCOPED_TRACE(testing::Message() << "frame " << frame);
    const int first = 95 + 2 * static_cast<int>(frame);
    ASSERT_TRUE(video.agrees(room(found.front().parameters, 50.0, first, test_seed() + frame), kAcquisitions,
                             options));
    options.reset_first = false;
  }
  EXPECT_EQ(video.changed(), 2);
}

// A frame by engines: two of four columns and a last one of two, each an array of its own.
class PoolPointerFrame : public testing::Test {
 protected:
  static constexpr int kColumns = 10;
  static constexpr int kRows = 16;

  PoolPointerFrame() {
    const std::vector<RtlConfiguration> found =
        configurations_with([](const RtlConfiguration& configuration) {
          return configuration.pixels_per_sram == kRows && configuration.sram_num == 4 &&
                 !configuration.parameters.pool.prior;
        });
    parameters_ = found.at(0).parameters;
    SensorModel sensor = parse_preset("thesis");
    sensor.np = parameters_.np;
    sensor.slots = parameters_.slots;
    sensor.acquisitions = 300;
    SceneParameters scene;
    scene.columns = kColumns;
    scene.rows = kRows;
    scene.reflectivity = sensor.default_reflectivity;
    source_ = std::make_unique<PhotonSource>(sensor, make_scene(Scene::kRoom, scene), 14.0, test_seed());
  }

  ReadoutParameters parameters_;
  std::unique_ptr<PhotonSource> source_;
};

TEST_F(PoolPointerFrame, AgreesWithTheModelInAnyColumns) {
  SCOPED_TRACE(test_seed_message());
  EXPECT_EQ(run_frame_rtl(*source_, parameters_, 2).results, run_frame(*source_, parameters_));
  const std::vector<int> some = {9, 2, 7};
  Progress progress("columns", some.size());
  const RtlSourceFrame part = run_frame_rtl(*source_, parameters_, 1, some, {}, &progress);
  EXPECT_EQ(part.results, run_frame(*source_, parameters_, 1, some));
  EXPECT_GT(part.statistics.cycles, 300U * kRows * 2U);
  EXPECT_GT(part.result_cycles.back(), 0U);
}

TEST_F(PoolPointerFrame, RefusesEnginesThatAreNotCompiled) {
  using ::testing::AllOf;
  using ::testing::HasSubstr;
  using ::testing::ThrowsMessage;
  const auto read = [&](int columns) {
    return [&, columns] { (void)find_rtl_configurations(parameters_, kRows, columns, std::vector<int>{8}); };
  };
  read(10)();
  EXPECT_THAT(read(9), ThrowsMessage<InputError>(AllOf(HasSubstr("an engine of just 1 columns"),
                                                       HasSubstr("compiled are: poolpointer"))));
}

TEST_F(PoolPointerFrame, AWaveformHoldsOneEngine) {
  using ::testing::HasSubstr;
  using ::testing::ThrowsMessage;
  const auto arrays = [&](const std::vector<int>& columns) {
    return find_rtl_configurations(parameters_, kRows, kColumns, columns, true);
  };
  EXPECT_EQ(arrays({4, 7}).size(), 1U);
  EXPECT_THAT(
      [&] {
        (void)arrays({3, 4});
      },
      ThrowsMessage<InputError>(
          HasSubstr("a waveform holds at most SRAM_NUM = 4 columns, those of one engine, not 2")));
}

TEST_F(PoolPointerFrame, AMismatchNamesItsEngine) {
  using ::testing::HasSubstr;
  const std::vector<int> columns = {1, 4, 5, 7, 8};
  RtlSourceFrame frame = run_frame_rtl(*source_, parameters_, 2, columns);
  const SourceFrameContext context = {
      .threads = 1, .first_row = 0, .seed = 1, .command = "dtof frame --engine rtl"};
  EXPECT_EQ(check_source_frame(*source_, parameters_, columns, frame, context), "");
  frame.results[2].code ^= 1;
  EXPECT_THAT(check_source_frame(*source_, parameters_, columns, frame, context),
              HasSubstr("dtof-wave-pool frame --engine rtl --readout poolpointer --columns 4,5,7 --trace"));
}

}  // namespace
}  // namespace dtof
