// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/histogram.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace dtof {
namespace {

HistogramPeak peak_of(Histogram& histogram, std::initializer_list<std::uint32_t> bins) {
  for (const std::uint32_t bin : bins) {
    histogram.add(bin);
  }
  return histogram.take_peak();
}

TEST(Histogram, EmptyHasPeakZero) {
  Histogram histogram(4, 10, FullBin::kFreezes);
  const HistogramPeak peak = histogram.take_peak();
  EXPECT_EQ(peak.bin, 0U);
  EXPECT_EQ(peak.count, 0U);
  EXPECT_EQ(peak.sum, 0U);
  EXPECT_EQ(histogram_confidence(peak, 4), 0U);
}

TEST(Histogram, LowestIndexWinsATieInAnyOrderOfArrival) {
  Histogram histogram(4, 10, FullBin::kFreezes);
  EXPECT_EQ(peak_of(histogram, {9, 3, 9, 3}).bin, 3U);
  EXPECT_EQ(peak_of(histogram, {3, 9, 3, 9}).bin, 3U);
  EXPECT_EQ(peak_of(histogram, {15, 0}).bin, 0U);
}

TEST(Histogram, FullBinsStayFull) {
  for (const int count_width : {1, 2, 10, 16}) {
    Histogram histogram(3, count_width, FullBin::kStays);
    const std::uint32_t limit = (1U << static_cast<unsigned>(count_width)) - 1;
    for (std::uint32_t i = 0; i < limit + 5; ++i) {
      histogram.add(6);
    }
    for (std::uint32_t i = 0; i < limit; ++i) {
      histogram.add(2);
    }
    const HistogramPeak peak = histogram.take_peak();
    EXPECT_EQ(peak.bin, 2U) << "a tie of full bins, COUNT_WIDTH " << count_width;
    EXPECT_EQ(peak.count, limit);
    EXPECT_EQ(peak.sum, 2 * limit);
  }
}

TEST(Histogram, TheFirstFullBinFreezesAllUntilTheScan) {
  for (const int count_width : {1, 2, 10, 16}) {
    Histogram histogram(3, count_width, FullBin::kFreezes);
    const std::uint32_t limit = (1U << static_cast<unsigned>(count_width)) - 1;
    for (int round = 0; round < 2; ++round) {
      std::uint32_t before = 0;
      for (; before + 1 < limit && before < 2; ++before) {
        histogram.add(2);
      }
      for (std::uint32_t i = 0; i < limit + 5; ++i) {
        histogram.add(6);
      }
      for (std::uint32_t i = 0; i < 3 * limit; ++i) {
        histogram.add(2);
        histogram.add(i % 8);
      }
      const HistogramPeak peak = histogram.take_peak();
      EXPECT_EQ(peak.bin, 6U) << "COUNT_WIDTH " << count_width;
      EXPECT_EQ(peak.count, limit);
      EXPECT_EQ(peak.sum, limit + before);
      EXPECT_EQ(peak_of(histogram, {}).sum, 0U) << "nothing is left";
    }
  }
}

TEST(Histogram, ClearedBehindTheScan) {
  Histogram histogram(16, 16, FullBin::kFreezes);
  EXPECT_EQ(peak_of(histogram, {65535, 65535, 0}).bin, 65535U);
  const HistogramPeak peak = peak_of(histogram, {65535, 7, 7});
  EXPECT_EQ(peak.bin, 7U);
  EXPECT_EQ(peak.sum, 3U);
}

TEST(Histogram, EveryBinTouchedTwice) {
  Histogram histogram(3, 4, FullBin::kFreezes);
  for (int round = 0; round < 2; ++round) {
    for (std::uint32_t bin = 0; bin < 8; ++bin) {
      histogram.add(bin);
    }
  }
  EXPECT_EQ(histogram.take_peak().sum, 16U);
}

TEST(HistogramConfidence, PeakAboveTheMeanOfTheRest) {
  EXPECT_EQ(histogram_confidence({.bin = 5, .count = 20, .sum = 20 + 63}, 4), 17U);
  EXPECT_EQ(histogram_confidence({.bin = 0, .count = 1, .sum = 8}, 0), 0U) << "never negative";
  EXPECT_EQ(histogram_confidence({.bin = 0, .count = 65535, .sum = 65535}, 16), 65535U);
}

}  // namespace
}  // namespace dtof
