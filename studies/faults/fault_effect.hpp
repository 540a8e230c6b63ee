// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "dtof/core/result.hpp"
#include "faults/array_srams.hpp"
#include "faults/fault_subject.hpp"

namespace dtof {

struct PixelPlace {
  int column = 0;
  int row = 0;

  bool operator==(const PixelPlace&) const = default;
};

/// The pixels that a fault may touch: those of its columns, of a pool read-out its engine's, without the
/// faulty pixel itself.
struct FaultReach {
  ColumnRange columns;
  std::optional<PixelPlace> faulty_pixel;

  [[nodiscard]] bool contains(PixelPlace pixel) const {
    return columns.contains(pixel.column) && pixel != faulty_pixel;
  }
};

/// What one fault did to the frame that it disturbed, against the frame without it.
struct FaultEffect {
  int pixels = 0;          ///< within reach
  int changed = 0;         ///< whose result differs, if only in its confidence
  int moved = 0;           ///< whose depth differs
  int beyond = 0;          ///< whose depth moved by more than 3 % of the distance
  double largest_m = 0.0;  ///< the farthest move
};

FaultEffect fault_effect(const FaultSubject& subject, std::span<const PixelResult> actual,
                         const FaultReach& reach);

/// Pixels whose result differs though no fault touches their column.
int changed_elsewhere(const FaultSubject& subject, std::span<const PixelResult> actual,
                      std::span<const FaultReach> faults);

}  // namespace dtof
