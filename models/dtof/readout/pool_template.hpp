// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"

namespace dtof {

/// Computes the TEMPLATE registers of poolPointer (docs/reference/poolpointer.md, Template) from columns of
/// frames without sunlight and target. An entry is three times the counts of a bin's sum over a group and its
/// neighbours, at most 255 units. Throws InputError for timestamps that pool_column_events() refuses, or if
/// the columns have no pair of rows.
PoolTemplate measured_template(std::span<const ColumnStream> columns, std::uint32_t acquisitions,
                               const ReadoutParameters& parameters);

}  // namespace dtof
