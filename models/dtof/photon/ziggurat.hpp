// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace dtof {

/// The fast path of Boost.Random's ziggurats (normal or exponential, mean 0 or 1, double): draws that the
/// first 64-bit word decides, 97 of 100. The caller leaves the other draws to Boost; its inner loop then has
/// no call, and its sums stay in registers.
class Ziggurat {
 public:
  /// Draws as boost::random::exponential_distribution<double>(1.0).
  static const Ziggurat& exponential();
  /// Draws as boost::random::normal_distribution<double>(0.0, 1.0).
  static const Ziggurat& normal();

  struct Draw {
    double value;
    bool decided;  ///< false: Boost needs more words, and its value may differ
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
