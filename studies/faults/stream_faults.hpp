// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "dtof/core/detection.hpp"

namespace dtof {

/// The column when every slot of every acquisition and pixel carries `code`.
ColumnStream with_stuck_timestamps(const ColumnStream& column, std::uint32_t acquisitions, int slots,
                                   Timestamp code);

/// The column when its pixel `row` fires once more in every acquisition, at what `code` returns for it. The
/// TDC keeps the first `slots` events of an acquisition.
ColumnStream with_hot_pixel(const ColumnStream& column, int row, std::uint32_t acquisitions, int slots,
                            const std::function<Timestamp()>& code);

/// The column when its pixel `row` sees nothing.
ColumnStream with_dead_pixel(const ColumnStream& column, int row);

}  // namespace dtof
