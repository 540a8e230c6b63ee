// SPDX-License-Identifier: Apache-2.0
#include "core/random.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace dtof {
namespace {

using Counter = r123::Philox4x32::ctr_type;
using Key = r123::Philox4x32::key_type;

#if defined(__x86_64__)
#define DTOF_AVX2 __attribute__((target("avx2")))
constexpr std::size_t kWordsPerBatch = 32;

/// Four blocks, 32-bit values in 64-bit lanes; the upper halves of b and d hold rubbish.
struct Blocks {
  __m256i a;
  __m256i b;
  __m256i c;
  __m256i d;
};

DTOF_AVX2 inline Blocks first_blocks(const Counter& counter, std::uint32_t index) {
  const std::uint32_t first = counter[0] + index;
  return {_mm256_set_epi64x(first + 3, first + 2, first + 1, first), _mm256_set1_epi64x(counter[1]),
          _mm256_set1_epi64x(counter[2]), _mm256_set1_epi64x(counter[3])};
}

DTOF_AVX2 inline Blocks next_round(const Blocks& blocks, __m256i key_0, __m256i key_1) {
  const __m256i product_0 = _mm256_mul_epu32(blocks.a, _mm256_set1_epi64x(PHILOX_M4x32_0));
  const __m256i product_1 = _mm256_mul_epu32(blocks.c, _mm256_set1_epi64x(PHILOX_M4x32_1));
  // b and d are used here only, in their lower halves: keys have none above.
  return {_mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(product_1, 32), blocks.b), key_0), product_1,
          _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(product_0, 32), blocks.d), key_1), product_0};
}

DTOF_AVX2 inline void store(const Blocks& blocks, std::uint64_t* words) {
  const __m256i low = _mm256_set1_epi64x(0xFFFFFFFFU);
  const __m256i even = _mm256_or_si256(_mm256_slli_epi64(blocks.a, 32), _mm256_and_si256(blocks.b, low));
  const __m256i odd = _mm256_or_si256(_mm256_slli_epi64(blocks.c, 32), _mm256_and_si256(blocks.d, low));
  const __m256i outer = _mm256_unpacklo_epi64(even, odd);
  const __m256i inner = _mm256_unpackhi_epi64(even, odd);
  auto* out = reinterpret_cast<__m256i*>(words);
  _mm256_storeu_si256(out, _mm256_permute2x128_si256(outer, inner, 0x20));
  _mm256_storeu_si256(out + 1, _mm256_permute2x128_si256(outer, inner, 0x31));
}

/// The words of r123::Philox4x32's blocks from `counter`, 16 blocks at once: one after the other, each round
/// would wait for the one before.
DTOF_AVX2 void philox_batch(const Counter& counter, const Key& key, std::uint64_t* words) {
  Blocks w = first_blocks(counter, 0);
  Blocks x = first_blocks(counter, 4);
  Blocks y = first_blocks(counter, 8);
  Blocks z = first_blocks(counter, 12);
  std::uint32_t key_0 = key[0];
  std::uint32_t key_1 = key[1];
  for (int round = 0; round < 10; ++round) {
    const __m256i lanes_0 = _mm256_set1_epi64x(key_0);
    const __m256i lanes_1 = _mm256_set1_epi64x(key_1);
    w = next_round(w, lanes_0, lanes_1);
    x = next_round(x, lanes_0, lanes_1);
    y = next_round(y, lanes_0, lanes_1);
    z = next_round(z, lanes_0, lanes_1);
    key_0 += PHILOX_W32_0;
    key_1 += PHILOX_W32_1;
  }
  store(w, words);
  store(x, words + 8);
  store(y, words + 16);
  store(z, words + 24);
}
#endif

}  // namespace

void CounterRandom::fill(std::span<std::uint64_t> words) {
  std::size_t i = 0;
#if defined(__x86_64__)
  static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
  for (; has_avx2 && i + kWordsPerBatch <= words.size(); i += kWordsPerBatch) {
    philox_batch(counter_, key_, &words[i]);
    counter_[0] += kWordsPerBatch / 2;
  }
#endif
  for (; i < words.size(); i += 2, ++counter_[0]) {
    const Counter block = r123::Philox4x32()(counter_, key_);
    words[i] = (std::uint64_t{block[0]} << 32U) | block[1];
    words[i + 1] = (std::uint64_t{block[2]} << 32U) | block[3];
  }
}

}  // namespace dtof
