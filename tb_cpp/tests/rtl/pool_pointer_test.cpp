// SPDX-License-Identifier: Apache-2.0
// poolPointer's RTL against its model where the pixels of a column belong together: surfaces, light, phases,
// schedules. What every read-out must stand is in every_configuration_test and disturbance_test.
#include "readout/pool_pointer.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <string_view>

#include "photon/photon_source.hpp"
#include "photon/sensor_model.hpp"
#include "scene/scene.hpp"
#include "sensor/preset.hpp"
#include "tests/rtl/pool_surfaces.hpp"
#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

class EveryPoolPointer : public testing::TestWithParam<RtlConfiguration> {
 protected:
  // Acquisitions so many that no phase is empty and every gear of the smallest array turns.
  static std::uint32_t frame_length() { return GetParam().pixels_per_sram > 100 ? 70 : 260; }
};

INSTANTIATE_TEST_SUITE_P(Compiled, EveryPoolPointer, testing::ValuesIn(compiled_rtl_configurations()),
                         configuration_test_name);

class PoolPointerWithDarkGroups : public EveryPoolPointer {};

INSTANTIATE_TEST_SUITE_P(Compiled, PoolPointerWithDarkGroups,
                         testing::ValuesIn(configurations_with([](const RtlConfiguration& configuration) {
                           return configuration.parameters.pool.bright_from > 0;
                         })),
                         configuration_test_name);

class SmallPoolPointer : public EveryPoolPointer {};

INSTANTIATE_TEST_SUITE_P(Compiled, SmallPoolPointer,
                         testing::ValuesIn(configurations_with([](const RtlConfiguration& configuration) {
                           return configuration.pixels_per_sram <= 40;
                         })),
                         configuration_test_name);

// First what fails first while the RTL is being written: each step of a frame with as little as possible
// before it. Without detections the candidates are the lowest pairs, without tracks the chain keeps the first
// two.

TEST_P(EveryPoolPointer, EndsAFrameWithoutDetections) {
  RtlReadout rtl(GetParam());
  for (const std::uint32_t acquisitions : {0U, 1U, 40U}) {
    SCOPED_TRACE(testing::Message() << acquisitions << " acquisitions");
    RtlFrame frame;
    ColumnStream dark;
    for (int row = 0; row < GetParam().pixels_per_sram; ++row) {
      dark.finish_row();
    }
    const std::vector<ColumnStream> columns(static_cast<std::size_t>(GetParam().sram_num), dark);
    ASSERT_TRUE(agrees_with_model(rtl, columns, acquisitions, default_options(1), &frame));
    // Candidate 0 is the border of the first two coarse bins; half a bin of the code lies below it.
    const int position = 2048 - (1 << (16 - GetParam().parameters.np)) / 2;
    EXPECT_EQ(frame.results.at(0).code, position >> (16 - GetParam().parameters.np));
    EXPECT_EQ(frame.results.at(0).confidence, 0);
  }
}

// Detections of one phase only.
class PhaseOnly : public testing::TestWithParam<std::tuple<int, RtlConfiguration>> {};

std::string phase_test_name(const testing::TestParamInfo<PhaseOnly::ParamType>& info) {
  constexpr std::array<std::string_view, 3> kNames = {"PointerPhase", "TrackPhase", "CoarsePhase"};
  return fmt::format("{}_{}", kNames[static_cast<std::size_t>(std::get<0>(info.param))],
                     configuration_test_name({std::get<1>(info.param), 0}));
}

INSTANTIATE_TEST_SUITE_P(Pool, PhaseOnly,
                         testing::Combine(testing::Range(0, 3),
                                          testing::ValuesIn(compiled_rtl_configurations())),
                         phase_test_name);

