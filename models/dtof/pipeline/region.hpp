// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/core/detection.hpp"

namespace dtof {

/// Pixels to read out: `rows` of each of `columns`. Results of a region are row-major: index = (row -
/// rows.first) * columns.size() + i for the i-th column.
struct Region {
  std::vector<int> columns;  ///< ascending, each once
  RowRange rows;

  /// All pixels of a sensor with this many columns and rows.
  static Region whole(int columns, int rows);
};

}  // namespace dtof
