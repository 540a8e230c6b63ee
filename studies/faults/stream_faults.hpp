// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "dtof/core/detection.hpp"

namespace dtof {

/// Returns `column` with `code` in every slot of every acquisition and pixel.
ColumnStream with_stuck_timestamps(const ColumnStream& column, std::uint32_t acquisitions, int slots,
                                   Timestamp code);

/// Returns `column` with an additional event of pixel `row` in every acquisition, at the code that `code`
/// returns. An acquisition keeps its first `slots` events.
ColumnStream with_hot_pixel(const ColumnStream& column, int row, std::uint32_t acquisitions, int slots,
                            const std::function<Timestamp()>& code);

/// Returns `column` without detections of pixel `row`.
ColumnStream with_dead_pixel(const ColumnStream& column, int row);

}  // namespace dtof
