// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/tmf882x_log.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "dtof/recording/tmf8820_json.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::Each;
using ::testing::IsNan;

constexpr std::size_t kLines = 30;

std::string line(std::size_t index, unsigned first_bin, unsigned other_bins = 0,
                 std::string_view begin = "#Raw") {
  std::string text = fmt::format("{},65,{},{}", begin, index, first_bin);
  for (std::size_t bin = 1; bin < kTmf8820Bins; ++bin) {
    text += fmt::format(",{}", other_bins);
  }
  return text + "\n";
}

/// Line `index` has index + `more` in bin 0.
std::string capture(unsigned more, std::size_t begin = 0, std::size_t end = kLines) {
  std::string text;
  for (std::size_t index = begin; index < end; ++index) {
    text += line(index, static_cast<unsigned>(index) + more, index < 10 ? 1 : 0);
  }
  return text;
}

/// A capture with `first` + the zone's number 0 to 7 in bin 0 of zones 0 to 7, and `last` in zone 8.
std::string zones(unsigned first, unsigned last = 0) {
  std::string text;
  for (std::size_t index = 0; index < kLines; ++index) {
    const bool zone = index >= 1 && index <= 8;
    text += line(index, zone ? first + static_cast<unsigned>(index) - 1 : index == 9 ? last : 0);
  }
  return text;
}

/// A result whose first objects are at `first` + i mm.
std::string result(unsigned number, unsigned first = 0) {
  std::string text = fmt::format("#Obj,65,{},22,2,15030003", number);
  for (unsigned i = 0; i < 36; ++i) {
    text += fmt::format(",{},{}", first == 0 ? 0 : first + i, 50);
  }
  return text + "\n";
}

struct Read {
  HistogramCube cube;
  std::string description;
};

Read read(const std::string& text, const Tmf882xOptions& options = {}) {
  LineReader lines("a.log", text);
  Read read;
  read.cube = read_tmf882x_log(lines, options, read.description);
  return read;
}

void refused(const std::string& text, const std::string& reason, const Tmf882xOptions& options = {}) {
  test::expect_input_error([&] { (void)read(text, options); }, "a.log:" + reason);
}

TEST(Tmf882xLog, BytesOfAChannelAreAdded) {
  const auto [cube, description] = read("TMF8820 Arduino\r\n" + capture(0) + "#Obj,65,1,27\n" + capture(100));
  EXPECT_EQ(description, "ams TMF8820, 2 captures of 9 zones");
  ASSERT_EQ(cube.columns, 2);
  ASSERT_EQ(cube.rows, 9);
  EXPECT_EQ(cube.bin_width, kTmf8820BinWidth);
  EXPECT_THAT(cube.true_distance, Each(IsNan()));
  EXPECT_EQ(cube.pixel(0, 0)[0], 1U + 11U * 256U + 21U * 65536U);
  EXPECT_EQ(cube.pixel(0, 8)[0], 9U + 19U * 256U + 29U * 65536U);
  EXPECT_EQ(cube.pixel(0, 8)[127], 1U);
  EXPECT_EQ(cube.pixel(1, 2)[0], 103U + 113U * 256U + 123U * 65536U);
}

TEST(Tmf882xLog, CapturesThatLackLinesAreLeftOutAndCounted) {
  // The recording begins and ends in a capture, and a line is lost of the one in the middle.
  const std::string text = capture(0, 17) + capture(1) + capture(2, 0, 12) + capture(2, 13) + capture(3) +
                           capture(4, 0, 5) + "#Raw,65,5,1,2";
  const auto [cube, description] = read(text);
  EXPECT_EQ(description, "ams TMF8820, 2 captures of 9 zones, 3 incomplete left out");
  ASSERT_EQ(cube.columns, 2);
  EXPECT_EQ(cube.pixel(0, 0)[0], 2U + 12U * 256U + 22U * 65536U);
  EXPECT_EQ(cube.pixel(1, 0)[0], 4U + 14U * 256U + 24U * 65536U);
}

