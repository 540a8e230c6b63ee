// SPDX-License-Identifier: Apache-2.0
#include "dtof/report/table.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace dtof {
namespace {

TEST(Table, PrintsMarkdownAndCsv) {
  Table table({"name", "mm"});
  table.add({"ezPointer", "3"});
  EXPECT_EQ(table.markdown(),
            "| name      |  mm |\n"
            "|-----------|----:|\n"
            "| ezPointer |   3 |\n");
  EXPECT_EQ(table.csv(), "name,mm\nezPointer,3\n");
}

TEST(Table, FieldsWithCommasAreQuotedInCsv) {
  Table table({"name", "mm"});
  table.add({"filter, pooled", "3"});
  table.add({"2\" lens", "4"});
  EXPECT_EQ(table.csv(), "name,mm\n\"filter, pooled\",3\n\"2\"\" lens\",4\n");
}

TEST(Table, RefusesARowOfAnotherLength) {
  Table table({"a", "b"});
  EXPECT_THROW(table.add({"1"}), std::logic_error);
}

}  // namespace
}  // namespace dtof
