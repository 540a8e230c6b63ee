// SPDX-License-Identifier: Apache-2.0
// The clocks of wide arrays follow from those of narrow ones: every two arrays of this program that differ in
// their columns alone. The clocks behind the last timestamps are those that dtof/core/frame_time.hpp
// predicts.
#include "rtl/frame_clocks.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "dtof/core/frame_time.hpp"
#include "dtof/core/latency.hpp"
#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

/// Arrays that differ in their columns alone; of a pool read-out those whose first engine has the same
/// columns.
std::vector<std::vector<RtlConfiguration>> families() {
  std::map<std::string, std::vector<RtlConfiguration>> by_name;
  for (const RtlConfiguration& configuration : compiled_rtl_configurations()) {
    RtlConfiguration alike = configuration;
    const int together = configuration.parameters.columns_together();
    alike.sram_num = together > 1 ? std::min(together, configuration.sram_num) : 0;
    by_name[alike.to_string()].push_back(configuration);
  }
  std::vector<std::vector<RtlConfiguration>> several;
  for (const auto& [name, members] : by_name) {
    if (members.size() > 1) {
      several.push_back(members);
    }
  }
  return several;
}

TEST(FrameClocks, OfAWideArrayFollowFromThoseOfANarrowOne) {
  std::size_t compared = 0;
  int widest = 0;
  for (const std::vector<RtlConfiguration>& family : families()) {
    for (const std::uint32_t acquisitions : {0U, 1U, 6U}) {
      std::vector<RtlStatistics> measured;
      for (const RtlConfiguration& configuration : family) {
        CounterRandom random = test_random(1, acquisitions);
        const std::vector<ColumnStream> columns =
            adversarial_columns(configuration, acquisitions, kStreamKinds.size() - 1, random);
        measured.push_back(RtlReadout(configuration).run(columns, acquisitions).statistics);
      }
      for (std::size_t from = 0; from < family.size(); ++from) {
        for (std::size_t to = 0; to < family.size(); ++to) {
          const auto clocks = frame_clocks(family[from], measured[from], family[to].sram_num);
          const int together = family[from].parameters.columns_together();
          if (together > 1 && family[from].sram_num > together) {
            EXPECT_FALSE(clocks.has_value()) << "from one engine alone";
            continue;
          }
          ASSERT_TRUE(clocks.has_value()) << family[from].to_string();
          EXPECT_EQ(*clocks, measured[to].cycles)
              << family[from].to_string() << " -> SRAM_NUM=" << family[to].sram_num << ", " << acquisitions
              << " acquisitions";
          compared += from == to ? 0 : 1;
          widest = std::max(widest, family[to].sram_num);
        }
      }
    }
  }
  fmt::print("{} pairs of arrays compared, up to {} columns\n", compared, widest);
  EXPECT_GE(compared, 9U);
}

TEST(FrameClocks, FromTheLastTimestampsToDoneAreThePredictedOnes) {
  std::size_t compared = 0;
  for (const RtlConfiguration& configuration : compiled_rtl_configurations()) {
    const ReadoutParameters& parameters = configuration.parameters;
    const auto lines = static_cast<std::uint64_t>(configuration.pixels_per_sram) * parameters.slots;
    for (const std::uint32_t acquisitions : {8U, 17U}) {
      CounterRandom random = test_random(1, acquisitions);
      const std::vector<ColumnStream> columns =
          adversarial_columns(configuration, acquisitions, kStreamKinds.size() - 1, random);
      std::uint64_t last_start = 0;
      RtlRunOptions options;
      options.observer = [&](const RtlCycle& clock) {
        last_start = clock.acquisition_start ? clock.cycle : last_start;
      };
      const std::uint64_t done =
          RtlReadout(configuration).run(columns, acquisitions, options).statistics.cycles;
      // Others have more BROADCAST_STAGES, or parity.
      if (done == predicted_frame_clocks(parameters, configuration.pixels_per_sram, configuration.sram_num,
                                         acquisitions, configuration.signalled_clear)) {
        EXPECT_EQ(done - (last_start + lines),
                  predicted_latency_clocks(parameters, configuration.pixels_per_sram, configuration.sram_num))
            << configuration.to_string() << ", " << acquisitions << " acquisitions";
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 20U);
}

}  // namespace
}  // namespace dtof