TEST(Tmf882xLog, AResultHasTheDistancesOfTheCaptureBeforeIt) {
  const auto [cube, description] =
      read(capture(0) + result(0, 500) + capture(1) + result(1) + capture(2) + result(2, 800).substr(0, 60));
  EXPECT_EQ(description, "ams TMF8820, 3 captures of 9 zones");
  EXPECT_DOUBLE_EQ(cube.true_distance[0], 0.5);
  EXPECT_DOUBLE_EQ(cube.true_distance[3 * 8], 0.508);
  EXPECT_THAT(cube.true_distance[1], IsNan());  // 0 is no object
  EXPECT_THAT(cube.true_distance[2], IsNan());  // the recording ended in this line
}

TEST(Tmf882xLog, CalibrationsAndSumsAreIgnored) {
  std::string calibration;
  for (std::size_t index = 0; index < kLines; ++index) {
    calibration += line(index, 9, 9, "#Cal");
  }
  const auto [cube, description] =
      read("sep=,\n" + calibration + capture(0) + "#RCo0,1,2\n#CCo0,1\n#Err,1\n" + result(0));
  EXPECT_EQ(cube.columns, 1);
  EXPECT_EQ(cube.pixel(0, 0)[127], 1U);
}

TEST(Tmf882xLog, TwoCapturesOfAResultAreOneColumn) {
  const std::string text = "#Conf,Period=100ms,KIter=900 SPAD=7 Pers=0\n" + zones(1) + zones(11) +
                           result(7, 1000) + zones(21) + result(8, 2000) + zones(31) + zones(41) + result(9);
  const auto [cube, description] = read(text, {.bin_width_s = 2.6e-10});
  EXPECT_EQ(description, "ams TMF8821, 2 captures of 16 zones, 1 incomplete left out");
  ASSERT_EQ(cube.rows, 16);
  ASSERT_EQ(cube.columns, 2);
  EXPECT_EQ(cube.bin_width, 2.6e-10);
  EXPECT_EQ(cube.pixel(0, 0)[0], 1);
  EXPECT_EQ(cube.pixel(0, 7)[0], 8);
  EXPECT_EQ(cube.pixel(0, 8)[0], 11);
  EXPECT_EQ(cube.pixel(1, 15)[0], 48);
  EXPECT_DOUBLE_EQ(cube.true_distance[2 * 7], 1.007);
  EXPECT_DOUBLE_EQ(cube.true_distance[2 * 8], 1.009);  // the second capture's begin after nine zones
  EXPECT_THAT(cube.true_distance[1], IsNan());
  // A last channel that is not empty: 3 x 6.
  const Read more = read(text + zones(1, 5) + zones(2) + result(10), {.bin_width_s = 2.6e-10});
  EXPECT_EQ(more.description, "ams TMF8821, 3 captures of 18 zones, 1 incomplete left out");
  EXPECT_EQ(more.cube.pixel(2, 8)[0], 5);
  EXPECT_EQ(more.cube.pixel(2, 9)[0], 2);
}

/// Four results of two captures: zone z of capture i has 1 + 10 i + z.
std::string frame(unsigned number) {
  std::string text;
  for (unsigned quarter = 0; quarter < 4; ++quarter) {
    text +=
        zones(1 + 20 * quarter) + zones(11 + 20 * quarter) + result(number + quarter, 1000 + 100 * quarter);
  }
  return text;
}

TEST(Tmf882xLog, FourResultsAreAFrameOfEightByEight) {
  const std::string configuration = "#Conf,Period=132ms,KIter=250 SPAD=15 Pers=0\n";
  const auto [cube, description] = read(configuration + frame(252) + frame(0), {.bin_width_s = 3e-10});
  EXPECT_EQ(description, "ams-OSRAM TMF8828, 2 frames of 8 x 8 zones");
  ASSERT_EQ(cube.rows, 8);
  ASSERT_EQ(cube.columns, 16);
  // The first capture: rows 7, 5, 3, 1 of columns 0 and 4.
  EXPECT_EQ(cube.pixel(0, 7)[0], 1);
  EXPECT_EQ(cube.pixel(4, 7)[0], 2);
  EXPECT_EQ(cube.pixel(0, 5)[0], 3);
  EXPECT_EQ(cube.pixel(4, 1)[0], 8);
  EXPECT_EQ(cube.pixel(1, 7)[0], 11);   // the second capture
  EXPECT_EQ(cube.pixel(2, 7)[0], 21);   // the second result
  EXPECT_EQ(cube.pixel(0, 6)[0], 41);   // the third one
  EXPECT_EQ(cube.pixel(7, 0)[0], 78);   // the last zone of all
  EXPECT_EQ(cube.pixel(15, 0)[0], 78);  // the second frame
  EXPECT_DOUBLE_EQ(cube.true_distance[7 * 16], 1.0);
  EXPECT_DOUBLE_EQ(cube.true_distance[7 * 16 + 1], 1.009);
  EXPECT_DOUBLE_EQ(cube.true_distance[6 * 16 + 8], 1.2);
}

