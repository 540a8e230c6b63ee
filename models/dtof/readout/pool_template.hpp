// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"

namespace dtof {

/// The TEMPLATE registers of poolPointer for what surrounds a sensor (docs/reference/poolpointer.md,
/// Template), from columns of frames in the dark without a target: three times what a bin's sum over a group
/// and its neighbours counts there, at most 255 units. Throws InputError for timestamps that
/// pool_column_events() refuses, or without a pair of rows.
PoolTemplate measured_template(std::span<const ColumnStream> columns, std::uint32_t acquisitions,
                               const ReadoutParameters& parameters);

}  // namespace dtof
