// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "dtof/core/random.hpp"

namespace dtof {

/// Random generator with 64 bits per call, so that Boost's ziggurats fill a double's mantissa from one word.
/// Use one per pixel.
class Bits64 {
 public:
  using result_type = std::uint64_t;
  static constexpr std::size_t kBatch = 32;

  explicit Bits64(CounterRandom& random) : random_(random) {}
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() { return batch()[next_++]; }

  /// Batch that holds the next word; next() is the word's index in it, and `skip_to` passes over words.
  std::span<const std::uint64_t, kBatch> batch() {
    if (next_ == kBatch) {
      random_.fill(words_);
      next_ = 0;
    }
    return words_;
  }
  [[nodiscard]] std::size_t next() const { return next_; }
  void skip_to(std::size_t next) { next_ = next; }

 private:
  CounterRandom& random_;
  std::array<std::uint64_t, kBatch> words_{};
  std::size_t next_ = kBatch;
};

inline double draw_exponential(Bits64& bits) {
  return boost::random::exponential_distribution<double>(1.0)(bits);
}
/// Uniform in [0, 1) for a random word.
inline double uniform_of(std::uint64_t word) { return static_cast<double>(word >> 11U) * 0x1.0p-53; }
/// Uniform in [0, 1).
inline double draw_uniform(Bits64& bits) { return uniform_of(bits()); }
inline double draw_normal(Bits64& bits) { return boost::random::normal_distribution<double>(0.0, 1.0)(bits); }

}  // namespace dtof