TEST_P(PhaseOnly, AgreesWithModel) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 30);
  const auto& [phase, configuration] = GetParam();
  constexpr std::uint32_t kAcquisitions = 96;
  const PoolSchedule schedule(kAcquisitions, configuration.parameters.pool);
  const std::array<std::uint32_t, 4> ends = {kAcquisitions, schedule.track_end, schedule.coarse_end, 0};
  RtlReadout rtl(configuration);
  for (const View view : {View::kFlat, View::kSteps, View::kOneCode, View::kNothing}) {
    SCOPED_TRACE(view_name(view));
    std::vector<ColumnStream> columns = surface_columns(configuration, kAcquisitions, view, random);
    for (ColumnStream& column : columns) {
      ColumnStream part;
      for (int row = 0; row < column.rows(); ++row) {
        for (const Detection& detection : column.row(row)) {
          if (detection.acquisition < ends.at(static_cast<std::size_t>(phase)) &&
              detection.acquisition >= ends.at(static_cast<std::size_t>(phase) + 1)) {
            part.append(detection);
          }
        }
        part.finish_row();
      }
      column = part;
    }
    ASSERT_TRUE(agrees_with_model(rtl, columns, kAcquisitions, default_options(test_seed())));
  }
}

// Whole frames.

TEST_P(EveryPoolPointer, AgreesWithModelWhateverItSees) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 31);
  RtlReadout rtl(GetParam());
  RtlRunOptions options = default_options(test_seed());
  for (int round = 0; round < 3; ++round) {
    for (const View view : kViews) {
      const std::uint32_t acquisitions = frame_length() + random() % 16;
      SCOPED_TRACE(testing::Message() << view_name(view) << ", " << acquisitions << " acquisitions");
      ASSERT_TRUE(agrees_with_model(rtl, surface_columns(GetParam(), acquisitions, view, random),
                                    acquisitions, options));
      options.reset_first = false;
    }
  }
}

// Every short frame, and schedules whose ends coincide or leave a phase a single acquisition.
TEST_P(EveryPoolPointer, AgreesWithModelWhateverTheSchedule) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 32);
  RtlRunOptions options = default_options(test_seed());
  const PoolPointerParameters defaults = GetParam().parameters.pool;
  constexpr std::array<std::array<int, 2>, 6> kShares = {
      {{0, 0}, {1, 1}, {62, 1}, {1, 62}, {31, 1}, {1, 31}}};  // the first stands for the default's
  for (const auto& [coarse, track] : kShares) {
    RtlConfiguration configuration = GetParam();
    configuration.parameters.pool.coarse_share = coarse == 0 ? defaults.coarse_share : coarse;
    configuration.parameters.pool.track_share = track == 0 ? defaults.track_share : track;
    RtlReadout rtl(configuration);
    for (const std::uint32_t acquisitions : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 10U, 31U, 63U, 64U, 65U}) {
      const View view = kViews[static_cast<std::size_t>(pick(random, kViews.size()))];
      SCOPED_TRACE(testing::Message() << view_name(view) << ", " << acquisitions << " acquisitions, shares "
                                      << coarse << ", " << track);
      ASSERT_TRUE(agrees_with_model(rtl, surface_columns(configuration, acquisitions, view, random),
                                    acquisitions, options));
      options.reset_first = false;
    }
  }
}

