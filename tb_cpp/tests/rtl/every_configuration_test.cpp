// SPDX-License-Identifier: Apache-2.0
// Every compiled configuration against its model, on adversarial streams and every frame length that matters.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

// A program that links the read-outs of configurations.toml only for other tests leaves those to
// rtl_readouts_test.
std::vector<RtlConfiguration> tested_configurations() {
  std::vector<RtlConfiguration> configurations = compiled_rtl_configurations();
#ifdef DTOF_READOUTS_TESTED_ELSEWHERE
  std::erase_if(configurations, [](const RtlConfiguration& configuration) {
    return configuration.pixels_per_sram * configuration.sram_num > 1000;
  });
#endif
  return configurations;
}

class EveryConfiguration : public testing::TestWithParam<RtlConfiguration> {};

INSTANTIATE_TEST_SUITE_P(Compiled, EveryConfiguration, testing::ValuesIn(tested_configurations()),
                         configuration_test_name);

// Frames follow each other without a reset: whatever one leaves behind must not show in the next. Odd and
// even lengths, lengths shorter than the number of passes, and none at all.
TEST_P(EveryConfiguration, AgreesWithModelOnAdversarialStreams) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 1);
  RtlReadout rtl(GetParam());
  RtlRunOptions options = default_options(test_seed());
  std::size_t first_kind = 0;
  for (const std::uint32_t acquisitions : {5U, 0U, 1U, 2U, 3U, 64U, 0U, 33U, 151U, 7U, 400U}) {
    SCOPED_TRACE(testing::Message() << acquisitions << " acquisitions");
    move_gate(rtl, random);
    ASSERT_TRUE(agrees_with_model(rtl, adversarial_columns(GetParam(), acquisitions, first_kind, random),
                                  acquisitions, options));
    options.reset_first = false;
    first_kind += 4;  // every kind reaches every pixel of the smallest array
  }
}

TEST_P(EveryConfiguration, AgreesWithModelWhateverSourceAndSinkDo) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 2);
  RtlReadout rtl(GetParam());
  for (const std::uint32_t acquisitions : {1U, 2U, 9U, 40U, 77U}) {
    SCOPED_TRACE(testing::Message() << acquisitions << " acquisitions");
    RtlRunOptions options = default_options(random.bits64());
    options.pause_probability = random.uniform();
    options.empty_slot_probability = random.uniform();
    options.stall_probability = 0.9 * random.uniform();
    options.start_probability = random.uniform();
    options.reset_first = acquisitions % 2 == 0;
    move_gate(rtl, random);
    ASSERT_TRUE(agrees_with_model(
        rtl, adversarial_columns(GetParam(), acquisitions, random() % kStreamKinds.size(), random),
        acquisitions, options));
  }
}

TEST_P(EveryConfiguration, SurvivesResetInAnyState) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 3);
  RtlReadout rtl(GetParam());
  constexpr std::uint32_t kAcquisitions = 12;
  const std::vector<ColumnStream> columns = adversarial_columns(GetParam(), kAcquisitions, 0, random);
  RtlRunOptions options = default_options(test_seed());
  std::array<std::uint64_t, kRtlStateCount> state_begin{};
  std::array<std::uint64_t, kRtlStateCount> state_end{};
  options.observer = [&](const RtlCycle& clock) {
    const auto state = static_cast<std::size_t>(clock.state);
    if (state_end[state] == 0) {
      state_begin[state] = clock.cycle;
    }
    state_end[state] = clock.cycle + 1;
  };
  ASSERT_TRUE(agrees_with_model(rtl, columns, kAcquisitions, options));
  options.observer = nullptr;
  options.reset_first = false;
  for (std::size_t state = 0; state < kRtlStateCount; ++state) {
    const std::uint64_t length = state_end[state] - state_begin[state];
    if (length == 0) {
      continue;  // ezPointer and the histogram have no coarse pass
    }
    options.reset_at = state_begin[state] + random() % length;
    SCOPED_TRACE(testing::Message() << "reset in clock " << *options.reset_at);
    ASSERT_TRUE(agrees_with_model(rtl, columns, kAcquisitions, options));
  }
}

// Histogram read-outs only: a pointer's result carries no count.
std::vector<RtlConfiguration> histogram_configurations() {
  std::vector<RtlConfiguration> configurations = tested_configurations();
  std::erase_if(configurations, [](const RtlConfiguration& configuration) {
    const Readout readout = configuration.parameters.readout;
    return is_pointer_readout(readout) || !has_histogram(readout);
  });
  return configurations;
}

class EveryHistogram : public testing::TestWithParam<RtlConfiguration> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryHistogram);

INSTANTIATE_TEST_SUITE_P(Compiled, EveryHistogram, testing::ValuesIn(histogram_configurations()),
                         configuration_test_name);

