// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pool_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace dtof {
namespace {

CoarseHistogram filled(std::uint16_t count) {
  CoarseHistogram histogram;
  histogram.fill(count);
  return histogram;
}

TEST(CountPeriod, AddsAndSaturates) {
  CoarseHistogram histogram = filled(100);
  CoarseHistogram counts{};
  counts[3] = 26;
  counts[4] = 28;
  EXPECT_TRUE(count_period(histogram, counts, false, 7));
  EXPECT_EQ(histogram[2], 100);
  EXPECT_EQ(histogram[3], 126);
  EXPECT_EQ(histogram[4], 127);
}

TEST(CountPeriod, ASweepWithoutAFullBinChangesNothing) {
  CoarseHistogram histogram = filled(126);
  EXPECT_TRUE(count_period(histogram, CoarseHistogram{}, true, 7));
  EXPECT_EQ(histogram, filled(126));
}

TEST(CountPeriod, ASweepTakesAQuarterOfTheRangeFromEveryBin) {
  CoarseHistogram histogram = filled(32);
  histogram[9] = 126;
  CoarseHistogram counts{};
  counts[9] = 1;
  EXPECT_TRUE(count_period(histogram, counts, true, 7));
  CoarseHistogram expected = filled(0);
  expected[9] = 95;
  EXPECT_EQ(histogram, expected);
}

TEST(CountPeriod, ASweepFreezesAHistogramWithASmallBin) {
  CoarseHistogram histogram = filled(127);
  histogram[31] = 31;
  const CoarseHistogram before = histogram;
  EXPECT_FALSE(count_period(histogram, CoarseHistogram{}, true, 7));
  EXPECT_EQ(histogram, before);
}

TEST(CountPeriod, TheQuarterFollowsTheWidth) {
  CoarseHistogram histogram = filled(15);
  EXPECT_TRUE(count_period(histogram, CoarseHistogram{}, true, 4));
  EXPECT_EQ(histogram, filled(11));
}

TEST(Thinned, OfThirtyTwoAcquisitionsSevenInTheFirstEighthAndNoneInTheLast) {
  for (int eighth = 0; eighth < 8; ++eighth) {
    for (const std::int32_t position : {8192 * eighth, 8192 * eighth + 8191}) {
      int count = 0;
      for (std::uint32_t acquisition = 1024; acquisition < 1536; ++acquisition) {
        count += thinned(position, acquisition) ? 1 : 0;
      }
      EXPECT_EQ(count, 16 * (7 - eighth)) << position;
    }
  }
}

/// With one background event per acquisition in the mean (100 klux), the preferred timestamps of a pixel
/// without a target have this density at t of the range: those of even acquisitions are the first, those of
/// odd ones the second, or the only one.
double preferred_density(double t, double events) {
  const double first = events * std::exp(-events * t);
  const double second = events * events * t * std::exp(-events * t);
  const double only = events * std::exp(-events);
  return 0.5 * first + 0.5 * (second + only);
}

TEST(Thinned, LeavesAnEvenBackgroundInStrongLight) {
  constexpr double kEvents = 1.07;
  std::vector<double> before;
  std::vector<double> after;
  for (int eighth = 0; eighth < 8; ++eighth) {
    int kept = 0;
    for (std::uint32_t acquisition = 0; acquisition < 512; ++acquisition) {
      kept += thinned(8192 * eighth, acquisition) ? 0 : 1;
    }
    before.push_back(preferred_density((eighth + 0.5) / 8.0, kEvents));
    after.push_back(before.back() * kept / 512.0);
  }
  EXPECT_NEAR(before.front() / before.back(), 1.25, 0.03);
  EXPECT_NEAR(after.front() / after.back(), 1.0, 0.05);
}

TEST(Thinned, LevelsTakeTurns) {
  // The first acquisitions of each 64: with reversed bits, levels are far apart.
  const std::vector<int> levels = {0, 4, 2, 6, 1, 5, 3, 7};
  for (std::uint32_t i = 0; i < 8; ++i) {
    for (int eighth = 0; eighth < 8; ++eighth) {
      const bool expected = levels[i] + eighth < 7;
      EXPECT_EQ(thinned(8192 * eighth, 64 * i), expected);
      EXPECT_EQ(thinned(8192 * eighth, 64 * i + 15), expected);
      EXPECT_FALSE(thinned(8192 * eighth, 64 * i + 16));
      EXPECT_FALSE(thinned(8192 * eighth, 64 * i + 63));
    }
  }
}

TEST(ChainBeliefs, NeighboursCarryAWeakPixelAndAStrongOneStays) {
  const auto node = [](int near_evidence, int far_evidence) {
    return ChainNode{2, 4, {1000, 20000}, {near_evidence, far_evidence}};
  };
  const std::vector<ChainNode> weak = {node(9, 0), node(0, 5), node(9, 0)};
  EXPECT_GT(chain_beliefs(weak)[1][0], chain_beliefs(weak)[1][1]);
  const std::vector<ChainNode> strong = {node(9, 0), node(0, 9), node(9, 0)};
  EXPECT_LT(chain_beliefs(strong)[1][0], chain_beliefs(strong)[1][1]);
}

}  // namespace
}  // namespace dtof
