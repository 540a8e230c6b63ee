// SPDX-License-Identifier: Apache-2.0
#include "run/region.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(ParseColumns, AllIsEveryColumn) { EXPECT_THAT(parse_columns("all", 4), ElementsAre(0, 1, 2, 3)); }

TEST(ParseColumns, NumbersAndRangesAreSorted) {
  EXPECT_THAT(parse_columns("7", 8), ElementsAre(7));
  EXPECT_THAT(parse_columns("5,0-2", 8), ElementsAre(0, 1, 2, 5));
}

TEST(ParseColumns, RefusesWhatIsNoColumn) {
  for (const char* text : {"", "x", "1,", "-1", "3-1", "8", "0-8", "1,1", "0-3,2", "1.5", "2 "}) {
    EXPECT_THROW(parse_columns(text, 8), InputError) << text;
  }
}

TEST(ParseRows, AllOneOrOneRange) {
  EXPECT_EQ(parse_rows("all", 160), (RowRange{.first = 0, .count = 160}));
  EXPECT_EQ(parse_rows("7", 8), (RowRange{.first = 7, .count = 1}));
  EXPECT_EQ(parse_rows("40-79", 160), (RowRange{.first = 40, .count = 40}));
  EXPECT_EQ(parse_rows("0-159", 160), (RowRange{.first = 0, .count = 160}));
}

TEST(ParseRows, RefusesWhatIsNoRangeOfRows) {
  const std::vector<std::pair<std::string, std::string>> refused = {{"", "'' is not a row number"},
                                                                    {"abc", "'abc' is not a row number"},
                                                                    {"5-2", "range '5-2' runs backwards"},
                                                                    {"0-8", "row 8 is outside 0 to 7"},
                                                                    {"8", "row 8 is outside 0 to 7"},
                                                                    {"-1", "'' is not a row number"},
                                                                    {"1-", "'' is not a row number"},
                                                                    {"1-2-3", "'2-3' is not a row number"},
                                                                    {"0-1,4", "one range"},
                                                                    {"1.5", "'1.5' is not a row number"},
                                                                    {"99999999999", "not a row number"}};
  for (const auto& line : refused) {
    const auto parse = [&] { parse_rows(line.first, 8); };
    EXPECT_THAT(parse, ThrowsMessage<InputError>(HasSubstr(line.second))) << line.first;
  }
}

TEST(Region, WholeIsEveryPixel) {
  const Region region = Region::whole(3, 2);
  EXPECT_THAT(region.columns, ElementsAre(0, 1, 2));
  EXPECT_EQ(region.rows, (RowRange{.first = 0, .count = 2}));
}

TEST(ResultRecords, HaveTheSensorsPixelNumbers) {
  const Region region{.columns = {2, 5}, .rows = {.first = 7, .count = 2}};
  const std::vector<PixelResult> results = {{.code = 1}, {.code = 2}, {.code = 3}, {.code = 4}};
  EXPECT_THAT(result_records(results, region),
              ElementsAre(ResultRecord{2, 7, results[0]}, ResultRecord{5, 7, results[1]},
                          ResultRecord{2, 8, results[2]}, ResultRecord{5, 8, results[3]}));
}

}  // namespace
}  // namespace dtof
