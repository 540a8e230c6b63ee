// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/stream_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "dtof/core/random.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/recording/recording.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::string_view kHeader = "acquisition,column,row,timestamp\n";

class StreamCsvTest : public test::IoTest {
 protected:
  RecordedStream read(const std::string& lines, const StreamCsvOptions& options = {}) {
    return read_stream_csv(write("stream.csv", std::string(kHeader) + lines), options);
  }
  void refused(const std::string& lines, const std::string& reason, const StreamCsvOptions& options = {}) {
    SCOPED_TRACE(lines);
    test::expect_input_error([&] { (void)read(lines, options); }, path("stream.csv").string() + ":" + reason);
  }
};

TEST_F(StreamCsvTest, SortsByPixelAndAcquisitionAndKeepsSlotOrder) {
  const RecordedStream stream = read("5,1,0,30\n2,0,1,7\n5,1,0,20\n0,1,0,1022\n2,0,1,6\n");
  EXPECT_EQ(stream.columns(), 2);
  EXPECT_EQ(stream.rows(), 2);
  EXPECT_EQ(stream.acquisitions(), 6U);
  EXPECT_EQ(stream.detection_count(), 5U);
  EXPECT_THAT(stream.column(0).row(0), IsEmpty());
  EXPECT_THAT(stream.column(0).row(1), ElementsAre(Detection{2, 7}, Detection{2, 6}));
  EXPECT_THAT(stream.column(1).row(0), ElementsAre(Detection{0, 1022}, Detection{5, 30}, Detection{5, 20}));
  EXPECT_THAT(stream.column(1).row(1), IsEmpty());
}

// The lines up to the first one out of order are taken as they come; those after it belong to pixels before
// and behind.
TEST_F(StreamCsvTest, LinesOutOfOrderJoinThoseInOrder) {
  const RecordedStream stream =
      read("0,0,0,1\n0,0,0,2\n3,0,0,3\n0,0,2,4\n1,2,1,5\n1,2,1,6\n2,0,0,7\n4,2,1,8\n0,1,0,9\n");
  EXPECT_EQ(stream.columns(), 3);
  EXPECT_EQ(stream.rows(), 3);
  EXPECT_EQ(stream.detection_count(), 9U);
  EXPECT_THAT(stream.column(0).row(0),
              ElementsAre(Detection{0, 1}, Detection{0, 2}, Detection{2, 7}, Detection{3, 3}));
  EXPECT_THAT(stream.column(0).row(1), IsEmpty());
  EXPECT_THAT(stream.column(0).row(2), ElementsAre(Detection{0, 4}));
  EXPECT_THAT(stream.column(1).row(0), ElementsAre(Detection{0, 9}));
  EXPECT_THAT(stream.column(2).row(1), ElementsAre(Detection{1, 5}, Detection{1, 6}, Detection{4, 8}));
  refused("0,0,0,1\n0,0,0,2\n1,1,0,1\n0,0,0,3\n",
          "5: more than 2 timestamps for acquisition 0, column 0, row 0 (SLOTS = 2)");
}

TEST_F(StreamCsvTest, EachPixelHasItsOwnSlots) {
  EXPECT_EQ(read("5,0,0,1\n5,0,1,2\n5,0,2,3\n5,1,2,4\n").detection_count(), 4U);
}

TEST_F(StreamCsvTest, ColumnsAndRowsWithoutEventsAreThere) {
  const RecordedStream stream = read("0,2,1,5\n0,4,3,-1\n");
  EXPECT_EQ(stream.columns(), 5);
  EXPECT_EQ(stream.rows(), 4);
  for (int column = 0; column < 5; ++column) {
    EXPECT_EQ(stream.column(column).rows(), 4);
    EXPECT_EQ(stream.column(column).detection_count(), column == 2 ? 1U : 0U);
  }
  EXPECT_THAT(stream.column(2).row(1), ElementsAre(Detection{0, 5}));
}

// Lines of 64 KiB, most of it blanks, have 64 MiB together.
TEST_F(StreamCsvTest, HoldsEventsAndNoText) {
  constexpr std::size_t kLine = std::size_t{1} << 16U;
  std::string text(kHeader);
  for (int line = 0; line < 1024; ++line) {
    text += fmt::format("{},0,0,5{}\n", line, std::string(kLine, ' '));
  }
  for (const char* name : {"long.csv", "long.csv.gz"}) {
    SCOPED_TRACE(name);
    if (std::string_view(name).ends_with("gz")) {
      write_gzip_file(path(name), text);
    } else {
      write_file(path(name), text);
    }
    const RecordingFile file = read_recording({.file = path(name)});
    EXPECT_EQ(file.format, "csv");
    EXPECT_EQ(file.contents, "");
    const RecordedData data = open_recorded_data({.file = path(name)}, file);
    EXPECT_EQ(std::get<RecordedStream>(data.data).detection_count(), 1024U);
  }
}

