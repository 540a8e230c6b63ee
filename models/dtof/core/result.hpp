// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace dtof {

/// Result of a read-out for one pixel and frame (spec section 3, "Outputs").
struct PixelResult {
  std::uint16_t code = 0;        ///< integer bins, 0 .. 2^NP - 1
  std::uint16_t fraction = 0;    ///< units of 2^-FRACTION_BITS bin
  std::uint16_t confidence = 0;  ///< 0 = none; the scale depends on the read-out (docs/reference/readouts.md)
  /// Position of the losing label, code and fraction as one number. 0 unless poolPointer runs with
  /// SECOND_TARGET.
  std::uint16_t second = 0;
  /// Counts of the target's light; 0 if the pixel's rival won. Amplitude and ambient are 0 unless poolPointer
  /// runs with AMPLITUDE (docs/reference/poolpointer.md).
  std::uint16_t amplitude = 0;
  std::uint16_t ambient = 0;  ///< background B of the pixel's group

  bool operator==(const PixelResult&) const = default;
};

}  // namespace dtof
