// SPDX-License-Identifier: Apache-2.0
// Clocks of a full frame: 200 x 160 pixels, 33,333 acquisitions, at most 11.0e6 (thesis: 1.06e7 to 1.08e7).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

constexpr std::uint32_t kAcquisitions = 33'333;
constexpr std::uint64_t kCycleLimit = 11'000'000;
constexpr int kColumns = 200;

class FrameCycles : public testing::TestWithParam<Readout> {};

INSTANTIATE_TEST_SUITE_P(FullSize, FrameCycles, testing::ValuesIn(kAllReadouts), readout_test_name);

// The simulated array has fewer columns than 200; what the others add to the result phase is added. The full
// histogram is for small arrays and counted as simulated.
TEST_P(FrameCycles, StayBelowTheLimit) {
  const RtlConfiguration configuration =
      find_rtl_configuration(ReadoutParameters::defaults(GetParam()), 160, kColumns);
  CounterRandom random = test_random(1, 20);
  std::vector<ColumnStream> columns(2);
  for (ColumnStream& column : columns) {
    for (int row = 0; row < configuration.pixels_per_sram; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < kAcquisitions; acquisition += 1 + random() % 1000) {
        column.append(
            {acquisition, static_cast<Timestamp>(pick(random, configuration.parameters.no_detection()))});
      }
      column.finish_row();
    }
  }
  RtlReadout rtl(configuration);
  RtlFrame frame;
  ASSERT_TRUE(agrees_with_model(rtl, columns, kAcquisitions, default_options(1), &frame));

  const int added_columns =
      GetParam() == Readout::kHistogram ? 0 : std::max(0, kColumns - configuration.sram_num);
  const std::uint64_t clocks_per_result = frame.result_cycles.at(1) - frame.result_cycles.at(0);
  const std::uint64_t cycles =
      frame.statistics.cycles +
      clocks_per_result * static_cast<std::uint64_t>(added_columns * configuration.pixels_per_sram);
  fmt::print(
      "{:12} {:.4e} clocks a frame of {} acquisitions (thesis 1.06e7 to 1.08e7), {:.2f} ms at 330 MHz\n",
      readout_title(GetParam()), static_cast<double>(cycles), kAcquisitions,
      static_cast<double>(cycles) / 330e3);
  EXPECT_LE(cycles, kCycleLimit);
}

}  // namespace
}  // namespace dtof