TEST_F(StreamCsvTest, AcceptsGivenSizesCrLfAndAMissingLastNewline) {
  const StreamCsvOptions options{.columns = 3, .rows = 4, .acquisitions = 10};
  const RecordedStream stream = read("1,0,0,5\r\n2,0,0,6", options);
  EXPECT_EQ(stream.columns(), 3);
  EXPECT_EQ(stream.rows(), 4);
  EXPECT_EQ(stream.acquisitions(), 10U);
  EXPECT_THAT(stream.column(0).row(0), ElementsAre(Detection{1, 5}, Detection{2, 6}));
  EXPECT_EQ(stream.column(2).rows(), 4);
  EXPECT_EQ(read("", options).detection_count(), 0U);
}

TEST_F(StreamCsvTest, ReadsTheTextThatOthersWrite) {
  const auto read_text = [&](const std::string& text) {
    const RecordedStream stream = read_stream_csv(write("stream.csv", text), {});
    EXPECT_EQ(stream.columns(), 2);
    EXPECT_EQ(stream.rows(), 2);
    EXPECT_EQ(stream.acquisitions(), 6U);
    EXPECT_EQ(stream.detection_count(), 3U);
    EXPECT_THAT(stream.column(0).row(1), ElementsAre(Detection{2, 7}));
    EXPECT_THAT(stream.column(1).row(0), ElementsAre(Detection{5, 30}, Detection{5, 1000}));
  };
  const std::string header(kHeader);
  for (const std::string& text :
       {header + "5,1,0,30\n2,0,1,7\n5,1,0,1000\n\n",
        header + "5,1,0,30\r\n2,0,1,7\r\n5,1,0,1000\r\n\r\n \r\n",
        "\"acquisition\",\"column\",\"row\",\"timestamp\"\n" +
            std::string("5,1,0,30\n2,0,1,\"7\"\n\"5\",1,0,1000\n"),
        "acquisition, column, row, timestamp\n" + std::string("5, 1, 0, 30\n2 ,0,1,7\n5,1,\t0,1000 \n"),
        "acquisition;column;row;timestamp\n" + std::string("5;1;0;30\n2;0;1;7,0\n5;1;0;1000.0\n"),
        header + "5.0,1.0,0.0,30.\n2,0,1,7.000\n5,1,0,1000\n",
        "\xEF\xBB\xBF" + header + "5,1,0,30\n2,0,1,7\n5,1,0,1000\n"}) {
    SCOPED_TRACE(text);
    read_text(text);
  }
}

TEST_F(StreamCsvTest, MinusOneIsNoEventButCountsForTheSizes) {
  const RecordedStream stream = read("0,0,0,5\n3,0,0,-1\n1,2,0,-1.0\n1,0,1, -1\n1,0,0,6\n");
  EXPECT_EQ(stream.columns(), 3);
  EXPECT_EQ(stream.rows(), 2);
  EXPECT_EQ(stream.acquisitions(), 4U);
  EXPECT_EQ(stream.detection_count(), 2U);
  EXPECT_THAT(stream.column(0).row(0), ElementsAre(Detection{0, 5}, Detection{1, 6}));
  EXPECT_EQ(read("1,1,1,-1\n").detection_count(), 0U);
  refused("1,0,0,5\n1,2,0,-1\n", "3: column 2 is outside 0..1 (columns: 2)", {.columns = 2});
}

TEST_F(StreamCsvTest, GzipIsUnpacked) {
  write_gzip_file(path("s.csv.gz"), fmt::format("{}5,1,0,30\n", kHeader));
  EXPECT_THAT(read_stream_csv(path("s.csv.gz"), {}).column(1).row(0), ElementsAre(Detection{5, 30}));
}