// Exactly as much light as makes a group bright, and one count less in each eighth of the range.
TEST_P(PoolPointerWithDarkGroups, TellsThemFromBrightOnes) {
  const ReadoutParameters& parameters = GetParam().parameters;
  const PoolPointerParameters& pool = parameters.pool;
  const int least = ((pool.bright_from << parameters.count_width) + 4) / 5;  // B = 5 least >> COUNT_WIDTH
  ASSERT_LE(least, 8 * ((1 << parameters.count_width) - 1)) << "no group can be bright";
  const int rows = GetParam().pixels_per_sram;
  const int group = std::min(pool.group_size, rows);
  const int pairs = (group + 1) / 2;  // of rows, each of which counts once per acquisition
  const auto coarse = static_cast<std::uint32_t>((4 * least + pairs - 1) / pairs);
  const std::uint32_t acquisitions = 64 * coarse / static_cast<std::uint32_t>(pool.coarse_share) + 64;
  RtlReadout rtl(GetParam());
  for (const int counts : {least - 1, least}) {
    SCOPED_TRACE(testing::Message() << counts << " counts in eight bins");
    CoarseHistogram histogram{};
    ColumnStream column;
    for (int row = 0; row < rows; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
        const int index = static_cast<int>(acquisition) * pairs + row % group / 2;
        if (index < 4 * counts) {  // the four eighths in turn, and the bins of each
          const int bin = 8 * (index % 4) + index / 4 % 8;
          column.append({acquisition, static_cast<Timestamp>(bin * parameters.code_count() / 32)});
          if (row < group && row % 2 == 0) {
            ++histogram[static_cast<std::size_t>(bin)];
          }
        } else if (acquisition >= coarse) {  // something to score and to follow
          column.append({acquisition, static_cast<Timestamp>(parameters.code_count() / 3)});
        }
      }
      column.finish_row();
    }
    const PoolGroup decoded = decode_group(histogram, histogram, histogram, parameters.count_width, pool);
    EXPECT_EQ(decoded.background, pool.bright_from - (counts < least ? 1 : 0));
    const std::vector<ColumnStream> columns(static_cast<std::size_t>(GetParam().sram_num), column);
    ASSERT_TRUE(agrees_with_model(rtl, columns, acquisitions, default_options(1)));
  }
}

// One code in every slot for so long that the advantage reaches its end, each count of the last quarter
// taking 16 acquisitions.
TEST_P(SmallPoolPointer, AdvantageSaturates) {
  const ReadoutParameters& parameters = GetParam().parameters;
  const std::uint32_t acquisitions = 20U << static_cast<unsigned>(parameters.pool.count_bits);
  RtlReadout rtl(GetParam());
  for (const int code : {0, 1, parameters.code_count() / 2, parameters.no_detection() - 1}) {
    SCOPED_TRACE(testing::Message() << "code " << code);
    ColumnStream column;
    for (int row = 0; row < GetParam().pixels_per_sram; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
        for (int slot = 0; slot < parameters.slots; ++slot) {
          column.append({acquisition, static_cast<Timestamp>(code)});
        }
      }
      column.finish_row();
    }
    const std::vector<ColumnStream> columns(static_cast<std::size_t>(GetParam().sram_num), column);
    RtlFrame frame;
    ASSERT_TRUE(agrees_with_model(rtl, columns, acquisitions, default_options(1), &frame));
    EXPECT_GE(frame.results.at(0).confidence, (1 << parameters.pool.count_bits) - 1);
    EXPECT_NEAR(frame.results.at(0).code, code, std::max(parameters.code_count() >> 10, 1));
  }
}

// Frames as long as a sensor's in strong light, so that pointers settle and move by the fine gears' dithered
// steps.
TEST_P(SmallPoolPointer, AgreesWithModelInTheFineGears) {
  SCOPED_TRACE(test_seed_message());
  constexpr std::uint32_t kAcquisitions = 3333;
  const ReadoutParameters& parameters = GetParam().parameters;
  CounterRandom random = test_random(test_seed(), 6);
  const int width = parameters.code_count() / 16;  // of a pulse
  std::vector<ColumnStream> columns(static_cast<std::size_t>(std::min(GetParam().sram_num, 2)));
  for (ColumnStream& column : columns) {
    const int begin = pick(random, parameters.code_count() - width);
    for (int row = 0; row < GetParam().pixels_per_sram; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < kAcquisitions; ++acquisition) {
        const int code = pick(random, 10) == 0 ? pick(random, parameters.no_detection())
                                               : begin + (pick(random, width) + pick(random, width)) / 2;
        column.append({acquisition, static_cast<Timestamp>(code)});
      }
      column.finish_row();
    }
  }
  RtlReadout rtl(GetParam());
  RtlFrame frame;
  ASSERT_TRUE(agrees_with_model(rtl, columns, kAcquisitions, default_options(test_seed()), &frame));
  for (const PixelResult& result : frame.results) {
    EXPECT_GE(result.confidence, parameters.pool.count_bits == 7 ? 116 : 15);
  }
}

