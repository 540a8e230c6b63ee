// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Random123/philox.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace dtof {

/// Counter-based generator (Philox4x32-10, Salmon et al., SC 2011). The numbers depend only on the seed and
/// the four stream words, so any pixel of any frame can be generated alone. Satisfies
/// UniformRandomBitGenerator.
class CounterRandom {
 public:
  using result_type = std::uint32_t;

  /// `purpose` separates uses (photons, resampling, tests); `a` and `b` are e.g. frame and pixel index.
  CounterRandom(std::uint64_t seed, std::uint32_t purpose, std::uint32_t a, std::uint32_t b)
      : key_{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)}},
        counter_{{0, purpose, a, b}} {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  result_type operator()() {
    if (next_ == 4) {
      block_ = r123::Philox4x32()(counter_, key_);
      ++counter_[0];
      next_ = 0;
    }
    return block_[next_++];
  }
  /// Fills `words`, whose number must be even, with whole blocks of two words. Faster than single calls: the
  /// processor works on several blocks at a time, as vectors where it has AVX2 (same words). The rest of a
  /// block that a single call began stays for later single calls.
  void fill(std::span<std::uint64_t> words);
  std::uint64_t bits64() {
    const std::uint64_t high = (*this)();
    return (high << 32U) | (*this)();
  }
  /// Uniform in the open interval (0, 1), 53 bits.
  double uniform() { return (static_cast<double>(bits64() >> 11U) + 0.5) * 0x1.0p-53; }

 private:
  r123::Philox4x32::key_type key_;
  r123::Philox4x32::ctr_type counter_;
  r123::Philox4x32::ctr_type block_{};
  std::size_t next_ = 4;
};

/// SplitMix64 (Steele, Lea and Flood, OOPSLA 2014), a cheap generator for uses where Philox would dominate
/// the run time. Seed it for each pixel from a CounterRandom. Satisfies UniformRandomBitGenerator.
class SplitMix64 {
 public:
  using result_type = std::uint64_t;

  explicit SplitMix64(CounterRandom random) : state_(random.bits64()) {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  result_type operator()() {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t word = state_;
    word = (word ^ (word >> 30U)) * 0xBF58476D1CE4E5B9U;
    word = (word ^ (word >> 27U)) * 0x94D049BB133111EBU;
    return word ^ (word >> 31U);
  }

 private:
  std::uint64_t state_;
};

/// Purposes of random streams. A new use gets a new number.
enum class RandomPurpose : std::uint32_t {
  kPhotons = 1,
  kResampling = 2,
  kTestStream = 3,
  kTestControl = 4,
  kFastPhotons = 5,
  kScene = 6,
  kFaults = 7,
  kPixelDefects = 8,
  kIntensityImage = 9,
  kTrainingScene = 10,
  kIndependentPhotons = 11,
  kTimingSkew = 12,
  kFurtherReturns = 13
};

}  // namespace dtof
