// SPDX-License-Identifier: Apache-2.0
// poolPointer's RTL against its model where pixels belong together: surfaces, light, phases, schedules,
// engines' borders. What every read-out must stand is in every_configuration_test and disturbance_test.
#include "dtof/readout/pool_pointer.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <vector>

#include "dtof/readout/model.hpp"
#include "scoreboard/scoreboard.hpp"
#include "tests/rtl/pool_surfaces.hpp"
#include "tests/rtl/promised_values.hpp"
#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

/// Surfaces that some neighbouring columns share, as the pixels of a scene do.
std::vector<ColumnStream> shared_surfaces(const RtlConfiguration& configuration, std::uint32_t acquisitions,
                                          View view, CounterRandom& random) {
  std::vector<ColumnStream> columns = surface_columns(configuration, acquisitions, view, random);
  for (std::size_t column = 1; column < columns.size(); ++column) {
    if (pick(random, 2) == 0) {
      columns[column] = columns[column - 1];
    }
  }
  return columns;
}

/// The largest margin with which a pixel of one engine decides.
int largest_margin(const ReadoutParameters& parameters, const std::vector<ColumnStream>& columns,
                   std::uint32_t acquisitions) {
  std::vector<PoolColumn> events;
  for (const ColumnStream& column : columns) {
    events.push_back(pool_column_events(column, parameters.np, acquisitions));
  }
  int largest = 0;
  for (const PoolWinners& winners : read_engine(events, acquisitions, pool_pointer_parameters(parameters))) {
    for (const PoolWinner& winner : winners) {
      largest = std::max(largest, winner.margin);
    }
  }
  return largest;
}

// Arrays of 22 and 24 columns are compiled for their clocks (frame_clocks_test). Their engines are those of
// arrays with 4 to 8 columns; more of them than two are in every_configuration_test, too.
bool is_twin(const RtlConfiguration& configuration) { return configuration.sram_num > 20 && !long_tests(); }

class EveryPoolPointer : public testing::TestWithParam<RtlConfiguration> {
 protected:
  // Acquisitions so many that no phase is empty and every gear of the smallest array turns.
  static std::uint32_t frame_length() { return GetParam().pixels_per_sram > 100 ? 70 : 260; }
};

INSTANTIATE_TEST_SUITE_P(Compiled, EveryPoolPointer,
                         testing::ValuesIn(configurations_with([](const RtlConfiguration& configuration) {
                           return !is_twin(configuration);
                         })),
                         configuration_test_name);

class SmallPoolPointer : public EveryPoolPointer {};

INSTANTIATE_TEST_SUITE_P(Compiled, SmallPoolPointer,
                         testing::ValuesIn(configurations_with([](const RtlConfiguration& configuration) {
                           return configuration.pixels_per_sram <= 40 && !is_twin(configuration);
                         })),
                         configuration_test_name);

class ShortPoolPointer : public EveryPoolPointer {};

INSTANTIATE_TEST_SUITE_P(Compiled, ShortPoolPointer,
                         testing::ValuesIn(configurations_with([](const RtlConfiguration& configuration) {
                           return configuration.pixels_per_sram <= 13 && !is_twin(configuration);
                         })),
                         configuration_test_name);

TEST_P(EveryPoolPointer, EndsAFrameWithoutDetections) {
  RtlReadout rtl(GetParam());
  for (const std::uint32_t acquisitions : {0U, 1U, 40U}) {
    SCOPED_TRACE(testing::Message() << acquisitions << " acquisitions");
    RtlFrame frame;
    const std::vector<ColumnStream> columns(1);
    ASSERT_TRUE(agrees_with_model(rtl, columns, acquisitions, default_options(1), &frame));
  }
}

TEST_P(EveryPoolPointer, AgreesWithModelWhateverItSees) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 41);
  RtlRunOptions options = default_options(test_seed());
  for (const bool smooth : {true, false}) {
    RtlConfiguration configuration = GetParam();
    configuration.parameters.pool.smooth = smooth;
    RtlReadout rtl(configuration);
    options.reset_first = true;
    for (const View view : kViews) {
      const std::uint32_t acquisitions = frame_length() + random() % 16;
      SCOPED_TRACE(testing::Message()
                   << view_name(view) << ", " << acquisitions << " acquisitions, S1 " << smooth);
      ASSERT_TRUE(agrees_with_model(rtl, shared_surfaces(GetParam(), acquisitions, view, random),
                                    acquisitions, options));
      options.reset_first = false;
    }
  }
}

