// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/select_columns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace dtof {
namespace {

using ::testing::ElementsAre;

TEST(ColumnGroups, AreWholeAndMarkTheChosenColumns) {
  const std::vector<int> selected = {9, 2, 4, 5};
  const std::vector<ColumnGroup> groups = column_groups(selected, 4, 10);
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_EQ(groups[0].first, 0);
  EXPECT_EQ(groups[0].count, 4);
  EXPECT_THAT(groups[0].asked, ElementsAre(1));
  EXPECT_EQ(groups[1].first, 4);
  EXPECT_THAT(groups[1].asked, ElementsAre(2, 3));
  EXPECT_EQ(groups[2].first, 8);
  EXPECT_EQ(groups[2].count, 2) << "the last group has what is left";
  EXPECT_THAT(groups[2].asked, ElementsAre(0));
}

TEST(ColumnGroups, OneColumnAloneIsAGroup) {
  const std::vector<int> selected = {3, 1};
  const std::vector<ColumnGroup> groups = column_groups(selected, 1, 10);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].first, 1);
  EXPECT_EQ(groups[0].count, 1);
  EXPECT_THAT(groups[0].asked, ElementsAre(1));
}

}  // namespace
}  // namespace dtof
