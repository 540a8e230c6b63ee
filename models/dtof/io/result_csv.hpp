// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "dtof/core/result.hpp"

namespace dtof {

/// Header of a result file (spec section 7).
inline constexpr std::string_view kResultCsvHeader = "column,row,code,fraction,confidence";

/// Result of one pixel, with its column and row.
struct ResultRecord {
  int column = 0;
  int row = 0;
  PixelResult result;

  bool operator==(const ResultRecord&) const = default;
};

/// Writes the records in the given order, one line each. Throws OutputError "<path>: cannot write: <reason>".
void write_result_csv(const std::filesystem::path& path, std::span<const ResultRecord> records);

/// Reads a result file. Throws InputError "<file>:<line>: <reason>" at the first malformed line.
std::vector<ResultRecord> read_result_csv(const std::filesystem::path& path);

}  // namespace dtof