TEST_F(StreamCsvTest, RefusesMalformedLines) {
  refused("1,0,0,5\n1,0,0\n", "3: 3 fields instead of 4 (acquisition,column,row,timestamp)");
  refused("1,0,0,5,6\n", "2: 5 fields instead of 4 (acquisition,column,row,timestamp)");
  refused("1,0,0,5,\n", "2: 5 fields instead of 4 (acquisition,column,row,timestamp)");
  refused("1,0,0,\n", "2: timestamp \"\" is not a decimal integer");
  refused("1,0,0x1,5\n", "2: row \"0x1\" is not a decimal integer");
  refused("1,-1,0,5\n", "2: column \"-1\" is not a decimal integer");
  refused("1,0,0,+5\n", "2: timestamp \"+5\" is not a decimal integer");
  refused("1,0,0 0,5\n", "2: row \"0 0\" is not a decimal integer");
  refused("1,0,0,5.5\n", "2: timestamp \"5.5\" is not a decimal integer");
  refused("1,0,0,5.05\n", "2: timestamp \"5.05\" is not a decimal integer");
  refused("1,0,0,.0\n", "2: timestamp \".0\" is not a decimal integer");
  refused("1,0,0,1e2\n", "2: timestamp \"1e2\" is not a decimal integer");
  refused("1,0,0,-2\n", "2: timestamp \"-2\" is not a decimal integer");
  refused("1,0,0,-0\n", "2: timestamp \"-0\" is not a decimal integer");
  refused("-1,0,0,5\n", "2: acquisition \"-1\" is not a decimal integer");
  refused("1,0,0,\"5\n", "2: timestamp \"\"5\" is not a decimal integer");
  refused("1;0;0;5\n", "2: 1 fields instead of 4 (acquisition,column,row,timestamp)");
  refused("1,0,0,18446744073709551615\n", "2: timestamp \"18446744073709551615\" is too large");
  refused("1,0,0,nan\n", "2: timestamp \"nan\" is not a decimal integer");
  refused("1,0,0,5\n\n1,0,0,6\n", "3: empty line");
  refused("1,0,0,5\n \n\n1,0,0,6\n\n", "3: empty line");
  refused("99999999999999999999999,0,0,5\n", "2: acquisition \"99999999999999999999999\" is too large");
  refused("1,0,0,5\n1,0,", "3: 3 fields instead of 4 (acquisition,column,row,timestamp)");
}

TEST_F(StreamCsvTest, RefusesValuesOutsideTheirRange) {
  refused("1,0,0,1024\n", "2: timestamp 1024 is outside 0..1023 (NP = 10)");
  refused("1,0,0,16\n", "2: timestamp 16 is outside 0..15 (NP = 4)", {.np = 4});
  const StreamCsvOptions given{.columns = 2, .rows = 3, .acquisitions = 4};
  refused("3,1,2,0\n4,0,0,0\n", "3: acquisition 4 is outside 0..3 (acquisitions: 4)", given);
  refused("0,2,0,0\n", "2: column 2 is outside 0..1 (columns: 2)", given);
  refused("0,0,3,0\n", "2: row 3 is outside 0..2 (rows: 3)", given);
  refused("0,65536,0,0\n", "2: column 65536 is outside 0..65535 (largest array: 65536)");
  refused("4294967295,0,0,0\n",
          "2: acquisition 4294967295 is outside 0..4294967294 (largest frame: 4294967295)");
  refused("0,65535,65535,0\n", " 65536 x 65536 pixels are more than 16777216");
  refused("0,0,0,0\n", "2: acquisition 0 is outside acquisitions: 0", {.acquisitions = 0});
}

TEST_F(StreamCsvTest, RefusesTooManySlotsAtTheFirstLineTooMany) {
  refused("7,1,0,5\n3,0,1,1\n3,0,1,2\n7,1,0,6\n3,0,1,3\n7,1,0,7\n",
          "6: more than 2 timestamps for acquisition 3, column 0, row 1 (SLOTS = 2)");
  // Acquisitions of one pixel out of order: acquisition 9 is full first, and comes again later.
  refused("9,0,0,1\n9,0,0,2\n3,0,0,1\n3,0,0,2\n9,0,0,2\n",
          "3: more than 1 timestamps for acquisition 9, column 0, row 0 (SLOTS = 1)", {.slots = 1});
  EXPECT_EQ(read("3,0,1,1\n3,0,1,2\n3,0,1,3\n", {.slots = 3}).detection_count(), 3U);
}

TEST_F(StreamCsvTest, RefusesFilesThatAreNoStream) {
  test::expect_input_error([&] { (void)read_stream_csv(path("none.csv"), {}); },
                           path("none.csv").string() + ": cannot read: No such file or directory");
  test::expect_input_error([&] { (void)read_stream_csv(write("e.csv", ""), {}); },
                           EndsWith("the file is empty"));
  const std::string reason = ":1: the header must be \"acquisition,column,row,timestamp\"";
  test::expect_input_error([&] { (void)read_stream_csv(write("h.csv", "1,0,0,5\n"), {}); }, EndsWith(reason));
  test::expect_input_error([&] { (void)read_stream_csv(write("h.csv", "\n"), {}); }, EndsWith(reason));
  test::expect_input_error(
      [&] { (void)read_stream_csv(write("h.csv", "acquisition,column,row\n1,0,0\n"), {}); },
      EndsWith(reason));
  test::expect_input_error([&] { (void)read(""); },
                           HasSubstr("no detections: columns, rows and acquisitions cannot be found and must "
                                     "be given"));
  test::expect_input_error([&] { (void)read("0,0,0,0\n", {.columns = 0}); },
                           "recorded stream: columns is 0, must be 1..65536");
  test::expect_input_error([&] { (void)read("0,0,0,0\n", {.np = 17}); },
                           "recorded stream: NP is 17, must be 1..16");
}

