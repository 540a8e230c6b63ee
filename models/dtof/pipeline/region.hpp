// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/core/detection.hpp"

namespace dtof {

/// Pixels of the sensor that are read out: these rows of these columns. Frames of a region are row-major:
/// index = (row - rows.first) * columns.size() + i for the i-th column.
struct Region {
  std::vector<int> columns;  ///< ascending, each once
  RowRange rows;

  /// Every pixel of a sensor of so many columns and rows.
  static Region whole(int columns, int rows);
};

}  // namespace dtof
