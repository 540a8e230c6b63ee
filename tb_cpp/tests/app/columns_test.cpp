// SPDX-License-Identifier: Apache-2.0
#include "app/columns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(ParseColumns, AllIsTheEmptyList) { EXPECT_THAT(parse_columns("all", 200), IsEmpty()); }

TEST(ParseColumns, NumbersAndRangesAreSorted) {
  EXPECT_THAT(parse_columns("7", 8), ElementsAre(7));
  EXPECT_THAT(parse_columns("5,0-2", 8), ElementsAre(0, 1, 2, 5));
}

TEST(ParseColumns, RefusesWhatIsNoColumn) {
  for (const char* text : {"", "x", "1,", "-1", "3-1", "8", "0-8", "1,1", "0-3,2", "1.5", "2 "}) {
    EXPECT_THROW(parse_columns(text, 8), InputError) << text;
  }
}

}  // namespace
}  // namespace dtof
