// SPDX-License-Identifier: Apache-2.0
// Raw frames of dtof_array: the histograms of chosen rows as the models have them, between frames of results.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>

#include "dtof/core/error.hpp"
#include "dtof/readout/model.hpp"
#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

std::vector<RtlConfiguration> raw_configurations() {
  std::vector<RtlConfiguration> configurations = compiled_rtl_configurations();
  std::erase_if(configurations,
                [](const RtlConfiguration& configuration) { return !configuration.raw_histogram; });
  return configurations;
}

class RawHistogram : public testing::TestWithParam<RtlConfiguration> {
 protected:
  // Every bin of every chosen pixel is the model's.
  static void expect_histograms(RtlReadout& rtl, const std::vector<ColumnStream>& columns,
                                std::uint32_t acquisitions, const RtlRunOptions& options) {
    const RtlConfiguration& configuration = rtl.configuration();
    const RtlFrame frame = rtl.run(columns, acquisitions, options);
    const auto bins = static_cast<std::size_t>(configuration.parameters.raw_bins());
    const std::size_t rows =
        static_cast<std::size_t>(options.raw->last) - static_cast<std::size_t>(options.raw->first) + 1;
    ASSERT_EQ(frame.results.size(), rows * bins * columns.size());
    for (std::size_t column = 0; column < columns.size(); ++column) {
      const auto expected =
          make_readout_model(configuration.parameters)->run_raw_column(columns[column], acquisitions);
      for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t bin = 0; bin < bins; ++bin) {
          ASSERT_EQ(frame.results[(row * bins + bin) * columns.size() + column],
                    expected[row + static_cast<std::size_t>(options.raw->first)][bin])
              << "row " << row << " of the chosen ones, bin " << bin << ", column " << column << "; "
              << reproduce_command();
        }
      }
    }
  }

  static RawRows pick_rows(CounterRandom& random) {
    const int first = pick(random, GetParam().pixels_per_sram);
    return {first, first + pick(random, GetParam().pixels_per_sram - first)};
  }
};

INSTANTIATE_TEST_SUITE_P(Compiled, RawHistogram, testing::ValuesIn(raw_configurations()),
                         configuration_test_name);

TEST_P(RawHistogram, IsTheModelsBetweenFramesOfResults) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 60);
  RtlReadout rtl(GetParam());
  RtlRunOptions options = default_options(test_seed());
  for (std::size_t round = 0; round < 2 * kStreamKinds.size(); ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    const auto acquisitions = static_cast<std::uint32_t>(pick(random, 40));
    move_gate(rtl, random);
    const std::vector<ColumnStream> columns = adversarial_columns(GetParam(), acquisitions, round, random);
    options.pause_probability = 0.3 * (round % 3 == 1 ? 1.0 : 0.0);
    options.stall_probability = 0.4 * (round % 4 == 2 ? 1.0 : 0.0);
    options.start_probability = 0.2 * (round % 5 == 3 ? 1.0 : 0.0);
    options.raw.reset();
    if (round % 3 == 0) {
      ASSERT_TRUE(agrees_with_model(rtl, columns, acquisitions, options));
    } else {
      options.raw = pick_rows(random);
      ASSERT_NO_FATAL_FAILURE(expect_histograms(rtl, columns, acquisitions, options));
    }
    options.reset_first = false;
  }
}

// What a raw frame leaves in the memories, and where a reset leaves it, is nothing to the next frame.
TEST_P(RawHistogram, IsWholeBehindAResetAtAnyTime) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 61);
  RtlReadout rtl(GetParam());
  RtlRunOptions options = default_options(test_seed());
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    const std::vector<ColumnStream> columns =
        adversarial_columns(GetParam(), 9, static_cast<std::size_t>(round), random);
    options.raw = pick_rows(random);
    options.reset_at = 1 + random() % 2000;
    ASSERT_NO_FATAL_FAILURE(expect_histograms(rtl, columns, 9, options));
    options.raw.reset();
    options.reset_at.reset();
    options.reset_first = false;
    ASSERT_TRUE(agrees_with_model(rtl, columns, 9, options));
  }
}

TEST_P(RawHistogram, RefusesRowsThatAreNotThere) {
  RtlReadout rtl(GetParam());
  const std::vector<ColumnStream> none;
  for (const RawRows rows : {RawRows{1, 0}, RawRows{-1, 0}, RawRows{0, GetParam().pixels_per_sram}}) {
    RtlRunOptions options;
    options.raw = rows;
    EXPECT_THROW((void)rtl.run(none, 1, options), InputError);
  }
}

TEST(RawHistogramAlone, NeedsAnArrayThatHasIt) {
  for (const RtlConfiguration& configuration : compiled_rtl_configurations()) {
    if (!configuration.raw_histogram) {
      RtlReadout rtl(configuration);
      RtlRunOptions options;
      options.raw = RawRows{0, 0};
      EXPECT_THROW((void)rtl.run({}, 1, options), InputError);
      return;
    }
  }
  FAIL() << "all arrays have it";
}

}  // namespace
}  // namespace dtof
