// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "dtof/core/detection.hpp"
#include "dtof/core/pixel_sampler.hpp"

namespace dtof {

/// The acquisitions [begin, end) of a frame.
struct AcquisitionRange {
  std::uint32_t begin;
  std::uint32_t end;

  [[nodiscard]] constexpr std::uint32_t size() const { return end - begin; }
  bool operator==(const AcquisitionRange&) const = default;
};

/// Part `index` (0 .. count - 1) of a frame that is cut at floor(acquisitions * index / count)
/// (docs/reference/readouts.md). The two measurements are halves, the steps of three steps thirds, PiFH's
/// runs 2^(NP-NB) parts.
constexpr AcquisitionRange frame_part(std::uint32_t acquisitions, std::uint32_t index, std::uint32_t count) {
  const auto cut = [=](std::uint64_t position) {
    return static_cast<std::uint32_t>(acquisitions * position / count);
  };
  return {cut(index), cut(std::uint64_t{index} + 1)};
}

constexpr AcquisitionRange measurement_1(std::uint32_t acquisitions) {
  return frame_part(acquisitions, 0, 2);
}
constexpr AcquisitionRange measurement_2(std::uint32_t acquisitions) {
  return frame_part(acquisitions, 1, 2);
}

/// Walks once through a pixel's detections, pass by pass, and drops the no-detection code.
class PassCursor {
 public:
  /// `row` is sorted by acquisition; `no_detection` is the all-ones code, 2^NP - 1.
  PassCursor(std::span<const Detection> row, std::uint32_t no_detection)
      : next_(row.data()),
        last_(row.data() + row.size()),
        no_detection_(static_cast<std::int32_t>(no_detection)) {}

  /// Calls `apply(timestamp)` for the remaining detections of acquisitions before `end` with
  /// first <= x < last.
  template <typename Apply>
  void advance_to(std::uint32_t end, std::int32_t first, std::int32_t last, Apply&& apply) {
    const std::int32_t lowest = std::max(first, 0);
    const std::int32_t above = std::max(lowest, std::min(last, no_detection_));
    if (lowest == 0 && above == no_detection_) {
      const Detection* next = next_;  // a local stays in a register across the calls
      for (; next != last_ && next->acquisition < end; ++next) {
        if (next->timestamp != no_detection_) {
          apply(std::uint32_t{next->timestamp});
        }
      }
      next_ = next;
      return;
    }
    // The comparison is unpredictable, so timestamps inside the window are selected without a branch.
    const auto offset = static_cast<std::uint32_t>(lowest);
    const auto width = static_cast<std::uint32_t>(above - lowest);
    std::array<Timestamp, 64> inside;  // NOLINT(cppcoreguidelines-pro-type-member-init): written before read
    for (bool more = true; more;) {
      const Detection* const stop = next_ + std::min<std::ptrdiff_t>(last_ - next_, inside.size());
      std::size_t count = 0;
      const Detection* next = next_;
      for (; next != stop && next->acquisition < end; ++next) {
        inside[count] = next->timestamp;
        count += static_cast<std::size_t>(next->timestamp - offset < width);
      }
      for (std::size_t i = 0; i < count; ++i) {
        apply(std::uint32_t{inside[i]});
      }
      more = next == stop && next != last_;
      next_ = next;
    }
  }

 private:
  const Detection* next_;
  const Detection* last_;
  std::int32_t no_detection_;
};

/// Same walk over timestamps that a sampler draws on demand, only inside each pass's window.
class SampledCursor {
 public:
  SampledCursor(PixelSampler& sampler, std::uint32_t no_detection)
      : sampler_(sampler), no_detection_(no_detection) {}

  template <typename Apply>
  void advance_to(std::uint32_t end, std::int32_t first, std::int32_t last, Apply&& apply) {
    if (end <= next_) {
      return;
    }
    for (const Timestamp timestamp : sampler_.draw(end - next_, first, last)) {
      if (timestamp != no_detection_) {
        apply(std::uint32_t{timestamp});
      }
    }
    next_ = end;
  }

 private:
  PixelSampler& sampler_;
  std::uint32_t no_detection_;
  std::uint32_t next_ = 0;  // acquisition that the next pass begins with
};

}  // namespace dtof