TEST_P(EveryPoolPointer, AgreesWithModelWhateverTheTemplate) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 46);
  RtlRunOptions options = default_options(test_seed());
  for (const View view : kViews) {
    RtlConfiguration configuration = GetParam();
    for (std::uint8_t& entry : configuration.parameters.pool.coarse_template) {
      const std::array<int, 4> kinds = {0, 255, pick(random, 256), pick(random, 16)};
      entry = static_cast<std::uint8_t>(kinds[static_cast<std::size_t>(pick(random, 4))]);
    }
    RtlReadout rtl(configuration);
    SCOPED_TRACE(testing::Message() << view_name(view) << ", " << configuration.parameters.to_string());
    ASSERT_TRUE(agrees_with_model(rtl, shared_surfaces(configuration, frame_length(), view, random),
                                  frame_length(), options));
    options.reset_first = false;
  }
}

// Every short frame, and schedules whose ends coincide or leave a phase a single acquisition. No end depends
// on the number of pixels: arrays of more than a thousand have three lengths.
TEST_P(EveryPoolPointer, AgreesWithModelWhateverTheSchedule) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 42);
  RtlRunOptions options = default_options(test_seed());
  constexpr std::array<std::array<int, 2>, 5> kShares = {{{1, 1}, {62, 1}, {1, 62}, {31, 1}, {1, 31}}};
  const bool few = GetParam().pixels_per_sram * GetParam().sram_num > 1000 && !long_tests();
  const std::vector<std::uint32_t> lengths =
      few ? std::vector<std::uint32_t>{2, 31, 65} : std::vector<std::uint32_t>{0, 1, 2, 3, 5, 7, 31, 64, 65};
  for (const auto& [coarse, track] : kShares) {
    RtlConfiguration configuration = GetParam();
    configuration.parameters.pool.coarse_share = coarse;
    configuration.parameters.pool.track_share = track;
    RtlReadout rtl(configuration);
    for (const std::uint32_t acquisitions : lengths) {
      const View view = kViews[static_cast<std::size_t>(pick(random, kViews.size()))];
      SCOPED_TRACE(testing::Message() << view_name(view) << ", " << acquisitions << " acquisitions, shares "
                                      << coarse << ", " << track);
      ASSERT_TRUE(agrees_with_model(rtl, shared_surfaces(configuration, acquisitions, view, random),
                                    acquisitions, options));
      options.reset_first = false;
    }
  }
}

// Surfaces at both ends of the range and pointer phases so short that the steps are still coarse: the last
// one often goes beyond the end, for which a pointer that is kept beside a candidate stands.
TEST_P(SmallPoolPointer, AgreesWithModelBeyondTheEndsOfTheRange) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 44);
  const int codes = GetParam().parameters.code_count();
  RtlConfiguration configuration = GetParam();
  configuration.parameters.pool.coarse_share = 20;
  configuration.parameters.pool.track_share = 20;
  RtlReadout rtl(configuration);
  RtlRunOptions options = default_options(test_seed());
  for (std::uint32_t acquisitions = 8; acquisitions <= 64; acquisitions += 4) {
    SCOPED_TRACE(testing::Message() << acquisitions << " acquisitions");
    std::vector<ColumnStream> columns(static_cast<std::size_t>(std::min(configuration.sram_num, 4)));
    for (std::size_t index = 0; index < columns.size(); ++index) {
      const int begin = index % 2 == 0 ? 0 : codes - 3;  // the last code is that of no detection
      for (int row = 0; row < configuration.pixels_per_sram; ++row) {
        for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
          columns[index].append({acquisition, static_cast<Timestamp>(begin + pick(random, 2))});
        }
        columns[index].finish_row();
      }
    }
    ASSERT_TRUE(agrees_with_model(rtl, columns, acquisitions, options));
    options.reset_first = false;
  }
}

// Frames as long as a sensor's in strong light, so that pointers settle and move by the fine gears' dithered
// steps.
TEST_P(SmallPoolPointer, AgreesWithModelInTheFineGears) {
  SCOPED_TRACE(test_seed_message());
  constexpr std::uint32_t kAcquisitions = 3333;
  CounterRandom random = test_random(test_seed(), 43);
  const int codes = GetParam().parameters.code_count();
  const int width = codes / 16;  // of a pulse
  std::vector<ColumnStream> columns(static_cast<std::size_t>(std::min(GetParam().sram_num, 2)));
  for (ColumnStream& column : columns) {
    const int begin = pick(random, codes - width);
    for (int row = 0; row < GetParam().pixels_per_sram; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < kAcquisitions; ++acquisition) {
        const int code = pick(random, 10) == 0 ? pick(random, codes - 1)
                                               : begin + (pick(random, width) + pick(random, width)) / 2;
        column.append({acquisition, static_cast<Timestamp>(code)});
      }
      column.finish_row();
    }
  }
  RtlReadout rtl(GetParam());
  ASSERT_TRUE(agrees_with_model(rtl, columns, kAcquisitions, default_options(test_seed())));
  if (GetParam().parameters.count_width > 5) {  // else all bins saturate, and nobody finds the surface
    const int almost_full = (1 << GetParam().parameters.pool.count_bits) - 12;
    EXPECT_GE(largest_margin(GetParam().parameters, columns, kAcquisitions), almost_full);
  }
}

