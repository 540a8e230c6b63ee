// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "dtof/core/philox.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;

std::vector<std::uint32_t> first_numbers(CounterRandom random, int count) {
  std::vector<std::uint32_t> numbers(static_cast<std::size_t>(count));
  std::ranges::generate(numbers, [&random] { return random(); });
  return numbers;
}

TEST(CounterRandom, KnownAnswersOfPhilox4x32) {
  // Random123's kat_vectors, philox4x32 10 rounds: counter and key all zero.
  EXPECT_THAT(first_numbers(CounterRandom(0, 0, 0, 0), 4),
              ElementsAre(0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U));
}

TEST(CounterRandom, SameWordsGiveTheSameNumbers) {
  EXPECT_EQ(first_numbers(CounterRandom(7, 1, 2, 3), 100), first_numbers(CounterRandom(7, 1, 2, 3), 100));
}

TEST(CounterRandom, EveryWordOpensAnotherStream) {
  std::set<std::vector<std::uint32_t>> streams;
  streams.insert(first_numbers(CounterRandom(7, 1, 2, 3), 8));
  streams.insert(first_numbers(CounterRandom(8, 1, 2, 3), 8));
  streams.insert(first_numbers(CounterRandom(7 + (std::uint64_t{1} << 32U), 1, 2, 3), 8));
  streams.insert(first_numbers(CounterRandom(7, 2, 2, 3), 8));
  streams.insert(first_numbers(CounterRandom(7, 1, 3, 3), 8));
  streams.insert(first_numbers(CounterRandom(7, 1, 2, 4), 8));
  EXPECT_EQ(streams.size(), 6U);
}

TEST(CounterRandom, BlocksDoNotRepeat) {
  const std::vector<std::uint32_t> numbers = first_numbers(CounterRandom(1, 1, 0, 0), 4000);
  const std::set<std::uint32_t> different(numbers.begin(), numbers.end());
  EXPECT_GE(different.size(), 3998U);  // 4000^2 / 2^33: a chance repetition is already rare
}

constexpr int kUniformDraws = 1 << 16;

TEST(CounterRandom, UniformIsOpenAndCentred) {
  CounterRandom random(5, 1, 0, 0);
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kUniformDraws; ++i) {
    const double u = random.uniform();
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += (u - 0.5) * (u - 0.5);
  }
  EXPECT_NEAR(sum / kUniformDraws, 0.5, 5 * 0.2887 / 256);  // five standard errors; the seed is fixed
  EXPECT_NEAR(squares / kUniformDraws, 1.0 / 12.0, 5 * 0.0745 / 256);
}

TEST(CounterRandom, FillGivesTheWordsOfSingleCalls) {
  CounterRandom bulk(1, 2, 3, 4);
  CounterRandom single(1, 2, 3, 4);
  for (int repeat = 0; repeat < 3; ++repeat) {
    std::array<std::uint64_t, 38> words{};  // two batches and a rest
    bulk.fill(words);
    for (const std::uint64_t word : words) {
      EXPECT_EQ(word, single.bits64());
    }
  }
}

TEST(CounterRandom, BatchesOfEveryVectorWidthAreTheGeneratorsBlocks) {
  const r123::Philox4x32::ctr_type first = {{0xFFFFFFF5U, 0x80000001U, 0xDEADBEEFU, 7U}};  // counts over 2^32
  const r123::Philox4x32::key_type key = {{0xFEDCBA98U, 0x76543210U}};
  for (const PhiloxBatch batch : philox_batches()) {
    std::array<std::uint64_t, 2 * kPhiloxBatchBlocks> words{};
    batch(first, key, words.data());
    r123::Philox4x32::ctr_type counter = first;
    for (std::size_t i = 0; i < words.size(); i += 2, ++counter[0]) {
      const r123::Philox4x32::ctr_type block = r123::Philox4x32()(counter, key);
      EXPECT_EQ(words[i], (std::uint64_t{block[0]} << 32U) | block[1]) << i;
      EXPECT_EQ(words[i + 1], (std::uint64_t{block[2]} << 32U) | block[3]) << i;
    }
  }
}

TEST(CounterRandom, SixtyFourBitsAreTwoNumbersHighFirst) {
  CounterRandom whole(9, 1, 0, 0);
  CounterRandom halves(9, 1, 0, 0);
  const std::uint64_t high = halves();
  const std::uint64_t low = halves();
  EXPECT_EQ(whole.bits64(), (high << 32U) | low);
}

}  // namespace
}  // namespace dtof
