// SPDX-License-Identifier: Apache-2.0
#include "rtl/frame_clocks.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "dtof/core/frame_time.hpp"

namespace dtof {
namespace {

/// dtof_array. M5 sends a pixel's results. The scan of a pixel begins with M5 of the pixel before, and ends
/// at the earliest kAfterResults clocks behind it, for its last bin waits until the results are out.
std::uint64_t array_clocks(int rows, int simulated, const RtlStatistics& statistics, int columns) {
  constexpr std::int64_t kAfterResults = 5;
  const auto clocks_in = [&](RtlState state) {
    return static_cast<std::int64_t>(statistics.state_cycles[static_cast<std::size_t>(state)]);
  };
  const std::int64_t others = rows - 1;
  const std::int64_t scanning = clocks_in(RtlState::kM4);
  const std::int64_t sending = clocks_in(RtlState::kM5) / rows;
  // One pixel's scan, of scanning = scan + others * max(scan - sending, kAfterResults).
  const std::int64_t scan = std::min((scanning + others * sending) / rows, scanning - others * kAfterResults);
  const std::int64_t wanted_sending = sending + sending_clocks(columns) - sending_clocks(simulated);
  const std::int64_t wanted_scanning = scan + others * std::max(scan - wanted_sending, kAfterResults);
  return statistics.cycles +
         static_cast<std::uint64_t>(wanted_scanning - scanning + rows * (wanted_sending - sending));
}

/// The last engine may have fewer columns than `together`.
std::optional<std::uint64_t> pool_clocks(int rows, int together, int simulated,
                                         const RtlStatistics& statistics, int columns) {
  if (simulated != std::min(together, columns)) {
    return std::nullopt;
  }
  return statistics.cycles + static_cast<std::uint64_t>(pool_decide_clocks(rows, columns, together) -
                                                        pool_decide_clocks(rows, simulated, together));
}

}  // namespace

std::optional<std::uint64_t> frame_clocks(const RtlConfiguration& configuration,
                                          const RtlStatistics& statistics, int columns) {
  const int together = configuration.parameters.columns_together();
  return together > 1
             ? pool_clocks(configuration.pixels_per_sram, together, configuration.sram_num, statistics,
                           columns)
             : array_clocks(configuration.pixels_per_sram, configuration.sram_num, statistics, columns);
}

}  // namespace dtof
