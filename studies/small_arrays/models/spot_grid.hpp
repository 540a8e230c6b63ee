// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/photon/target_map.hpp"

namespace dtof {

/// Where the pixels of a small array look, seen from the large array that covers the same field: each at the
/// spot of one pixel of the large array, the one that holds the middle of the small pixel's share of the
/// field. The laser lights these spots alone, so that a small pixel has more signal, and its own field of
/// view, hence its background, stays that of a large array's pixel.
struct SpotGrid {
  int columns = 0;     ///< of the large array
  int rows = 0;        ///< of the large array
  std::vector<int> x;  ///< the large array's column of each small column, ascending
  std::vector<int> y;  ///< the large array's row of each small row, ascending

  [[nodiscard]] int small_columns() const { return static_cast<int>(x.size()); }
  [[nodiscard]] int small_rows() const { return static_cast<int>(y.size()); }
};

/// Throws InputError unless the small array has at least one pixel and no more columns or rows than the large
/// one.
SpotGrid make_spot_grid(int columns, int rows, int small_columns, int small_rows);

/// What the small array's pixels look at. Throws InputError for a map that has not the grid's size.
TargetMap spots_of(const TargetMap& targets, const SpotGrid& grid);

/// Index of the spot nearest to a coordinate, the lower one of two; `spots` ascending.
int nearest_spot(const std::vector<int>& spots, int coordinate);

}  // namespace dtof
