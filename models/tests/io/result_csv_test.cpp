// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/result_csv.hpp"

#include <vector>

#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::EndsWith;

class ResultCsvTest : public test::IoTest {};

TEST_F(ResultCsvTest, RoundTrip) {
  const std::vector<ResultRecord> records = {{0, 0, {511, 3, 15}}, {199, 159, {65535, 0, 65535}}, {0, 1, {}}};
  write_result_csv(path("r.csv"), records);
  EXPECT_EQ(contents(path("r.csv")),
            "column,row,code,fraction,confidence\n0,0,511,3,15\n199,159,65535,0,65535\n0,1,0,0,0\n");
  EXPECT_EQ(read_result_csv(path("r.csv")), records);
}

TEST_F(ResultCsvTest, Refusals) {
  const std::string header = "column,row,code,fraction,confidence\n";
  test::expect_input_error(
      [&] { (void)read_result_csv(write("r.csv", header + "0,0,1,0,0\n0,0,65536,0,0\n")); },
      EndsWith("r.csv:3: code 65536 is outside 0..65535"));
  test::expect_input_error([&] { (void)read_result_csv(write("r.csv", header + "4294967296,0,1,0,0\n")); },
                           EndsWith("r.csv:2: column 4294967296 is outside 0..2147483647"));
  test::expect_input_error([&] { (void)read_result_csv(write("r.csv", header + "0,0,1\n")); },
                           EndsWith("r.csv:2: 3 fields instead of 5 (column,row,code,fraction,confidence)"));
  test::expect_input_error([&] { write_result_csv(path("none/r.csv"), {}); },
                           EndsWith("cannot write: No such file or directory"));
}

}  // namespace
}  // namespace dtof