TEST_F(StreamCsvTest, RandomStreamSurvivesTheRoundTripAndShufflingOfPixels) {
  const std::uint64_t seed = test::test_seed();
  SCOPED_TRACE(fmt::format("DTOF_TEST_SEED={}", seed));
  CounterRandom random(seed, static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0);
  constexpr int kColumns = 5;
  constexpr int kRows = 7;
  constexpr std::uint32_t kAcquisitions = 40;
  std::vector<ColumnStream> columns(kColumns);
  for (ColumnStream& column : columns) {
    for (int row = 0; row < kRows; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < kAcquisitions; ++acquisition) {
        for (std::uint32_t slot = random() % 4; slot > 0; --slot) {
          column.append({acquisition, static_cast<Timestamp>(random() % 4095)});
        }
      }
      column.finish_row();
    }
  }
  const StreamCsvOptions options{
      .np = 12, .slots = 3, .columns = kColumns, .rows = kRows, .acquisitions = kAcquisitions};
  const RecordedStream original(columns, kRows, kAcquisitions);
  write_stream_csv(path("a.csv"), original);
  const RecordedStream back = read_stream_csv(path("a.csv"), options);
  ASSERT_EQ(back.columns(), kColumns);
  for (int column = 0; column < kColumns; ++column) {
    EXPECT_EQ(back.column(column), original.column(column));
  }

  // Whatever way the lines of different (acquisition, pixel) groups are mixed, the stream is the same.
  std::string text = contents(path("a.csv")).substr(kHeader.size());
  std::vector<std::pair<std::uint32_t, std::string>> lines;
  std::string previous_group;
  std::uint32_t key = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n') + 1;
    const std::string line = text.substr(0, end);
    const std::string group = line.substr(0, line.rfind(','));
    key = group == previous_group ? key : random();
    previous_group = group;
    lines.emplace_back(key, line);
    text.erase(0, end);
  }
  std::ranges::stable_sort(lines, {}, &std::pair<std::uint32_t, std::string>::first);
  std::string shuffled;
  for (const auto& [ignored, line] : lines) {
    shuffled += line;
  }
  const RecordedStream mixed = read(shuffled, options);
  for (int column = 0; column < kColumns; ++column) {
    EXPECT_EQ(mixed.column(column), original.column(column));
  }
}

TEST_F(StreamCsvTest, ATimestampOfAllOnesIsNoDetection) {
  const RecordedStream stream = read("0,0,0,1023\n1,0,0,7\n1,0,0,1023\n1,0,0,8\n9,2,3,1023\n0,1,1,-1\n");
  EXPECT_EQ(stream.columns(), 3);
  EXPECT_EQ(stream.rows(), 4);
  EXPECT_EQ(stream.acquisitions(), 10U);
  EXPECT_EQ(stream.detection_count(), 2U);
  EXPECT_THAT(stream.column(0).row(0), ElementsAre(Detection{1, 7}, Detection{1, 8}));
  EXPECT_EQ(read("0,0,0,255\n", {.np = 8}).detection_count(), 0U);
  EXPECT_EQ(read("0,0,0,255\n", {.np = 9}).detection_count(), 1U);
}

TEST_F(StreamCsvTest, ANameThatEndsWithGzIsPacked) {
  const RecordedStream stream = read("0,0,0,1\n0,0,1,2\n5,1,0,3\n");
  write_stream_csv(path("a.csv"), stream);
  for (const char* name : {"a.csv.gz", "a.CSV.GZ"}) {
    write_stream_csv(path(name), stream);
    EXPECT_EQ(contents(path(name)).substr(0, 2), "\x1f\x8b");
    EXPECT_EQ(read_file_or_gzip(path(name)), contents(path("a.csv")));
  }
  EXPECT_EQ(read_stream_csv(path("a.csv.gz"), {}).column(1), stream.column(1));
  write_stream_csv(path("b.csv.gz"), stream);
  EXPECT_EQ(contents(path("a.csv.gz")), contents(path("b.csv.gz")));
}

TEST_F(StreamCsvTest, UnwritableOutputLeavesNothing) {
  const RecordedStream stream = read("0,0,0,1\n");
  test::expect_input_error([&] { write_stream_csv(path("none/a.csv"), stream); },
                           EndsWith("cannot write: No such file or directory"));
  EXPECT_EQ(file_count(), 1U);
}

}  // namespace
}  // namespace dtof
