// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/line_reader.hpp"

#include <string>
#include <string_view>
#include <vector>

#include "dtof/io/atomic_file.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;

std::vector<std::string> lines_of(LineReader& reader) {
  std::vector<std::string> lines;
  std::string_view line;
  while (reader.next(line)) {
    lines.emplace_back(line);
  }
  return lines;
}

class LineReaderTest : public test::IoTest {};

TEST_F(LineReaderTest, LinesAreTheSameFromAFileFromGzipFromAPipeAndFromMemory) {
  const std::string text = "\xEF\xBB\xBFone\r\n\ntwo\nthree";
  write_gzip_file(path("a.gz"), text);
  const auto check = [](LineReader&& reader) {
    EXPECT_THAT(lines_of(reader), ElementsAre("one", "", "two", "three"));
    EXPECT_TRUE(reader.cut());
  };
  check(LineReader(write("a", text)));
  check(LineReader(path("a.gz")));
  check(LineReader(pipe_of(text)));
  check(LineReader("a", text));
  LineReader whole(write("b", "one\n"));
  EXPECT_THAT(lines_of(whole), ElementsAre("one"));
  EXPECT_FALSE(whole.cut());
  LineReader none("a", "");
  EXPECT_THAT(lines_of(none), ElementsAre());
}

TEST_F(LineReaderTest, LinesAreLongerThanAPiece) {
  const std::string longest(kLongestLine, 'x');
  LineReader reader(write("a", "first\n" + longest + "\n" + longest + "y\n"));
  std::string_view line;
  ASSERT_TRUE(reader.next(line));
  ASSERT_TRUE(reader.next(line));
  EXPECT_EQ(line, longest);
  test::expect_input_error([&] { (void)reader.next(line); },
                           EndsWith("a:3: the line is longer than 1048576 bytes"));
}

TEST_F(LineReaderTest, RefusalsNameFileAndLine) {
  test::expect_input_error([&] { LineReader reader(path("none")); },
                           EndsWith("none: cannot read: No such file or directory"));
  test::expect_input_error([&] { LineReader reader(path(".")); }, EndsWith("cannot read: it is a directory"));
  test::expect_input_error([&] { LineReader reader("/dev/null"); }, "/dev/null: cannot read: it is a device");
  test::expect_input_error([&] { LineReader reader(write("e", "")); }, EndsWith("e: the file is empty"));
  write_gzip_file(path("a.gz"), "one\ntwo\n");
  const std::string packed = contents(path("a.gz"));
  test::expect_input_error(
      [&] {
        LineReader reader(write("cut.gz", packed.substr(0, packed.size() - 6)));
        (void)lines_of(reader);
      },
      EndsWith("cut.gz: damaged gzip data: the file ends early"));
  test::expect_input_error(
      [&] {
        LineReader reader(write("rest.gz", packed + packed + "rest"));
        (void)lines_of(reader);
      },
      EndsWith("rest.gz: damaged gzip data: other bytes follow"));
  LineReader reader("a.log", "one\ntwo\n");
  (void)lines_of(reader);
  test::expect_input_error([&] { reader.fail("wrong"); }, "a.log:2: wrong");
}

}  // namespace
}  // namespace dtof
