// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/target_map.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {

bool PixelTarget::returns_signal() const {
  return depth_m > 0.0 && std::isfinite(depth_m) && reflectivity > 0.0;
}

TargetMap::TargetMap(int columns, int rows, PixelTarget target) : columns_(columns), rows_(rows) {
  if (columns < 1 || rows < 1) {
    throw InputError(fmt::format("the array must have at least 1 x 1 pixels, not {} x {}", columns, rows));
  }
  targets_.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), target);
}

void TargetMap::set_cube(std::shared_ptr<const TransientCube> cube) {
  if (cube && (cube->columns() != columns_ || cube->rows() != rows_)) {
    throw InputError(fmt::format("a transient cube of {} x {} pixels does not fit an array of {} x {}",
                                 cube->columns(), cube->rows(), columns_, rows_));
  }
  cube_ = std::move(cube);
}

void TargetMap::validate() const {
  for (int column = 0; column < columns_; ++column) {
    for (int row = 0; row < rows_; ++row) {
      const PixelTarget& target = at(column, row);
      // Written so that a NaN fails.
      if (!(target.depth_m >= 0.0)) {
        throw InputError(fmt::format("pixel (column {}, row {}): depth must be at least 0 m, not {}", column,
                                     row, target.depth_m));
      }
      if (!(target.reflectivity >= 0.0) || !std::isfinite(target.reflectivity)) {
        throw InputError(fmt::format(
            "pixel (column {}, row {}): reflectivity must be a finite number of at least 0, not {}", column,
            row, target.reflectivity));
      }
    }
  }
}

}  // namespace dtof
