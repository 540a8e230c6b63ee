// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

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
class TargetMap {
 public:
  /// Gives all pixels the same `target`. Throws InputError unless columns and rows are at least 1.
  TargetMap(int columns, int rows, PixelTarget target = {});

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] const PixelTarget& at(int column, int row) const { return targets_[index(column, row)]; }
  [[nodiscard]] PixelTarget& at(int column, int row) { return targets_[index(column, row)]; }

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
};

}  // namespace dtof