// All detections in one bin, more than a counter holds: it must stay at its maximum, which is then the
// confidence, the rest of the histogram being empty.
TEST_P(EveryHistogram, CountersSaturate) {
  const ReadoutParameters& parameters = GetParam().parameters;
  const std::uint32_t runs =
      parameters.readout == Readout::kPifh ? 1U << (parameters.np - parameters.nb) : 2U;
  const std::uint32_t most = (1U << parameters.count_width) - 1;
  const std::uint32_t acquisitions = runs * (most / static_cast<std::uint32_t>(parameters.slots) + 2);
  ASSERT_LT(acquisitions, 65536U);
  // The lower edge of a coarse bin, or its middle, where SiFH's centred window is.
  const int offset = parameters.window_centred ? (1 << (parameters.np - parameters.nb)) / 2 : 0;
  const auto code = static_cast<Timestamp>(parameters.code_count() / 2 + offset);
  std::vector<ColumnStream> columns(1);
  for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
    for (int slot = 0; slot < parameters.slots; ++slot) {
      columns[0].append({acquisition, code});
    }
  }
  columns[0].finish_row();
  RtlReadout rtl(GetParam());
  RtlFrame frame;
  ASSERT_TRUE(agrees_with_model(rtl, columns, acquisitions, default_options(1), &frame));
  EXPECT_EQ(frame.results.at(0).confidence, most);
  EXPECT_GT(frame.counter_full_clocks, 0U);
}

// All that count detections of a pixel, hisPointer's measurement 1 included. The read-outs of
// configurations.toml count in their array of one column (rtl_test); with ten columns their long frames show
// it again, which takes most of rtl_readouts_test.
std::vector<RtlConfiguration> counting_configurations() {
  std::vector<RtlConfiguration> configurations = tested_configurations();
  std::erase_if(configurations, [](const RtlConfiguration& configuration) {
    const Readout readout = configuration.parameters.readout;
    const bool large = configuration.pixels_per_sram * configuration.sram_num > 1000;
    return is_pool_readout(readout) || !has_histogram(readout) || (large && !long_tests());
  });
  return configurations;
}

class EveryCounter : public testing::TestWithParam<RtlConfiguration> {
 protected:
  // Acquisitions of a frame whose first pass has `acquisitions`.
  static std::uint32_t frame_of(std::uint32_t acquisitions) {
    const ReadoutParameters& parameters = GetParam().parameters;
    switch (parameters.readout) {
      case Readout::kPifh:
        return acquisitions << static_cast<unsigned>(parameters.np - parameters.nb);
      case Readout::kThreeSteps:
        return 6 * acquisitions;
      case Readout::kHistogram:
      case Readout::kCoarseHistogram:
        return acquisitions;
      default:
        return 2 * acquisitions;
    }
  }

  const std::uint32_t most_ = (1U << GetParam().parameters.count_width) - 1;
};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryCounter);

INSTANTIATE_TEST_SUITE_P(Compiled, EveryCounter, testing::ValuesIn(counting_configurations()),
                         configuration_test_name);

// One pixel of the last column has a bin that gets full in the last acquisition of the first pass, or misses
// that by one.
TEST_P(EveryCounter, ReportsTheFirstFullOneAlone) {
  RtlReadout rtl(GetParam());
  const std::uint32_t acquisitions = frame_of(most_);
  ASSERT_LT(acquisitions, 65536U);
  RtlRunOptions options = default_options(1);
  for (const std::uint32_t missing : {1U, 0U, 1U}) {
    SCOPED_TRACE(testing::Message() << missing << " missing");
    std::vector<ColumnStream> columns(static_cast<std::size_t>(GetParam().sram_num));
    for (std::uint32_t acquisition = missing; acquisition < most_; ++acquisition) {
      columns.back().append({acquisition, 0});
    }
    for (ColumnStream& column : columns) {
      column.finish_row();
    }
    RtlFrame frame;
    ASSERT_TRUE(agrees_with_model(rtl, columns, acquisitions, options, &frame));
    EXPECT_EQ(frame.counter_full_clocks, 1U - missing);
    options.reset_first = false;
  }
}

// Light that fills several bins of a pixel, and those of its neighbours in other acquisitions.
TEST_P(EveryCounter, AgreesWithModelInFullBins) {
  const ReadoutParameters& parameters = GetParam().parameters;
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 70);
  RtlReadout rtl(GetParam());
  RtlRunOptions options = default_options(test_seed());
  const std::uint32_t acquisitions = std::min(frame_of(4 * most_), 4000U);
  constexpr int kLitRows = 7;
  for (const auto& [signal, background] : {std::pair(0.8, 0.1), std::pair(0.0, 1.0), std::pair(0.4, 0.6)}) {
    SCOPED_TRACE(testing::Message() << "signal " << signal << ", background " << background);
    std::vector<ColumnStream> columns(static_cast<std::size_t>(GetParam().sram_num));
    for (ColumnStream& column : columns) {
      for (int row = 0; row < GetParam().pixels_per_sram; ++row) {
        const int middle = pick(random, parameters.no_detection());
        for (std::uint32_t acquisition = 0; row < kLitRows && acquisition < acquisitions; ++acquisition) {
          for (int slot = 0; slot < parameters.slots; ++slot) {
            const double draw = random.uniform();
            if (draw < signal) {
              column.append({acquisition, static_cast<Timestamp>(std::min(middle + pick(random, 4),
                                                                          parameters.no_detection()))});
            } else if (draw < signal + background) {
              column.append({acquisition, static_cast<Timestamp>(pick(random, parameters.code_count()))});
            }
          }
        }
        column.finish_row();
      }
    }
    RtlFrame frame;
    ASSERT_TRUE(agrees_with_model(rtl, columns, acquisitions, options, &frame));
    options.reset_first = false;
  }
}

}  // namespace
}  // namespace dtof