// The sweep in CMakeLists.txt holds every promised value.
TEST(PoolPointerSweep, EveryValueOccurs) {
  using C = RtlConfiguration;
  using testing::IsSupersetOf;
  const auto values = [](const std::function<int(const C&)>& field) {
    std::set<int> found;
    for (const C& configuration : compiled_rtl_configurations()) {
      found.insert(field(configuration));
    }
    return found;
  };
  const auto partial_group = [](const C& c) { return c.pixels_per_sram % c.parameters.pool.group_size; };
  EXPECT_THAT(values([](const C& c) { return c.parameters.np; }), IsSupersetOf({8, 9, 10, 11, 12, 16}));
  EXPECT_THAT(values([](const C& c) { return c.pixels_per_sram; }), IsSupersetOf({1, 7, 8, 13, 16, 160}));
  EXPECT_THAT(values(partial_group), IsSupersetOf({0, 1, 4, 5}));
  EXPECT_THAT(values([](const C& c) { return c.sram_num; }), IsSupersetOf({1, 3, 10}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.engine_columns; }), IsSupersetOf({2, 4, 26}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.slots; }), IsSupersetOf({2, 3, 4}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.count_width; }), IsSupersetOf({4, 5, 6, 7, 8}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.group_size; }),
              IsSupersetOf({4, 8, 16, 32, 64}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.dark_labels; }),
              IsSupersetOf({3, 4, 5, 6, 7, 8}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.bright_labels; }), IsSupersetOf({2, 3, 4, 5}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.bright_from; }), IsSupersetOf({0, 1, 6}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.offset_bits; }), IsSupersetOf({0, 2, 4, 5}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.count_bits; }), IsSupersetOf({4, 7}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.pointer_shift; }), IsSupersetOf({0, 1, 2, 4}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.rival_moves ? 1 : 0; }), IsSupersetOf({0, 1}));
}

// What the count of clocks at full size rests on: a sink that holds each row back takes the time of more
// engines.
TEST(PoolPointerCycles, ASlowSinkTakesTheTimeOfMoreEngines) {
  const std::vector<RtlConfiguration> sizes = configurations_with([](const RtlConfiguration& configuration) {
    return configuration.parameters.np == 12 && configuration.pixels_per_sram == 20;
  });
  ASSERT_EQ(sizes.size(), 2U);
  const bool first_is_one = sizes[0].sram_num < sizes[1].sram_num;
  RtlReadout one(sizes[first_is_one ? 0 : 1]);
  RtlReadout many(sizes[first_is_one ? 1 : 0]);
  ASSERT_EQ(one.configuration().sram_num, 2);
  ASSERT_EQ(many.configuration().sram_num, 16);  // eight engines
  const std::vector<ColumnStream> dark(1);
  RtlRunOptions options = default_options(1);
  const std::uint64_t cycles = many.run(dark, 3, options).statistics.cycles;
  const std::uint64_t unheld = one.run(dark, 3, options).statistics.cycles;
  options.row_stall = 7;
  const std::uint64_t held = one.run(dark, 3, options).statistics.cycles;
  EXPECT_GT(held, unheld + 40);
  EXPECT_GE(held, cycles);
  EXPECT_LE(held, cycles + 1);  // the sink's last pause
}

TEST(PoolPointerRegistry, LeavesTheScheduleToTheDriver) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kPoolPointer);
  parameters.pool.coarse_share = 7;
  const RtlConfiguration configuration = find_rtl_configuration(parameters, 160, 1);
  EXPECT_EQ(configuration.parameters.pool.coarse_share, 7);
  EXPECT_NO_THROW(RtlReadout{configuration});
}

// Full-size arrays.
class FullSizePoolPointer : public testing::TestWithParam<Readout> {};

