// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/confidence_counts.hpp"

#include <gtest/gtest.h>

namespace dtof {
namespace {

// A tenth of the pixels at each confidence.
const ConfidenceCounts kTenths = {{0, 10}, {1, 10}, {2, 10}, {3, 10}, {4, 10},
                                  {5, 10}, {6, 10}, {7, 10}, {8, 10}, {9, 10}};

TEST(ConfidenceCounts, CountsFromAConfidenceOn) {
  EXPECT_EQ(count_from(kTenths, 0), 100U);
  EXPECT_EQ(count_from(kTenths, 7), 30U);
  EXPECT_EQ(count_from(kTenths, 10), 0U);
  EXPECT_EQ(count_from({}, 0), 0U);
}

TEST(ConfidenceCounts, ThresholdLetsNoMorePassThanTheShare) {
  EXPECT_EQ(lowest_threshold(kTenths, 0.1), 9);
  EXPECT_EQ(lowest_threshold(kTenths, 0.0999), 10);
  EXPECT_EQ(lowest_threshold(kTenths, 0.35), 7);
  EXPECT_EQ(lowest_threshold(kTenths, 1.0), 0);
  EXPECT_EQ(lowest_threshold({}, 0.1), 0);
  for (const double share : {0.0, 0.05, 0.15, 0.5, 0.99}) {
    const int threshold = lowest_threshold(kTenths, share);
    EXPECT_LE(static_cast<double>(count_from(kTenths, threshold)), 100.0 * share);
    EXPECT_GT(static_cast<double>(count_from(kTenths, threshold - 1)), 100.0 * share);
  }
}

}  // namespace
}  // namespace dtof
