// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/tdc_codes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;

TEST(TdcCodes, WidthsRepeatAndFillTheRange) {
  // 1, 2, 0, 1 and again: 8 codes of 8 units.
  const TdcCodes codes({{0.0, 1.0, 2.0, 0.0, 1.0, 0.0}});
  EXPECT_THAT(codes.boundaries(0, 3), ElementsAre(0.0, 1.0, 3.0, 3.0, 4.0, 5.0, 7.0, 7.0, 8.0));
}

TEST(TdcCodes, ACutPeriodIsScaled) {
  // 3, 1, 3, 1, ...: 8 codes of 16 units; with five widths the last period is cut.
  EXPECT_THAT(TdcCodes({{3.0, 1.0}}).boundaries(0, 3),
              ElementsAre(0.0, 1.5, 2.0, 3.5, 4.0, 5.5, 6.0, 7.5, 8.0));
  const TdcCodes five({{1.0, 1.0, 1.0, 1.0, 4.0}});
  EXPECT_THAT(
      five.boundaries(0, 3),
      ElementsAre(0.0, DoubleEq(8.0 / 11), DoubleEq(16.0 / 11), DoubleEq(24.0 / 11), DoubleEq(32.0 / 11),
                  DoubleEq(64.0 / 11), DoubleEq(72.0 / 11), DoubleEq(80.0 / 11), 8.0));
}

TEST(TdcCodes, PixelsTakeTheTablesInTurn) {
  const TdcCodes codes({{1.0}, {3.0, 1.0}});
  EXPECT_EQ(codes.boundaries(2, 3)[1], 1.0);
  EXPECT_EQ(codes.boundaries(3, 3)[1], 1.5);
}

TEST(TdcCodes, RefusesWhatIsNoWidth) {
  EXPECT_THROW(TdcCodes({}), InputError);
  EXPECT_THROW(TdcCodes({{1.0}, {0.0, 0.0}}), InputError);
  EXPECT_THROW(TdcCodes({{1.0, -0.1, 1.0}}), InputError);
  EXPECT_THROW(TdcCodes({{-0.1, 1.0}}), InputError);
  EXPECT_THROW(TdcCodes({{1.0, std::numeric_limits<double>::quiet_NaN()}}), InputError);
}

}  // namespace
}  // namespace dtof
