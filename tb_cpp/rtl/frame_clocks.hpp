// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "rtl/configuration.hpp"
#include "rtl/rtl_readout.hpp"

namespace dtof {

/// Clocks of a frame in an array of `columns` columns, from the statistics of a frame in `configuration`.
/// Both arrays differ in their columns only; source and sink never wait. A pool read-out's `configuration` is
/// one engine; returns nothing if the array's engines have more columns.
std::optional<std::uint64_t> frame_clocks(const RtlConfiguration& configuration,
                                          const RtlStatistics& statistics, int columns);

}  // namespace dtof
