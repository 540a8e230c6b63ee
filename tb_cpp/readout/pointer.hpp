// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/parameters.hpp"
#include "core/result.hpp"
#include "readout/pass_schedule.hpp"

namespace dtof {

/// Widths of a pointer word: NP integer bits and FRACTION_BITS below the point. Words are in units of
/// 2^-fraction_bits bin and wrap.
struct PointerFormat {
  int integer_bits;
  int fraction_bits;

  [[nodiscard]] constexpr unsigned bits() const {
    return static_cast<unsigned>(integer_bits + fraction_bits);
  }
  [[nodiscard]] constexpr std::uint32_t mask() const { return (1U << bits()) - 1; }
};

/// Distance from the pointer to a timestamp, to the right, modulo the range.
constexpr std::uint32_t pointer_distance(PointerFormat format, std::uint32_t word, std::uint32_t timestamp) {
  return ((timestamp << static_cast<unsigned>(format.fraction_bits)) - word) & format.mask();
}

/// Eq. 3.12: the word after a timestamp at `distance`; `step` in word units. The opposite point counts as
/// right.
constexpr std::uint32_t pointer_move(PointerFormat format, std::uint32_t word, std::uint32_t distance,
                                     std::uint32_t step) {
  const std::uint32_t half = 1U << (format.bits() - 1);
  const std::uint32_t right = (word + step) & format.mask();
  const std::uint32_t left = (word - step) & format.mask();
  const std::uint32_t moved = distance <= half ? right : left;
  return distance == 0 ? word : moved;
}

/// True if the top min(5, width) bits of `distance` are all 0 or all 1: the timestamp supports the pointer.
constexpr bool pointer_near(PointerFormat format, std::uint32_t distance) {
  const std::uint32_t reach = 1U << (format.bits() - std::min(5U, format.bits()));
  return ((distance + reach) & format.mask()) < 2 * reach;
}

/// Codes above < x <= up_to, signed, no wrap.
struct CodeWindow {
  std::int32_t above;
  std::int32_t up_to;
};

/// Moves a pixel's pointer over one measurement: step schedule, move and confidence (docs/readouts.md).
class PointerBuilder {
 public:
  explicit PointerBuilder(const ReadoutParameters& parameters)
      : format_{parameters.np, parameters.fraction_bits},
        step_(static_cast<std::uint32_t>(parameters.pointer_step)
              << static_cast<unsigned>(parameters.fraction_bits)),
        confidence_limit_((1U << static_cast<unsigned>(parameters.confidence_width)) - 1) {}

  [[nodiscard]] PointerFormat format() const { return format_; }

  /// Fixes the acquisitions that move the pointer; gear g (step >> g) ends where a 2^-(g+1)th is left.
  void start_frame(AcquisitionRange measurement) {
    for (int gear = 0; gear <= format_.fraction_bits; ++gear) {
      const std::uint32_t left =
          gear == format_.fraction_bits ? 0 : measurement.size() >> static_cast<unsigned>(gear + 1);
      gear_end_[static_cast<std::size_t>(gear)] = measurement.end - left;
    }
  }

  /// Starts at `word` and follows the rest of the row's detections inside `window`.
  [[nodiscard]] PixelResult follow(PassCursor& row, std::uint32_t word, CodeWindow window) const {
    std::uint32_t confidence = 0;
    for (int gear = 0; gear <= format_.fraction_bits; ++gear) {
      const std::uint32_t step = step_ >> static_cast<unsigned>(gear);
      row.advance_to(gear_end_[static_cast<std::size_t>(gear)], [&](std::uint32_t timestamp) {
        const auto code = static_cast<std::int32_t>(timestamp);
        if (code <= window.above || code > window.up_to) {
          return;
        }
        const std::uint32_t distance = pointer_distance(format_, word, timestamp);
        word = pointer_move(format_, word, distance, step);
        if (pointer_near(format_, distance)) {
          confidence += confidence < confidence_limit_ ? 1 : 0;
        } else if ((timestamp & kFarSampleMask) == 0) {
          confidence -= confidence > 0 ? 1 : 0;
        }
      });
    }
    const std::uint32_t fraction_mask = (1U << static_cast<unsigned>(format_.fraction_bits)) - 1;
    return {static_cast<std::uint16_t>(word >> static_cast<unsigned>(format_.fraction_bits)),
            static_cast<std::uint16_t>(word & fraction_mask), static_cast<std::uint16_t>(confidence)};
  }

 private:
  static constexpr std::uint32_t kFarSampleMask = 7;  // one far timestamp in eight counts
  static constexpr std::size_t kMostGears = 9;        // FRACTION_BITS 0 .. 8

  PointerFormat format_;
  std::uint32_t step_;
  std::uint32_t confidence_limit_;
  std::array<std::uint32_t, kMostGears> gear_end_{};
};

}  // namespace dtof
