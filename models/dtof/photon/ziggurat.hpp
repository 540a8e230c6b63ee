// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace dtof {

/// The draws of a ziggurat of Boost.Random (normal or exponential, mean 0 or 1, double) that its first 64-bit
/// word decides, which are 97 of 100. The loop of a caller that leaves the others to Boost has no call in it,
/// so that its sums stay in registers.
class Ziggurat {
 public:
  /// As boost::random::exponential_distribution<double>(1.0) draws.
  static const Ziggurat& exponential();
  /// As boost::random::normal_distribution<double>(0.0, 1.0) draws.
  static const Ziggurat& normal();

  struct Draw {
    double value;
    bool decided;  ///< false: Boost needs more words, and may give another value
  };
  [[nodiscard]] Draw draw(std::uint64_t word) const {
    const Layer& layer = layers_[word & 0xFFU];
    // Boost clears bit 11; the 56 bits left are rounded to a double once.
    const std::uint64_t digits = (word & ~std::uint64_t{0x800}) >> 8U;
    const double value = static_cast<double>(static_cast<std::int64_t>(digits)) * layer.width;
    return {value, std::abs(value) < layer.inside};
  }

 private:
  struct Layer {
    double width;   // signed, per unit of the word's 56 bits
    double inside;  // below this, the layer lies under the curve
  };
  std::array<Layer, 256> layers_{};
};

}  // namespace dtof
