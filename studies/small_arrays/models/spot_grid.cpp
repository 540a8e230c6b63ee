// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/models/spot_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

std::vector<int> middles(int count, int small_count) {
  std::vector<int> spots;
  spots.reserve(static_cast<std::size_t>(small_count));
  for (int i = 0; i < small_count; ++i) {
    spots.push_back(static_cast<int>((2 * std::int64_t{i} + 1) * count / (2 * std::int64_t{small_count})));
  }
  return spots;
}

}  // namespace

SpotGrid make_spot_grid(int columns, int rows, int small_columns, int small_rows) {
  if (small_columns < 1 || small_rows < 1 || small_columns > columns || small_rows > rows) {
    throw InputError(fmt::format("a small array has 1 to {} columns and 1 to {} rows, not {} x {}", columns,
                                 rows, small_columns, small_rows));
  }
  return {columns, rows, middles(columns, small_columns), middles(rows, small_rows)};
}

TargetMap spots_of(const TargetMap& targets, const SpotGrid& grid) {
  if (targets.columns() != grid.columns || targets.rows() != grid.rows) {
    throw InputError(fmt::format("the map has {} x {} pixels, the large array {} x {}", targets.columns(),
                                 targets.rows(), grid.columns, grid.rows));
  }
  TargetMap small(grid.small_columns(), grid.small_rows());
  for (int i = 0; i < small.columns(); ++i) {
    for (int j = 0; j < small.rows(); ++j) {
      small.at(i, j) = targets.at(grid.x[static_cast<std::size_t>(i)], grid.y[static_cast<std::size_t>(j)]);
    }
  }
  return small;
}

int nearest_spot(const std::vector<int>& spots, int coordinate) {
  const auto right = std::ranges::lower_bound(spots, coordinate);
  if (right == spots.begin()) {
    return 0;
  }
  const auto index = static_cast<int>(right - spots.begin());
  if (right == spots.end() || coordinate - *(right - 1) <= *right - coordinate) {
    return index - 1;
  }
  return index;
}

}  // namespace dtof
