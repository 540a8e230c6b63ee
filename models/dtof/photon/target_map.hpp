// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "dtof/photon/transient_cube.hpp"

namespace dtof {

/// Target of one pixel.
struct PixelTarget {
  double depth_m = 0.0;       ///< > 0; 0 or +infinity: no target, background only
  double reflectivity = 1.0;  ///< >= 0; above 1 for mirrors; also scales the reflected sunlight

  /// True if laser light can return. Assumes a valid target.
  [[nodiscard]] bool returns_signal() const;

  bool operator==(const PixelTarget&) const = default;
};

/// One target per pixel of an array of columns() x rows(); column = x, row = y.
///
/// With a transient cube, the cube alone says what laser light returns. A target's depth is then the true
/// distance by which results are judged, and its reflectivity scales the sunlight alone.
class TargetMap {
 public:
  /// Gives all pixels the same `target`. Throws InputError unless columns and rows are at least 1.
  TargetMap(int columns, int rows, PixelTarget target = {});

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] const PixelTarget& at(int column, int row) const { return targets_[index(column, row)]; }
  [[nodiscard]] PixelTarget& at(int column, int row) { return targets_[index(column, row)]; }

  /// Takes a cube of the same size. Throws InputError for another size.
  void set_cube(std::shared_ptr<const TransientCube> cube);
  /// Null: no cube, each pixel has one return.
  [[nodiscard]] const std::shared_ptr<const TransientCube>& cube() const { return cube_; }
  /// True if laser light returns to the pixel.
  [[nodiscard]] bool returns_signal(int column, int row) const {
    return cube_ ? !cube_->light(column, row).none() : at(column, row).returns_signal();
  }

  /// Throws InputError that names the first pixel whose depth or reflectivity is NaN or negative, or whose
  /// reflectivity is infinite.
  void validate() const;

  bool operator==(const TargetMap&) const = default;

 private:
  // Column by column: the photon source works on columns.
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(column) * static_cast<std::size_t>(rows_) + static_cast<std::size_t>(row);
  }

  int columns_;
  int rows_;
  std::vector<PixelTarget> targets_;
  std::shared_ptr<const TransientCube> cube_;
};

}  // namespace dtof