// Weak pulses in a frame that is so long that its candidates lose significance; what is left is neither
// nothing nor the largest there is.
TEST_P(ShortPoolPointer, AgreesWithModelInLongFrames) {
  SCOPED_TRACE(test_seed_message());
  constexpr std::uint32_t kAcquisitions = 8000;
  CounterRandom random = test_random(test_seed(), 47);
  const int codes = GetParam().parameters.no_detection();
  std::vector<ColumnStream> columns(static_cast<std::size_t>(std::min(GetParam().sram_num, 4)));
  for (ColumnStream& column : columns) {
    const int pulse = codes / 4 + pick(random, codes / 2);
    for (int row = 0; row < GetParam().pixels_per_sram; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < kAcquisitions; ++acquisition) {
        const double kind = random.uniform();
        if (kind < 0.25) {
          const int code = kind < 0.02 ? pulse + pick(random, 2) : pick(random, codes);
          column.append({acquisition, static_cast<Timestamp>(code)});
        }
      }
      column.finish_row();
    }
  }
  RtlReadout rtl(GetParam());
  ASSERT_TRUE(agrees_with_model(rtl, columns, kAcquisitions, default_options(test_seed())));
}

// Coarse phases so long that bins fill. Light without a pulse lets every bin fill, so that sweeps take a
// quarter of the range from all; a strong pulse fills its own bins alone, so that a sweep freezes the group.
TEST_P(SmallPoolPointer, AgreesWithModelInFullBins) {
  SCOPED_TRACE(test_seed_message());
  constexpr std::uint32_t kAcquisitions = 900;
  CounterRandom random = test_random(test_seed(), 46);
  RtlConfiguration configuration = GetParam();
  configuration.parameters.pool.coarse_share = 62;
  configuration.parameters.pool.track_share = 1;
  const int codes = configuration.parameters.no_detection();
  RtlReadout rtl(configuration);
  RtlRunOptions options = default_options(test_seed());
  for (const double pulses : {0.0, 0.1, 0.5}) {
    SCOPED_TRACE(testing::Message() << "share of pulses " << pulses);
    std::vector<ColumnStream> columns(static_cast<std::size_t>(std::min(configuration.sram_num, 4)));
    for (ColumnStream& column : columns) {
      const int pulse = pick(random, codes - 1);
      for (int row = 0; row < configuration.pixels_per_sram; ++row) {
        for (std::uint32_t acquisition = 0; acquisition < kAcquisitions; ++acquisition) {
          const int code = random.uniform() < pulses ? pulse + pick(random, 2) : pick(random, codes);
          column.append({acquisition, static_cast<Timestamp>(code)});
        }
        column.finish_row();
      }
    }
    ASSERT_TRUE(agrees_with_model(rtl, columns, kAcquisitions, options));
    options.reset_first = false;
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
  const auto columns_of_last_engine = [](const C& c) {
    return c.sram_num % c.parameters.pool.engine_columns;
  };
  EXPECT_THAT(values([](const C& c) { return c.parameters.np; }), hold({8, 9, 10, 12, 16}));
  EXPECT_THAT(values([](const C& c) { return c.pixels_per_sram; }), hold({1, 3, 9, 13, 37, 160}));
  EXPECT_THAT(values([](const C& c) { return c.sram_num; }), hold({1, 2, 3, 7, 10}));
  EXPECT_THAT(values(columns_of_last_engine), IsSupersetOf({0, 1, 2, 3}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.slots; }), hold({2, 3, 4}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.count_width; }), hold({4, 5, 6, 7, 8}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.group_size; }), hold({4, 8, 16, 32}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.labels; }), hold({2, 3, 4, 5, 6, 7}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.score_bits; }), hold({1, 3, 4}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.offset_bits; }), hold({0, 2, 4, 6}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.count_bits; }), IsSupersetOf({4, 7}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.pointer_shift; }), hold({0, 1, 2, 3, 4}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.rival_moves ? 1 : 0; }), IsSupersetOf({0, 1}));
  for (const Readout readout : {Readout::kPoolPointer, Readout::kPoolPointerLean}) {
    EXPECT_THAT(values([&](const C& c) {
                  return c.parameters.readout == readout ? c.parameters.pool.cell_shift : 0;
                }),
                IsSupersetOf({8, 9, 10}));
  }
  EXPECT_THAT(values([](const C& c) { return c.parameters.pool.second_target ? 1 : 0; }),
              IsSupersetOf({0, 1}));
  for (const Readout readout : {Readout::kPoolPointer, Readout::kPoolPointerLean}) {
    EXPECT_THAT(values([&](const C& c) {
                  return c.parameters.readout == readout && c.parameters.pool.amplitude ? 1 : 0;
                }),
                IsSupersetOf({0, 1}));
  }
  for (const bool prior : {false, true}) {
    SCOPED_TRACE(testing::Message() << "prior " << prior);
    const auto with = [&](const std::function<int(const C&)>& field) {
      return values([&](const C& c) { return c.parameters.pool.prior == prior ? field(c) : -1; });
    };
    EXPECT_THAT(with([](const C& c) { return c.pixels_per_sram % c.parameters.pool.group_size; }),
                IsSupersetOf({0, 1}));
    EXPECT_THAT(with(columns_of_last_engine), IsSupersetOf({0, 1, 2, 3}));
    EXPECT_THAT(
        with([](const C& c) { return c.sram_num < c.parameters.pool.engine_columns ? c.sram_num : 0; }),
        IsSupersetOf({1, 3}));
  }
}

