// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pool_evidence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace dtof {
namespace {

TEST(EighthOctaves, AreTheLogarithmWithinAnEighthOfAnOctave) {
  for (std::uint32_t x = 1; x < 100'000; x += 1 + x / 50) {
    const double exact = 8.0 * std::log2(static_cast<double>(x));
    EXPECT_LE(eighth_octaves(x), exact);
    EXPECT_GT(eighth_octaves(x), exact - 1.69) << x;
  }
  EXPECT_EQ(eighth_octaves(1), 0);
  EXPECT_EQ(eighth_octaves(3), 12);
  EXPECT_EQ(eighth_octaves(3333), 93);
}

TEST(SignificanceOffset, GrowsWithTheFrame) {
  EXPECT_EQ(significance_offset(0), 0);
  EXPECT_EQ(significance_offset(3839), 0);
  EXPECT_EQ(significance_offset(10'000), 6);
  EXPECT_EQ(significance_offset(65'535), 17);
}

PairSums flat(int sum) {
  PairSums sums;
  sums.fill(sum);
  return sums;
}

// In eighth octaves the square of (4 (w - L)) over the variance that Poisson counts have, of a weight of 3
// for the own group's bins and 1 for those of four neighbours: 7 L has a variance of 13 L, the mean of four
// such sums a quarter of it.
TEST(Significance, IsTheHeightInStandardDeviationsOfAFlatBackground) {
  for (const int level : {140, 350, 700}) {
    for (int rise = 10; rise < 400; rise += 10) {
      PairSums sums = flat(level);
      sums[15] += rise;
      const int z = significance(sums, sums, {15, false, 0}, 28, 0);
      const double sigma = std::sqrt(13.0 / 7.0 * 1.25 * level + 30.0);
      const double exact = rise / sigma;  // 1.7 and 2 of it are levels 0 and 1
      const double lower = z == 0 ? 0.0 : 1.7 * std::exp2((z - 1) / 4.0);
      const double upper = z == 7 ? 1e9 : 2.4 * std::exp2(z / 4.0);
      EXPECT_GE(exact, lower) << level << " + " << rise << ": " << z;
      EXPECT_LE(exact, upper) << level << " + " << rise << ": " << z;
    }
  }
}

TEST(Significance, NothingStandsOutOfAFlatHistogramOrAValley) {
  for (std::size_t pair = 0; pair < kCoarsePairs; ++pair) {
    PairSums sums = flat(200);
    EXPECT_EQ(significance(sums, sums, {pair, false, 0}, 28, 0), 0) << pair;
    sums[pair] = 0;
    EXPECT_EQ(significance(sums, sums, {pair, false, 0}, 28, 0), 0) << pair;
  }
}

TEST(Significance, FallsWithLongFramesMissingNeighboursAndThePrior) {
  PairSums sums = flat(200);
  sums[20] = 320;
  const int plain = significance(sums, sums, {20, false, 0}, 28, 0);
  ASSERT_GT(plain, 2);
  ASSERT_LT(plain, 7);
  EXPECT_EQ(significance(sums, sums, {20, false, 1}, 28, 0), plain - 1);
  EXPECT_EQ(significance(sums, sums, {20, false, 2}, 28, 0), plain - 2);
  EXPECT_EQ(significance(sums, sums, {20, false, 0}, 28, 8), plain - 2);
  PairSums raised = sums;
  raised[20] += 28;
  EXPECT_EQ(significance(raised, raised, {20, true, 0}, 28, 0), plain);
}

TEST(Significance, ReadsThePairsBehindAfterAndThoseAheadBeforeTheLeakage) {
  PairSums sums = flat(200);
  sums[16] = 300;
  const PairSums before = sums;
  PairSums after = sums;
  after[19] = after[20] = 0;  // ahead: those before count
  EXPECT_EQ(significance(after, before, {16, false, 0}, 28, 0),
            significance(sums, sums, {16, false, 0}, 28, 0));
  after = sums;
  after[12] = after[13] = 0;  // behind: those after count
  EXPECT_GT(significance(after, before, {16, false, 0}, 28, 0),
            significance(sums, sums, {16, false, 0}, 28, 0));
}

TEST(KeptSignificance, KeepsTheUpperLevelsInTwoBits) {
  const std::vector<int> expected = {0, 0, 0, 1, 1, 2, 2, 3};
  for (int z = 0; z <= kMostSignificance; ++z) {
    EXPECT_EQ(kept_significance(z, 3), z);
    EXPECT_EQ(kept_significance(z, 2), expected[static_cast<std::size_t>(z)]);
    EXPECT_EQ(kept_significance(z, 0), 0);
  }
}

TEST(PoolConfidence, GrowsWithSignificanceAndMargins) {
  constexpr int kLowestWeight = 13;
  for (const int bits : {2, 3}) {
    for (int background = 0; background < 40; ++background) {
      int last = -1;
      for (int z = 0; z < 1 << bits; ++z) {
        const int confidence = pool_confidence(z, bits, {.own = 30, .others = 0}, background, false);
        EXPECT_GT(confidence, last) << z;
        EXPECT_TRUE(z == 0 || confidence >= kLowestWeight) << z;
        last = confidence;
      }
      last = -1;
      for (int margin = 0; margin <= 143; ++margin) {
        const int confidence = pool_confidence(3, bits, {margin, 3 * margin}, background, false);
        EXPECT_GE(confidence, last);
        EXPECT_LT(confidence, 256);
        last = confidence;
      }
    }
  }
}

TEST(PoolConfidence, IsZeroWithoutEvidence) {
  EXPECT_EQ(pool_confidence(0, 3, {0, 0}, 0, false), 0);
  EXPECT_EQ(pool_confidence(7, 3, {0, 0}, 0, false), 0);
  EXPECT_EQ(pool_confidence(0, 3, {0, 18}, 0, false), 0);
}

TEST(PoolConfidence, IsAtLeastTwelveWithAnOwnMarginOfTwelve) {
  for (const bool tilted : {false, true}) {
    EXPECT_EQ(pool_confidence(0, 3, {11, 0}, 39, tilted), 0);
    EXPECT_EQ(pool_confidence(0, 3, {12, 0}, 39, tilted), 12);
    EXPECT_EQ(pool_confidence(0, 3, {100, 0}, 39, tilted), 12);
    EXPECT_EQ(pool_confidence(2, 3, {16, 0}, 39, tilted), 16);
  }
}

TEST(PoolConfidence, ThePixelsOwnMarginLimitsWhatItsGroupSays) {
  EXPECT_EQ(pool_confidence(7, 3, {3, 0}, 0, false), 12);
  EXPECT_EQ(pool_confidence(7, 3, {16, 0}, 0, false), 64);
  EXPECT_EQ(pool_confidence(7, 3, {18, 0}, 0, false), 64);
}

TEST(PoolConfidence, MarginsOfATiltedBackgroundSayNothing) {
  EXPECT_EQ(pool_confidence(4, 3, {100, 300}, 9, true), pool_confidence(4, 3, {100, 0}, 39, false));
}

}  // namespace
}  // namespace dtof
