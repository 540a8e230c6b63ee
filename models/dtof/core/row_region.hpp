// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "dtof/core/detection.hpp"

namespace dtof {

/// A source of which only `rows` are switched on: a source of rows.count rows, whose row 0 is row
/// `rows.first` of `source`. Each pixel keeps its detections (and a SampledSource, which stays one, its
/// samples); the other rows cost nothing, as far as `source` can make rows alone (StreamSource::column_rows).
///
/// `source` must outlive the result. Throws InputError unless there is a row and all are the source's.
std::unique_ptr<StreamSource> row_region(const StreamSource& source, RowRange rows);

/// A source of `rows` rows of which only `lit` are switched on: these are the rows of `source` with the same
/// numbers, all others are dark and cost nothing.
///
/// `source` must outlive the result. Throws InputError unless `lit` is as for row_region and within `rows`.
std::unique_ptr<StreamSource> dark_except(const StreamSource& source, RowRange lit, int rows);

}  // namespace dtof