// Clocks of a frame of 200 columns. An engine takes its pairs one after the other, so that one pair and two
// tell how long an engine of 34 columns takes; the sink is as slow as the other engines' results. What is not
// streaming does not depend on the frame's length, so that short frames do.
struct Product {
  Readout readout;
  bool prior;
  const char* name;
};

class PoolPointerCycles : public testing::TestWithParam<Product> {};

INSTANTIATE_TEST_SUITE_P(All, PoolPointerCycles,
                         testing::Values(Product{Readout::kPoolPointer, false, "whole"},
                                         Product{Readout::kPoolPointer, true, "prior"},
                                         Product{Readout::kPoolPointerLean, false, "lean"}),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(PoolPointerCycles, AFrameStaysBelowTheLimit) {
  constexpr int kRows = 160;
  constexpr int kColumns = 200;
  constexpr std::uint64_t kAcquisitions = 33'333;
  constexpr std::uint64_t kCycleLimit = 11'000'000;
  const ReadoutParameters parameters = ReadoutParameters::defaults(GetParam().readout);
  const auto engine_columns = static_cast<std::uint64_t>(parameters.pool.engine_columns);
  const std::uint64_t engines = (kColumns + engine_columns - 1) / engine_columns;
  const auto stream = static_cast<std::uint64_t>(kRows) * static_cast<std::uint64_t>(parameters.slots);
  const std::vector<ColumnStream> dark(1);
  RtlRunOptions options = default_options(1);
  options.row_stall = engines - 1;
  const auto overhead_of = [&](int columns, std::uint32_t acquisitions) {
    const std::vector<RtlConfiguration> found =
        configurations_with([&](const RtlConfiguration& configuration) {
          return configuration.parameters.readout == parameters.readout &&
                 configuration.parameters.pool.prior == GetParam().prior &&
                 configuration.pixels_per_sram == kRows && configuration.sram_num == columns &&
                 configuration.parameters.pool.engine_columns >= columns;
        });
    EXPECT_EQ(found.size(), 1U) << columns;
    return RtlReadout(found.front()).run(dark, acquisitions, options).statistics.cycles -
           acquisitions * stream;
  };
  const std::uint64_t two = overhead_of(2, 16);
  EXPECT_EQ(overhead_of(2, 64), two);
  const std::uint64_t overhead = two + (overhead_of(10, 16) - two) / 4 * (engine_columns / 2 - 1);
  EXPECT_EQ((overhead_of(10, 16) - two) % 4, 0U);
  const std::uint64_t cycles = kAcquisitions * stream + overhead;
  fmt::print("{}{}: {} clocks per frame of {} acquisitions, {} of them not streaming, {} engines\n",
             readout_title(parameters.readout), GetParam().prior ? " with a prior" : "", cycles,
             kAcquisitions, overhead, engines);
  EXPECT_LE(cycles, kCycleLimit);
}

}  // namespace
}  // namespace dtof
