// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/csv_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class CsvTableTest : public ::testing::Test {
 public:
  CsvTableTest(const CsvTableTest&) = delete;
  CsvTableTest& operator=(const CsvTableTest&) = delete;
  CsvTableTest(CsvTableTest&&) = delete;
  CsvTableTest& operator=(CsvTableTest&&) = delete;

 protected:
  ~CsvTableTest() override { std::filesystem::remove(path_); }
  CsvTableTest() = default;

  [[nodiscard]] CsvTable table(const std::string& text) const {
    std::ofstream(path_) << text;
    return CsvTable(path_);
  }
  template <typename Use>
  [[nodiscard]] std::string refusal(const std::string& text, Use use) const {
    try {
      use(table(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path path_ = std::filesystem::path(::testing::TempDir()) / "table.csv";
};

TEST_F(CsvTableTest, ColumnsLinesAndAll) {
  const CsvTable numbers = table("pixel,a,b\r\n0,1.5,-2\r\n7,3e2,4\r\n");
  EXPECT_THAT(numbers.column("b"), ElementsAre(-2.0, 4.0));
  EXPECT_THAT(numbers.column("pixel"), ElementsAre(0.0, 7.0));
  EXPECT_THAT(numbers.texts("a"), ElementsAre("1.5", "3e2"));
  EXPECT_THAT(numbers.row("7"), ElementsAre(300.0, 4.0));
  EXPECT_THAT(numbers.rows(), ElementsAre(ElementsAre(1.5, -2.0), ElementsAre(300.0, 4.0)));
}

TEST_F(CsvTableTest, AByteOrderMarkIsNoPartOfTheFirstName) {
  EXPECT_THAT(table("\xEF\xBB\xBFpixel,a\n0,1.5\n").column("pixel"), ElementsAre(0.0));
}

TEST_F(CsvTableTest, LinesWithoutNumbersAreLeftOut) {
  EXPECT_THAT(table("p,a,b\n0,1,2\n1,,\n2,3,4\n").rows(),
              ElementsAre(ElementsAre(1.0, 2.0), ElementsAre(3.0, 4.0)));
}

TEST_F(CsvTableTest, RefusesWithTheLine) {
  const auto all = [](const CsvTable& t) { (void)t.rows(); };
  EXPECT_THAT(refusal("p,a\n0,1\n1\n", all), HasSubstr("table.csv:3: 1 fields, but the first line has 2"));
  EXPECT_THAT(refusal("p,a\n0,1\n1,x\n", all), HasSubstr("table.csv:3: 'x' is no number"));
  EXPECT_THAT(refusal("p,a,b\n0,1,2\n1,,3\n", all), HasSubstr("table.csv:3: '' is no number"));
  EXPECT_THAT(refusal("p,a\n", all), HasSubstr("a line of names"));
  EXPECT_THAT(refusal("p,a\n0,1\n", [](const CsvTable& t) { (void)t.column("c"); }),
              HasSubstr("no column is called 'c'"));
  EXPECT_THAT(refusal("p,a\n0,1\n", [](const CsvTable& t) { (void)t.row("5"); }),
              HasSubstr("no line begins with '5'"));
}

}  // namespace
}  // namespace dtof