INSTANTIATE_TEST_SUITE_P(FullSize, FullSizePoolPointer, testing::ValuesIn(full_size_readouts()),
                         readout_test_name);

// Clocks of a frame of 200 columns. An engine takes its columns one after the other, so that one column and
// ten tell how long those of configurations.toml take; the sink is as slow as the other engines' results.
// What is not streaming does not depend on the frame's length, so that short frames do.
TEST_P(FullSizePoolPointer, StaysBelowTheCycleLimit) {
  constexpr int kRows = 160;
  constexpr int kColumns = 200;
  constexpr std::uint64_t kAcquisitions = 33'333;
  constexpr std::uint64_t kCycleLimit = 11'000'000;
  const int engine_columns = GetParam() == Readout::kPoolPointer ? 34 : 50;
  const int engines = (kColumns + engine_columns - 1) / engine_columns;
  const ReadoutParameters parameters = ReadoutParameters::defaults(GetParam());
  const auto stream = static_cast<std::uint64_t>(kRows) * static_cast<std::uint64_t>(parameters.slots);
  const std::vector<ColumnStream> dark(1);
  RtlRunOptions options = default_options(1);
  options.row_stall = static_cast<std::uint64_t>(engines - 1);
  const auto overhead_of = [&](RtlReadout& rtl, std::uint32_t acquisitions) {
    return rtl.run(dark, acquisitions, options).statistics.cycles - acquisitions * stream;
  };
  RtlReadout one(find_rtl_configuration(parameters, kRows, 1));
  RtlReadout many(find_rtl_configuration(parameters, kRows, kColumns));
  ASSERT_EQ(one.configuration().sram_num, 1);
  ASSERT_EQ(many.configuration().sram_num, many.configuration().parameters.pool.engine_columns)
      << "one engine";
  const std::uint64_t one_column = overhead_of(one, 16);
  EXPECT_EQ(overhead_of(one, 64), one_column);
  const std::uint64_t more_columns = overhead_of(many, 16) - one_column;
  const auto added = static_cast<std::uint64_t>(many.configuration().sram_num - 1);
  ASSERT_EQ(more_columns % added, 0U);
  const std::uint64_t overhead =
      one_column + more_columns / added * static_cast<std::uint64_t>(engine_columns - 1);
  const std::uint64_t cycles = kAcquisitions * stream + overhead;
  fmt::print("{:16} {:.4e} clocks per frame of {} acquisitions, {} of them not streaming, {} engines\n",
             readout_title(GetParam()), static_cast<double>(cycles), kAcquisitions, overhead, engines);
  EXPECT_LE(cycles, kCycleLimit);
}

// Photons of the thesis's sensor.

TEST_P(FullSizePoolPointer, AgreesWithModelOnModelledPhotons) {
  SCOPED_TRACE(test_seed_message());
  const ReadoutParameters parameters = ReadoutParameters::defaults(GetParam());
  for (const double klux : {2.0, 14.0, 100.0}) {
    SCOPED_TRACE(testing::Message() << klux << " klux");
    SensorModel sensor = parse_preset("thesis");
    sensor.np = parameters.np;
    sensor.slots = parameters.slots;
    sensor.acquisitions = 700;
    SceneParameters scene;
    scene.reflectivity = sensor.default_reflectivity;
    const PhotonSource source(sensor, make_scene(Scene::kRoom, scene), klux, test_seed());
    const RtlConfiguration configuration = find_rtl_configuration(parameters, source.rows(), 10);
    std::vector<ColumnStream> columns;
    columns.reserve(static_cast<std::size_t>(configuration.sram_num));
    for (int column = 0; column < configuration.sram_num; ++column) {
      columns.push_back(source.column(column * source.columns() / configuration.sram_num));
    }
    RtlReadout rtl(configuration);
    ASSERT_TRUE(agrees_with_model(rtl, columns, sensor.acquisitions, default_options(test_seed())));
  }
}

}  // namespace
}  // namespace dtof
