// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/philox.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace dtof {
namespace {

using Counter = r123::Philox4x32::ctr_type;
using Key = r123::Philox4x32::key_type;

#if defined(__x86_64__)
#define DTOF_AVX2 __attribute__((target("avx2")))

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

/// The words of r123::Philox4x32's blocks from `counter`, 8 blocks at once: one after the other, each round
/// would wait for the one before, and more blocks do not fit into the registers.
DTOF_AVX2 void philox_avx2(const Counter& counter, const Key& key, std::uint64_t* words) {
  for (std::uint32_t block = 0; block < kPhiloxBatchBlocks; block += 8, words += 16) {
    Blocks x = first_blocks(counter, block);
    Blocks y = first_blocks(counter, block + 4);
    std::uint32_t key_0 = key[0];
    std::uint32_t key_1 = key[1];
    for (int round = 0; round < 10; ++round) {
      const __m256i lanes_0 = _mm256_set1_epi64x(key_0);
      const __m256i lanes_1 = _mm256_set1_epi64x(key_1);
      x = next_round(x, lanes_0, lanes_1);
      y = next_round(y, lanes_0, lanes_1);
      key_0 += PHILOX_W32_0;
      key_1 += PHILOX_W32_1;
    }
    store(x, words);
    store(y, words + 8);
  }
}

#define DTOF_AVX512 __attribute__((target("avx512f")))
// GCC 12 warns of the operations without a mask (its headers begin them with an undefined value).
constexpr __mmask8 kAllLanes = 0xFF;

/// The same as Blocks of eight blocks.
struct WideBlocks {
  __m512i a;
  __m512i b;
  __m512i c;
  __m512i d;
};

DTOF_AVX512 inline WideBlocks next_round(const WideBlocks& blocks, __m512i key_0, __m512i key_1) {
  const __m512i product_0 = _mm512_maskz_mul_epu32(kAllLanes, blocks.a, _mm512_set1_epi64(PHILOX_M4x32_0));
  const __m512i product_1 = _mm512_maskz_mul_epu32(kAllLanes, blocks.c, _mm512_set1_epi64(PHILOX_M4x32_1));
  constexpr int kXorOfThree = 0x96;
  return {_mm512_ternarylogic_epi64(_mm512_maskz_srli_epi64(kAllLanes, product_1, 32), blocks.b, key_0,
                                    kXorOfThree),
          product_1,
          _mm512_ternarylogic_epi64(_mm512_maskz_srli_epi64(kAllLanes, product_0, 32), blocks.d, key_1,
                                    kXorOfThree),
          product_0};
}

DTOF_AVX512 inline void store(const WideBlocks& blocks, std::uint64_t* words) {
  const __m512i low = _mm512_set1_epi64(0xFFFFFFFFU);
  constexpr int kOrOfAnd = 0xF8;  // first | (second & third)
  const __m512i even =
      _mm512_ternarylogic_epi64(_mm512_maskz_slli_epi64(kAllLanes, blocks.a, 32), blocks.b, low, kOrOfAnd);
  const __m512i odd =
      _mm512_ternarylogic_epi64(_mm512_maskz_slli_epi64(kAllLanes, blocks.c, 32), blocks.d, low, kOrOfAnd);
  const __m512i first = _mm512_set_epi64(11, 3, 10, 2, 9, 1, 8, 0);
  const __m512i second = _mm512_set_epi64(15, 7, 14, 6, 13, 5, 12, 4);
  _mm512_storeu_si512(words, _mm512_permutex2var_epi64(even, first, odd));
  _mm512_storeu_si512(words + 8, _mm512_permutex2var_epi64(even, second, odd));
}

/// philox_avx2 with 16 blocks at once.
DTOF_AVX512 void philox_avx512(const Counter& counter, const Key& key, std::uint64_t* words) {
  const auto blocks = [&](std::uint32_t index) DTOF_AVX512 {
    const std::uint32_t first = counter[0] + index;
    return WideBlocks{
        _mm512_set_epi64(first + 7, first + 6, first + 5, first + 4, first + 3, first + 2, first + 1, first),
        _mm512_set1_epi64(counter[1]), _mm512_set1_epi64(counter[2]), _mm512_set1_epi64(counter[3])};
  };
  WideBlocks x = blocks(0);
  WideBlocks y = blocks(8);
  std::uint32_t key_0 = key[0];
  std::uint32_t key_1 = key[1];
  for (int round = 0; round < 10; ++round) {
    const __m512i lanes_0 = _mm512_set1_epi64(key_0);
    const __m512i lanes_1 = _mm512_set1_epi64(key_1);
    x = next_round(x, lanes_0, lanes_1);
    y = next_round(y, lanes_0, lanes_1);
    key_0 += PHILOX_W32_0;
    key_1 += PHILOX_W32_1;
  }
  store(x, words);
  store(y, words + 16);
}
#endif

}  // namespace

std::vector<PhiloxBatch> philox_batches() {
  std::vector<PhiloxBatch> batches;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") != 0) {
    batches.push_back(philox_avx512);
  }
  if (__builtin_cpu_supports("avx2") != 0) {
    batches.push_back(philox_avx2);
  }
#endif
  return batches;
}

}  // namespace dtof
