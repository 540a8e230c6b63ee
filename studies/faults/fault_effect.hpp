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

/// Pixels that a fault may affect: those of its columns (in a pool read-out, of its engine), without the
/// faulty pixel itself.
struct FaultReach {
  ColumnRange columns;
  std::optional<PixelPlace> faulty_pixel;

  [[nodiscard]] bool contains(PixelPlace pixel) const {
    return columns.contains(pixel.column) && pixel != faulty_pixel;
  }
};

/// Effect of one fault on a frame, relative to the frame without the fault.
struct FaultEffect {
  int pixels = 0;          ///< pixels that the fault may affect
  int changed = 0;         ///< pixels whose result differs, including in confidence only
  int moved = 0;           ///< pixels whose depth differs
  int beyond = 0;          ///< pixels whose depth changed by more than 3 % of the distance
  double largest_m = 0.0;  ///< largest change of a depth
};

FaultEffect fault_effect(const FaultSubject& subject, std::span<const PixelResult> actual,
                         const FaultReach& reach);

/// Number of pixels whose result differs although no fault may affect them.
int changed_elsewhere(const FaultSubject& subject, std::span<const PixelResult> actual,
                      std::span<const FaultReach> faults);

}  // namespace dtof
