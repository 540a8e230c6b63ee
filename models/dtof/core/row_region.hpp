// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "dtof/core/detection.hpp"

namespace dtof {

/// Returns a source of which only `rows` are switched on: row 0 of the result is row `rows.first` of
/// `source`. Each pixel keeps its detections. A SampledSource stays one and keeps its samples. The other rows
/// cost nothing if `source` can make rows alone (StreamSource::column_rows).
///
/// `source` must outlive the result. Throws InputError unless `rows` has at least one row and lies within
/// `source`.
std::unique_ptr<StreamSource> row_region(const StreamSource& source, RowRange rows);

/// Returns a source of `rows` rows of which only `lit` are switched on. These are the rows of `source` with
/// the same numbers; all others are dark and cost nothing.
///
/// `source` must outlive the result. Throws InputError unless `lit` has at least one row and lies within
/// `source` and `rows`.
std::unique_ptr<StreamSource> dark_except(const StreamSource& source, RowRange lit, int rows);

}  // namespace dtof
