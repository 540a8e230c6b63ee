// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "dtof/core/detection.hpp"

namespace dtof {

/// Draws one pixel's timestamps measurement by measurement, without acquisition numbers. Suits read-out
/// models that need only the photons inside a window. Not thread-safe.
class PixelSampler {
 public:
  PixelSampler() = default;
  PixelSampler(const PixelSampler&) = delete;
  PixelSampler& operator=(const PixelSampler&) = delete;
  PixelSampler(PixelSampler&&) = delete;
  PixelSampler& operator=(PixelSampler&&) = delete;
  virtual ~PixelSampler() = default;

  /// Selects the pixel of the next draws.
  virtual void start_pixel(int column, int row) = 0;
  /// Timestamps first <= x < last (0 <= first, last <= 2^NP) of the pixel's next `acquisitions` acquisitions.
  /// Valid until the next call.
  virtual std::span<const Timestamp> draw(std::uint32_t acquisitions, std::int32_t first,
                                          std::int32_t last) = 0;
};

/// A source that can also be sampled pixel by pixel. Samples and streams come from different random numbers.
class SampledSource : public StreamSource {
 public:
  /// Makes a sampler; each thread needs its own.
  [[nodiscard]] virtual std::unique_ptr<PixelSampler> pixel_sampler() const = 0;
};

}  // namespace dtof
