// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pool_template.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

/// Columns whose even rows have a timestamp of coarse bin 3 in every acquisition that `period` divides.
std::vector<ColumnStream> columns_with(std::uint32_t acquisitions, std::uint32_t period, int columns,
                                       int rows) {
  std::vector<ColumnStream> array(static_cast<std::size_t>(columns));
  for (ColumnStream& column : array) {
    for (int row = 0; row < rows; ++row) {
      for (std::uint32_t a = 0; row % 2 == 0 && a < acquisitions; a += period) {
        column.append({a, Timestamp{3 * 32 + 7}});
      }
      column.finish_row();
    }
  }
  return array;
}

// 14 / 64 of 1280 acquisitions are coarse: 280, and 63, 127, 191 and 255 are sweeps. A group has 4 pairs of
// rows, a sum 7 groups; three times what they count is taken, in units of 4.
TEST(PoolTemplate, ThreeTimesWhatASumCounts) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kPoolPointer);
  const auto array = columns_with(1280, 56, 3, 8);  // 0, 56, 112, 168, 224
  PoolTemplate expected{};
  expected[3] = 105;  // 3 * 7 * 4 * 5 / 4
  EXPECT_EQ(measured_template(array, 1280, parameters), expected);
}

TEST(PoolTemplate, SweepsDoNotCountAndEntriesSaturate) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kPoolPointer);
  EXPECT_EQ(measured_template(columns_with(1280, 85, 2, 4), 1280, parameters)[3], 63);  // 0, 85, 170, not 255
  PoolTemplate expected{};
  expected[3] = 255;
  EXPECT_EQ(measured_template(columns_with(1280, 1, 2, 4), 1280, parameters), expected);
}

TEST(PoolTemplate, UnitFollowsTheWidthOfABin) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kPoolPointer);
  parameters.count_width = 8;
  EXPECT_EQ(measured_template(columns_with(1280, 56, 1, 2), 1280, parameters)[3], 53);  // 52.5
  EXPECT_EQ(pool_template_unit(4), 1);
  EXPECT_EQ(pool_template_unit(5), 1);
  EXPECT_EQ(pool_template_unit(6), 2);
  EXPECT_EQ(pool_template_unit(8), 8);
}

TEST(PoolTemplate, NeedsTwoRows) {
  EXPECT_THAT([] { (void)measured_template({}, 10, ReadoutParameters::defaults(Readout::kPoolPointer)); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("at least two rows")));
}

}  // namespace
}  // namespace dtof
