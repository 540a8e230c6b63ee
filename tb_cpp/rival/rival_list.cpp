// SPDX-License-Identifier: Apache-2.0
// The one list of rivals: tables, options and tests take them from here, in this order.
#include <array>

#include "rival/coarse_histogram.hpp"
#include "rival/rival.hpp"

namespace dtof {
namespace {

constexpr std::string_view kWholeFrame =
    "histograms in the pixel: Hutchings, JSSC 2019; Edinburgh and Ouster, IISW 2025 (16 bins of 18 bits)";

constexpr std::array kRivals = std::to_array<RivalEntry>({
    {"histogram32", "32-bin histogram", kWholeFrame,
     [](const SensorModel& sensor) { return make_coarse_histogram(sensor, {}); },
     RivalClaim{{0.2, 0.0}, {3.2, 1.4}}},
});

}  // namespace

std::span<const RivalEntry> all_rivals() { return kRivals; }

}  // namespace dtof
