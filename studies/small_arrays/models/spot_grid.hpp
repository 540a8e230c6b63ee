// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/photon/target_map.hpp"

namespace dtof {

/// Positions of a small array's pixels within a large array that covers the same field. Each small pixel sees
/// the spot of one pixel of the large array: the pixel at the middle of the small pixel's share of the field.
/// The laser lights these spots alone, so a small pixel has more signal. Its own field of view, and hence its
/// background, equals that of a large array's pixel.
struct SpotGrid {
  int columns = 0;     ///< columns of the large array
  int rows = 0;        ///< rows of the large array
  std::vector<int> x;  ///< the large array's column of each small column, ascending
  std::vector<int> y;  ///< the large array's row of each small row, ascending

  [[nodiscard]] int small_columns() const { return static_cast<int>(x.size()); }
  [[nodiscard]] int small_rows() const { return static_cast<int>(y.size()); }
};

/// Throws InputError unless the small array has at least one pixel, and at most the columns and rows of the
/// large one.
SpotGrid make_spot_grid(int columns, int rows, int small_columns, int small_rows);

/// Targets of the small array's pixels. Throws InputError for a map that differs in size from the grid's
/// large array.
TargetMap spots_of(const TargetMap& targets, const SpotGrid& grid);

/// Index of the spot nearest to a coordinate; the lower of two equally near spots. `spots` must be ascending.
int nearest_spot(const std::vector<int>& spots, int coordinate);

}  // namespace dtof
