// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"
#include "dtof/readout/pass_schedule.hpp"

namespace dtof {

/// A pointer word in the model, left-aligned in 32 bits. So integer overflow equals the wrap-around of the
/// range, and the sign of a distance tells right from left.
using PointerWord = std::uint32_t;

/// Eq. 3.12: pointer word after a timestamp at `distance` = timestamp - word. The opposite point (the most
/// negative distance) counts as right. The function has no branch: the direction is almost random, and
/// mispredictions would dominate the run time.
constexpr PointerWord pointer_move(PointerWord word, PointerWord distance, PointerWord step) {
  const auto left = static_cast<PointerWord>(static_cast<std::int32_t>(distance - 1) >> 31);  // 0 or all ones
  const PointerWord signed_step = (step ^ left) - left;
  return word + (distance == 0 ? 0 : signed_step);
}

/// Layout of a pointer word: bits of bins and of fractions.
class PointerFormat {
 public:
  constexpr explicit PointerFormat(const ReadoutParameters& parameters)
      : integer_bits_(static_cast<unsigned>(parameters.np)),
        fraction_bits_(static_cast<unsigned>(parameters.fraction_bits)) {}

  [[nodiscard]] constexpr unsigned fraction_bits() const { return fraction_bits_; }
  /// Pointer word at the beginning of bin `bins`.
  [[nodiscard]] constexpr PointerWord word(std::uint32_t bins) const { return bins << (32 - integer_bits_); }
  [[nodiscard]] constexpr std::uint32_t code(PointerWord word) const { return word >> (32 - integer_bits_); }
  /// Fraction of a word, in units of 2^-fraction_bits bin.
  [[nodiscard]] constexpr std::uint32_t fraction(PointerWord word) const {
    return (word >> (32 - integer_bits_ - fraction_bits_)) & ((1U << fraction_bits_) - 1);
  }
  /// True if a timestamp at `distance` supports the pointer: the top min(5, NP + FRACTION_BITS) bits are all
  /// 0 or all 1.
  [[nodiscard]] constexpr bool near(PointerWord distance) const {
    const PointerWord reach = 1U << (32 - std::min(5U, integer_bits_ + fraction_bits_));
    return distance + reach < 2 * reach;
  }

 private:
  unsigned integer_bits_;
  unsigned fraction_bits_;
};

/// Window of codes above < x <= up_to, signed, without wrap-around.
struct CodeWindow {
  std::int32_t above;
  std::int32_t up_to;
};

/// Moves a pixel's pointer over one measurement: step schedule, move and confidence
/// (docs/reference/readouts.md).
class PointerBuilder {
 public:
  explicit PointerBuilder(const ReadoutParameters& parameters)
      : format_(parameters),
        step_(format_.word(static_cast<std::uint32_t>(parameters.pointer_step))),
        confidence_limit_((1U << static_cast<unsigned>(parameters.confidence_width)) - 1) {}

  /// Sets the acquisitions that move the pointer. Gear g (step >> g) ends when 2^-(g+1) of the measurement is
  /// left.
  void start_frame(AcquisitionRange measurement) {
    for (unsigned gear = 0; gear <= format_.fraction_bits(); ++gear) {
      const std::uint32_t left = gear == format_.fraction_bits() ? 0 : measurement.size() >> (gear + 1);
      gear_end_[gear] = measurement.end - left;
    }
  }

  /// Starts at code `start` and moves the pointer by the row's remaining detections inside `window`.
  template <typename Cursor>
  [[nodiscard]] PixelResult follow(Cursor& row, std::uint32_t start, CodeWindow window) const {
    const PointerFormat format = format_;
    const std::uint32_t limit = confidence_limit_;
    PointerWord word = format.word(start);
    std::uint32_t confidence = 0;
    for (unsigned gear = 0; gear <= format.fraction_bits(); ++gear) {
      const PointerWord step = step_ >> gear;
      row.advance_to(gear_end_[gear], window.above + 1, window.up_to + 1, [&](std::uint32_t timestamp) {
        const PointerWord distance = format.word(timestamp) - word;
        word = pointer_move(word, distance, step);
        const bool near = format.near(distance);
        const bool counted_far = !near & ((timestamp & kFarSampleMask) == 0);
        confidence += static_cast<std::uint32_t>(near & (confidence < limit));
        confidence -= static_cast<std::uint32_t>(counted_far & (confidence > 0));
      });
    }
    return {static_cast<std::uint16_t>(format.code(word)), static_cast<std::uint16_t>(format.fraction(word)),
            static_cast<std::uint16_t>(confidence)};
  }

 private:
  static constexpr std::uint32_t kFarSampleMask = 7;  // one far timestamp in eight counts
  static constexpr std::size_t kMostGears = 9;        // FRACTION_BITS 0 .. 8

  PointerFormat format_;
  PointerWord step_;
  std::uint32_t confidence_limit_;
  std::array<std::uint32_t, kMostGears> gear_end_{};
};

}  // namespace dtof