TEST(Tmf882xLog, FramesWithoutAllQuartersAreLeftOut) {
  const std::string cut = zones(1) + zones(2) + result(6) + zones(1) + zones(2) + result(7);
  const std::string broken = zones(1) + zones(2) + result(12) + zones(1) + result(13) + zones(1) + zones(2) +
                             result(14) + zones(1) + zones(2) + result(15);
  const std::string jump = zones(1) + zones(2) + result(16) + zones(1) + zones(2) + result(21);
  const Read read_frames = read(cut + frame(8) + broken + jump + zones(3),
                                {.mode = Tmf882xMode::kEightByEight, .bin_width_s = 3e-10});
  EXPECT_EQ(read_frames.description, "ams-OSRAM TMF8828, 1 frames of 8 x 8 zones, 5 incomplete left out");
}

TEST(Tmf882xLog, IsRecognisedByItsLines) {
  EXPECT_TRUE(is_tmf882x_log("#Raw,65,0,1"));
  EXPECT_TRUE(is_tmf882x_log("\xEF\xBB\xBF#Raw,65,0,1"));
  EXPECT_TRUE(is_tmf882x_log("hello\r\n#Cal,65,0,1"));
  EXPECT_TRUE(is_tmf882x_log("hello\n#Obj,65,0,1"));
  EXPECT_FALSE(is_tmf882x_log("[{}]"));
  EXPECT_FALSE(is_tmf882x_log("a #Raw,65"));
}

TEST(Tmf882xLog, Refusals) {
  refused(" \n", " no whole capture: one has 30 lines \"#Raw\"");
  refused(capture(0, 0, 29), " no whole capture: one has 30 lines \"#Raw\"");
  refused(result(0), " no whole capture: one has 30 lines \"#Raw\"");
  refused("#Raw,65,0,1,2\n" + capture(0), "1: 5 fields instead of 131 (#Raw, address, index and 128 bins)");
  refused(capture(0) + line(30, 0) + "\n", "31: \"30\" is no integer from 0 to 29");
  std::string broken = capture(0);
  broken.replace(broken.find(",1,1,1"), 6, ",1,x,1");
  refused(broken, "1: \"x\" is no integer from 0 to 65535");
  refused(capture(0) + "#Obj,65\n", "31: 2 fields: a line \"#Obj\" has an address and a result number");
  refused(capture(0) + "#Obj,65,256,1\n", "31: \"256\" is no integer from 0 to 255");
  std::string far = result(0, 100);
  far.replace(far.find(",103,"), 5, ",-3,");
  refused(capture(0) + far, "31: \"-3\" is no integer from 0 to 65535");
  refused("#Conf,KIter=9 SPAD=x Pers=0\n" + capture(0), "1: \"x\" is no integer from 0 to 255");
  refused("#Conf, SPAD=7\n" + capture(0) + "#Conf, SPAD=15\n",
          "32: SPAD map 15 after captures with map 7: a recording has one map");
}

TEST(Tmf882xLog, TheModeAndTheBinWidthAreNotGuessed) {
  const std::string pair = zones(1) + zones(2) + result(0);
  refused(
      pair,
      " two captures before each line \"#Obj\" and no \"SPAD=\" in a line \"#Conf\": 4 x 4 or 3 x 6 zones "
      "(--format tmf8821), or 8 x 8 (--format tmf8828)?");
  refused("#Conf SPAD=7\n" + pair,
          " a log of more than 9 zones does not say how wide its bins are; give --bin-width");
  refused(zones(1) + result(0), " no whole result: two captures, then a line \"#Obj\"",
          {.mode = Tmf882xMode::kTwoCaptures, .bin_width_s = 1e-10});
  refused(pair, " no whole frame: four results of two captures, with consecutive numbers",
          {.mode = Tmf882xMode::kEightByEight, .bin_width_s = 1e-10});
}

}  // namespace
}  // namespace dtof
