// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/error_shares.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace dtof {
namespace {

TEST(ErrorShareCounter, CountsSharesAndRelativeErrors) {
  ErrorShareCounter counter;
  counter.add(2.0, 2.0);
  counter.add(2.0, 2.1);  // 5 %
  counter.add(4.0, 3.0);  // 25 %
  counter.add(1.0, 1.02);
  const ErrorShares shares = counter.shares();
  EXPECT_EQ(shares.pixels, 4U);
  EXPECT_DOUBLE_EQ(shares.above_3_percent, 0.5);
  EXPECT_DOUBLE_EQ(shares.above_10_percent, 0.25);
  EXPECT_NEAR(shares.rmse, std::sqrt((0.05 * 0.05 + 0.25 * 0.25 + 0.02 * 0.02) / 4.0), 1e-12);
}

TEST(ErrorShareCounter, NoPixelHasNoShares) {
  const ErrorShares shares = ErrorShareCounter().shares();
  EXPECT_EQ(shares.pixels, 0U);
  EXPECT_EQ(shares.above_3_percent, 0.0);
  EXPECT_EQ(shares.rmse, 0.0);
}

TEST(Pooled, SetsCountByTheirPixels) {
  const std::array<ErrorShares, 2> sets = {
      {{.pixels = 100, .above_3_percent = 0.5, .above_10_percent = 0.1, .rmse = 0.3},
       {.pixels = 300, .above_3_percent = 0.1, .above_10_percent = 0.0, .rmse = 0.1}}};
  const ErrorShares both = pooled(sets);
  EXPECT_EQ(both.pixels, 400U);
  EXPECT_DOUBLE_EQ(both.above_3_percent, 0.2);
  EXPECT_DOUBLE_EQ(both.above_10_percent, 0.025);
  EXPECT_DOUBLE_EQ(both.rmse, std::sqrt((100 * 0.09 + 300 * 0.01) / 400.0));
  EXPECT_EQ(pooled({}).pixels, 0U);
}

}  // namespace
}  // namespace dtof
