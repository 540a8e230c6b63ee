// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "rtl/configuration.hpp"
#include "rtl/rtl_readout.hpp"

namespace dtof {

/// Clocks of a frame in an array of `columns` columns, from the statistics of a frame in `configuration`,
/// which is the same but for its columns, with a source and a sink that never wait. Of a pool read-out the
/// configuration is one engine; nothing if the array's engines have more columns.
std::optional<std::uint64_t> frame_clocks(const RtlConfiguration& configuration,
                                          const RtlStatistics& statistics, int columns);

}  // namespace dtof
