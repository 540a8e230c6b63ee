// SPDX-License-Identifier: Apache-2.0
// Regions of interest, as a user asks for them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <span>
#include <sstream>
#include <string>

#include "dtof/core/parameters.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/io/input_file.hpp"
#include "tests/command_line/programs.hpp"

namespace dtof {
namespace {

using test::kSmallScene;
using test::Outcome;
using test::Programs;

using ::testing::HasSubstr;

/// A result file without the lines of other rows than first to last.
std::string rows_of_csv(const std::string& csv, int first, int last) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  std::string chosen = line + "\n";
  while (std::getline(lines, line)) {
    const int row = std::stoi(line.substr(line.find(',') + 1));
    if (row >= first && row <= last) {
      chosen += line + "\n";
    }
  }
  return chosen;
}

TEST_F(Programs, ARegionOfInterestIsThatPartOfTheWholeFrame) {
  const std::string frame = fmt::format("frame -r fifh,hispointer {} ", kSmallScene);
  for (const char* sensor : {"", "--fidelity fast", "--binning 2 --coincidence 2"}) {
    SCOPED_TRACE(sensor);
    ASSERT_EQ(dtof(frame + sensor + " --out whole").exit_code, 0);
    const Outcome outcome = dtof(frame + sensor + " --rows 1-3 --out part");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("6 x 3 pixels"));
    for (const char* csv : {"fifh.csv", "hispointer.csv"}) {
      EXPECT_EQ(read_file(path("part/") + csv), rows_of_csv(read_file(path("whole/") + csv), 1, 3)) << csv;
    }
    const DepthImage depth = read_depth_image(path("part/fifh_depth_mm.png"));
    const DepthImage whole = read_depth_image(path("whole/fifh_depth_mm.png"));
    ASSERT_EQ(depth.width, 6);
    ASSERT_EQ(depth.height, 3);
    EXPECT_THAT(depth.metres, ::testing::ElementsAreArray(std::span(whole.metres).subspan(6, 18)));
  }
  const Outcome rectangle = dtof(frame + "--columns 2-3 --rows 4 --out rectangle");
  EXPECT_THAT(rectangle.output, HasSubstr("2 x 1 pixels"));
  EXPECT_THAT(read_file(path("rectangle/fifh.csv")), HasSubstr("\n3,4,"));
}

TEST_F(Programs, ARegionsErrorsAreAgainstTheTruthOfItsOwnPixels) {
  // Every row has a distance of its own: with another row's truth the error would be metres.
  std::string pfm = "Pf\n1 4\n-1\n";
  for (const float metres : {4.0F, 3.0F, 2.0F, 1.0F}) {
    const auto bytes = std::bit_cast<std::array<char, sizeof metres>>(metres);
    pfm.append(bytes.data(), bytes.size());
  }
  const Outcome outcome = dtof("frame -r histogram --depth " + file("rows.pfm", pfm) +
                               " --array-columns 3 --array-rows 4 --fidelity analytic --rows 2-3 --out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(read_file(path("out/summary.csv")), HasSubstr("0.00 %,0.00 %"));
}

TEST_F(Programs, ARegionThroughTheRtlEqualsTheModelAndTheWholeFrame) {
  const std::string frame = "frame --scene plane --array-columns 3 --array-rows 40 --acquisitions 200 ";
  ASSERT_EQ(dtof(frame + "-r sifh,ezpointer --out whole").exit_code, 0);
  const Outcome outcome =
      dtof(frame + "-r sifh,ezpointer,poolpointer --rows 17-28 --engine rtl --verify --out part");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("3 x 12 pixels"));
  EXPECT_THAT(outcome.output, HasSubstr("every pixel equal to the model"));
  for (const char* csv : {"sifh.csv", "ezpointer.csv"}) {
    EXPECT_EQ(read_file(path("part/") + csv), rows_of_csv(read_file(path("whole/") + csv), 17, 28)) << csv;
  }
}

TEST_F(Programs, BothEnginesGiveTheSameFilesOnEverySensorAndRegion) {
  // Odd sizes, and regions that begin and end inside the pool read-outs' groups of 4 and 8 rows, so that
  // arrays, engines and groups are only partly used.
  int pooled = 0;
  for (const char* pixels :
       {"--array-columns 1 --array-rows 1", "--array-columns 3 --array-rows 40",
        "--array-columns 13 --array-rows 33 --columns 0-2,5,10-11", "--array-columns 2 --array-rows 159",
        "--array-columns 2 --array-rows 60 --rows 21-39", "--array-columns 2 --array-rows 160 --rows 40-59",
        "--array-columns 34 --array-rows 47 --rows 13-46 --columns 4,7-11"}) {
    SCOPED_TRACE(pixels);
    const std::string frame = fmt::format("frame -r all --acquisitions 400 {} ", pixels);
    const Outcome model = dtof(frame + "--engine model --out model");
    ASSERT_EQ(model.exit_code, 0) << model.output;
    const Outcome rtl = dtof(frame + "--engine rtl --out rtl");
    ASSERT_EQ(rtl.exit_code, 0) << rtl.output;
    for (const Readout readout : kRtlReadouts) {
      if (rtl.output.find(fmt::format("{} is left out", readout_title(readout))) != std::string::npos) {
        EXPECT_TRUE(is_pool_readout(readout));
        continue;
      }
      pooled += is_pool_readout(readout) ? 1 : 0;
      const std::string csv = fmt::format("/{}.csv", readout_name(readout));
      EXPECT_EQ(read_file(path("model") + csv), read_file(path("rtl") + csv)) << csv;
    }
  }
  EXPECT_EQ(pooled, 3) << "engines of 34 and of 3 columns";
}

TEST_F(Programs, BothEnginesReplayARegionToTheSameFiles) {
  ASSERT_EQ(
      dtof("frame -r ezpointer --array-columns 3 --array-rows 30 --acquisitions 400 --record stream.csv "
           "--out frame")
          .exit_code,
      0);
  for (const char* engine : {"model", "rtl"}) {
    const Outcome outcome = dtof(fmt::format(
        "replay stream.csv -r all --acquisitions 400 --rows 5-22 --columns 0,2 --engine {0} --out {0}",
        engine));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  }
  for (const Readout readout : kRtlReadouts) {
    const std::string csv = fmt::format("/{}.csv", readout_name(readout));
    EXPECT_EQ(read_file(path("model") + csv), read_file(path("rtl") + csv)) << csv;
  }
}

TEST_F(Programs, ARecordingIsReplayedInARegion) {
  const std::string frame = fmt::format("frame -r sifh {} --rows 2-3 ", kSmallScene);
  ASSERT_EQ(dtof(frame + "--record stream.csv --out frame").exit_code, 0);
  const Outcome outcome = dtof("replay stream.csv -r sifh --acquisitions 300 --rows 2-3 --out replay");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("6 columns x 2 rows"));
  EXPECT_EQ(read_file(path("replay/sifh.csv")), read_file(path("frame/sifh.csv")));
}

}  // namespace
}  // namespace dtof
