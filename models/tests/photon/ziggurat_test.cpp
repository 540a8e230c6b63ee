// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/ziggurat.hpp"

#include <gtest/gtest.h>

#include <array>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "dtof/core/random.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

/// One word, then words of a generator; counts the words taken.
class WordThenOthers {
 public:
  using result_type = std::uint64_t;
  WordThenOthers(std::uint64_t word, CounterRandom others) : word_(word), others_(others) {}
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() { return taken_++ == 0 ? word_ : others_.bits64(); }
  [[nodiscard]] int taken() const { return taken_; }

 private:
  std::uint64_t word_;
  CounterRandom others_;
  int taken_ = 0;
};

/// Every decided draw has Boost's value and takes one word; returns the share of them.
template <typename Distribution>
double compare_with_boost(const Ziggurat& ziggurat, Distribution distribution) {
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0);
  constexpr std::array<std::uint64_t, 6> kEnds = {0, 0xFF, 0x100, ~std::uint64_t{0}, ~0xFFULL, 1ULL << 63U};
  constexpr std::size_t kWords = 200000;
  std::size_t decided = 0;
  for (std::size_t i = 0; i < kWords; ++i) {
    const std::uint64_t word = i < kEnds.size() ? kEnds[i] : random.bits64();
    const Ziggurat::Draw draw = ziggurat.draw(word);
    if (!draw.decided) {
      continue;
    }
    WordThenOthers words(word, random);
    EXPECT_EQ(distribution(words), draw.value) << std::hex << word;
    EXPECT_EQ(words.taken(), 1) << std::hex << word;
    ++decided;
  }
  return static_cast<double>(decided) / kWords;
}

TEST(Ziggurat, DecidedDrawsAreBoosts) {
  SCOPED_TRACE(test_seed_message());
  EXPECT_GT(compare_with_boost(Ziggurat::exponential(), boost::random::exponential_distribution<double>(1.0)),
            0.97);
  EXPECT_GT(compare_with_boost(Ziggurat::normal(), boost::random::normal_distribution<double>(0.0, 1.0)),
            0.97);
}

}  // namespace
}  // namespace dtof
