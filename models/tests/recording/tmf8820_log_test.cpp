// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/tmf8820_log.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

constexpr std::size_t kLines = 30;

std::string line(std::size_t index, unsigned first_bin, unsigned other_bins = 0) {
  std::string text = fmt::format("#Raw,65,{},{}", index, first_bin);
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

void refused(const std::string& text, const std::string& reason) {
  test::expect_input_error([&] { (void)parse_tmf8820_log("a.log", text); }, "a.log:" + reason);
}

TEST(Tmf8820Log, BytesOfAChannelAreAdded) {
  const Tmf8820Log log =
      parse_tmf8820_log("a.log", "TMF8820 Arduino\r\n" + capture(0) + "#Obj,65,1,27\n" + capture(100));
  ASSERT_EQ(log.captures.size(), 2U);
  EXPECT_EQ(log.incomplete, 0U);
  EXPECT_TRUE(std::isnan(log.captures[0].distance));
  EXPECT_EQ(log.captures[0].reference[0], 0U + 10U * 256U + 20U * 65536U);
  EXPECT_EQ(log.captures[0].histograms[0][0], 1U + 11U * 256U + 21U * 65536U);
  EXPECT_EQ(log.captures[0].histograms[8][0], 9U + 19U * 256U + 29U * 65536U);
  EXPECT_EQ(log.captures[0].histograms[8][127], 1U);
  EXPECT_EQ(log.captures[1].histograms[2][0], 103U + 113U * 256U + 123U * 65536U);
}

TEST(Tmf8820Log, CapturesThatLackLinesAreLeftOutAndCounted) {
  // The recording begins and ends in a capture, and a line is lost of the one in the middle.
  const std::string text = capture(0, 17) + capture(1) + capture(2, 0, 12) + capture(2, 13) + capture(3) +
                           capture(4, 0, 5) + "#Raw,65,5,1,2";
  const Tmf8820Log log = parse_tmf8820_log("a.log", text);
  EXPECT_EQ(log.incomplete, 3U);
  ASSERT_EQ(log.captures.size(), 2U);
  EXPECT_EQ(log.captures[0].histograms[0][0], 2U + 12U * 256U + 22U * 65536U);
  EXPECT_EQ(log.captures[1].histograms[0][0], 4U + 14U * 256U + 24U * 65536U);
}

TEST(Tmf8820Log, IsToldByALineOfAHistogram) {
  EXPECT_TRUE(is_tmf8820_log("#Raw,65,0,1"));
  EXPECT_TRUE(is_tmf8820_log("\xEF\xBB\xBF#Raw,65,0,1"));
  EXPECT_TRUE(is_tmf8820_log("hello\r\n#Raw,65,0,1"));
  EXPECT_FALSE(is_tmf8820_log("[{}]"));
  EXPECT_FALSE(is_tmf8820_log("a #Raw,65"));
}

TEST(Tmf8820Log, Refusals) {
  refused(" \n", " no whole capture: one has 30 lines \"#Raw\"");
  refused(capture(0, 0, 29), " no whole capture: one has 30 lines \"#Raw\"");
  refused("#Raw,65,0,1,2\n" + capture(0), "1: 5 fields instead of 131 (#Raw, address, index and 128 bins)");
  refused(capture(0) + line(30, 0) + "\n", "31: \"30\" is no integer from 0 to 29");
  std::string broken = capture(0);
  broken.replace(broken.find(",1,1,1"), 6, ",1,x,1");
  refused(broken, "1: \"x\" is no integer from 0 to 65535");
}

}  // namespace
}  // namespace dtof
