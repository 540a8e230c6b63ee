// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/result.hpp"
#include "dtof/io/result_csv.hpp"
#include "dtof/pipeline/region.hpp"

namespace dtof {

/// Parses a column list: "all", or numbers and ranges such as "0-9,20,30-32". Returns ascending columns.
/// Throws InputError for anything else, a column named twice, or a column not below `columns`.
std::vector<int> parse_columns(std::string_view text, int columns);

/// Parses rows: "all", one number, or one range such as "40-79". Throws InputError for anything else, or a
/// row not below `rows`.
RowRange parse_rows(std::string_view text, int rows);

/// Results of a region with the sensor's row and column numbers.
std::vector<ResultRecord> result_records(std::span<const PixelResult> results, const Region& region);

}  // namespace dtof
