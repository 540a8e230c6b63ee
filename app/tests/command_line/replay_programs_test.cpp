// SPDX-License-Identifier: Apache-2.0
// `dtof replay` and `dtof-study measured`, as a user runs them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"
#include "tests/command_line/programs.hpp"

namespace dtof {
namespace {

using test::csv_cell;
using test::kSmallScene;
using test::Outcome;
using test::Programs;

using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Programs, ARecordedFrameReplaysToTheSameResult) {
  ASSERT_EQ(
      dtof(fmt::format("frame -r hispointer {} --record stream.csv --out frame", kSmallScene)).exit_code, 0);
  for (const char* engine : {"model", "rtl"}) {
    const Outcome outcome = dtof(
        fmt::format("replay stream.csv -r hispointer --acquisitions 300 --engine {} --out replay", engine));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_EQ(read_file(path("frame/hispointer.csv")), read_file(path("replay/hispointer.csv"))) << engine;
  }
}

TEST_F(Programs, ReplayAgainstATruthMap) {
  // A staircase of two steps, read out without noise: with the preset's zero, replay finds frame's own
  // errors.
  const std::string scene =
      "frame --scene staircase --steps 2 --near 1 --far 3 -r histogram --array-columns 4 --array-rows 3 "
      "--table none ";
  ASSERT_EQ(dtof(scene + "--record stream.csv --out frame").exit_code, 0);
  std::vector<float> truth;
  for (int row = 0; row < 3; ++row) {
    truth.insert(truth.end(), {1.0F, 1.0F, 3.0F, 3.0F});
  }
  write_pfm(path("truth.pfm"), {.width = 4, .height = 3, .metres = truth});
  write_depth_png(path("truth.png"), {.width = 4, .height = 3, .metres = truth});
  const std::string replay = "replay stream.csv -a 3333 -r histogram ";
  const Outcome outcome = dtof(replay + "--truth truth.pfm --offset 299.792458 --out replay");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const std::string frame = read_file(path("frame/summary.csv"));
  const std::string csv = read_file(path("replay/summary.csv"));
  for (const char* figure : {"rmse mm", "bias mm"}) {
    EXPECT_NEAR(std::stod(csv_cell(csv, "histogram", figure)),
                std::stod(csv_cell(frame, "histogram", figure)), 0.51)
        << figure;
  }
  EXPECT_EQ(csv_cell(csv, "histogram", "above 3 %"), csv_cell(frame, "histogram", "above 3 %"));
  EXPECT_EQ(csv_cell(csv, "histogram", "measurements"), "12");
  // Another format, another offset: the bias moves by it.
  ASSERT_EQ(dtof(replay + "--truth truth.png --offset 199.792458 --out moved").exit_code, 0);
  EXPECT_NEAR(std::stod(csv_cell(read_file(path("moved/summary.csv")), "histogram", "bias mm")),
              std::stod(csv_cell(csv, "histogram", "bias mm")) + 100.0, 0.11);
  // A map of the region's size, and one distance only: no slope.
  write_pfm(path("region.pfm"), {.width = 1, .height = 2, .metres = {3.0F, 3.0F}});
  const Outcome region = dtof(replay + "--columns 3 --rows 0-1 --truth region.pfm --out region");
  ASSERT_EQ(region.exit_code, 0) << region.output;
  EXPECT_EQ(csv_cell(read_file(path("region/summary.csv")), "histogram", "measurements"), "2");
  EXPECT_EQ(csv_cell(read_file(path("region/summary.csv")), "histogram", "slope"), "-");

  expect_refused(replay + "--truth region.pfm --out out", "1 x 2 pixels, but the recording has 4 x 3");
  expect_refused(replay + "--truth nowhere.png --out out", "nowhere.png");
  expect_refused(replay + "--truth-scale 1 --out out", "--truth-scale needs --truth");
  expect_refused(replay + "--offset 1 --out out", "--truth");
}

TEST_F(Programs, MeasuredAgainstATruthMap) {
  const std::filesystem::path core_file = std::filesystem::weakly_canonical(DTOF_CORE_FILE);
  const std::filesystem::path log =
      core_file.parent_path().parent_path().parent_path() / "shared/data/ams_tmf8829_log.json.gz";
  if (!std::filesystem::exists(log)) {
    GTEST_SKIP() << log.string() << " is not here";
  }
  const std::string measured = fmt::format("measured '{}' -r sifh -a 500 --photons 300 ", log.string());
  // The log's 26 frames of 16 zones; the lower half of each is unknown.
  constexpr std::size_t kHalf = 208;
  std::vector<float> truth(2 * kHalf, 1.5F);
  std::fill(truth.begin() + kHalf, truth.end(), 0.0F);
  write_pfm(path("truth.pfm"), {.width = 26, .height = 16, .metres = truth});
  const Outcome outcome = dtof(measured + "--truth truth.pfm --out measured");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("The truth is the map truth.pfm."));
  const std::string csv = read_file(path("measured/summary.csv"));
  EXPECT_THAT(csv, HasSubstr("offset_mm,rmse_mm,bias_mm"));
  EXPECT_THAT(csv, HasSubstr("\n300,0,SiFH,208,"));
  write_pfm(path("small.pfm"), {.width = 2, .height = 1, .metres = {1.0F, 1.0F}});
  expect_refused(measured + "--truth small.pfm --out out",
                 "small.pfm: the truth map has 2 x 1 pixels, but the recording has 26 x 16");
  expect_refused(measured + "--truth-scale 2 --out out", "--truth-scale needs --truth");
}

TEST_F(Programs, WhatLiesOutsideOfARecordingsRangeIsSaid) {
  // 10 photons a pixel: of the left one at 5 ns, of the right one at 60 ns.
  std::vector<double> counts(160, 0.0);
  counts[10] = 10.0;
  counts[80 + 60] = 10.0;
  write_npy(path("h.npy"), std::vector<std::size_t>{1, 2, 80}, counts);
  const std::string replay = "replay h.npy --bin-width 1000 -r sifh --out out ";
  expect_refused(replay + "--columns 1",
                 "h.npy: all 10 photons of the pixels read are outside the range, 0 to 45 ns");
  const Outcome half = dtof(replay);
  ASSERT_EQ(half.exit_code, 0) << half.output;
  EXPECT_THAT(half.output, HasSubstr("10 of 20 photons are outside the range, 0 to 45 ns, and lost."));
  EXPECT_THAT(dtof(replay + "--t-int 90").output, Not(HasSubstr("lost")));

  write_npy(path("truth.npy"), std::vector<std::size_t>{1, 2}, std::vector<double>{1.5, 9.0});
  const Outcome judged = dtof(replay + "--truth truth.npy");
  ASSERT_EQ(judged.exit_code, 0) << judged.output;
  EXPECT_THAT(judged.output,
              HasSubstr("1 pixel is beyond the range, 6.75 m (light there and back in 45 ns), and "
                        "not judged."));
  EXPECT_EQ(csv_cell(read_file(path("out/summary.csv")), "SiFH", "measurements"), "1");
  write_npy(path("near.npy"), std::vector<std::size_t>{1, 2}, std::vector<double>{1.5, 6.0});
  EXPECT_THAT(dtof(replay + "--truth near.npy").output,
              HasSubstr("1 pixel is without a detection and not judged."));
  std::filesystem::remove(path("out/summary.csv"));
  write_npy(path("mm.npy"), std::vector<std::size_t>{1, 2}, std::vector<double>{1500.0, 9000.0});
  expect_refused(
      replay + "--truth mm.npy",
      "mm.npy: every true distance is beyond the range, 6.75 m (light there and back in 45 ns), the "
      "nearest at 1500 m; if these are millimetres, use --truth-scale 0.001");
}

TEST_F(Programs, EmptyAndDarkRecordingsAreReplayed) {
  const std::string empty = file("empty.csv", "acquisition,column,row,timestamp\n");
  expect_refused("replay " + empty + " --out out", "--array-columns, --array-rows, --acquisitions");
  for (const char* engine : {"model", "rtl"}) {
    const Outcome outcome = dtof(fmt::format(
        "replay {} --array-columns 3 --array-rows 2 -a 100 --engine {} --out {}", empty, engine, engine));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("3 columns x 2 rows, 100 acquisitions"));
  }
  for (const Readout readout : kRtlReadouts) {
    const std::string csv = fmt::format("/{}.csv", readout_name(readout));
    EXPECT_EQ(read_file(path("model") + csv), read_file(path("rtl") + csv)) << csv;
  }
  // Dark pixels beyond the last that detected something belong to the array, too.
  const std::string corner = file("corner.csv", "acquisition,column,row,timestamp\n0,0,0,1\n");
  EXPECT_THAT(dtof("replay " + corner + " -r sifh --array-columns 4 --array-rows 5 --out out").output,
              HasSubstr("4 columns x 5 rows"));
  expect_refused("replay " + corner + " --array-columns 0", "--array-columns");
  const std::vector<std::size_t> shape = {2, 3, 4};
  write_npy(path("dark.npy"), shape, std::vector<double>(24, 0.0));
  EXPECT_EQ(dtof("replay dark.npy --bin-width 100 -r sifh --out dark").exit_code, 0);
}

TEST_F(Programs, TheContentOfAJsonFileChoosesItsReader) {
  // Complaints are those of the reader: of captures, and of a log with its "Result_Set".
  std::filesystem::create_directories(path("tmf8829"));
  expect_refused("replay " + file("tmf8829/tmf8829.json", " [{}]") + " --out out", "dist_to_plane");
  expect_refused("replay " + file("tmf8820.json", "\n{}") + " --out out", "Result_Set");
}

TEST_F(Programs, PipesAreReadAsFilesAre) {
  write_npy(path("map.npy"), std::vector<std::size_t>{2, 2}, std::vector<double>{1.0, 1.5, 2.0, 2.5});
  const std::string frame = "frame -r ezpointer --table none " + kSmallScene;
  ASSERT_EQ(dtof(frame + " --depth map.npy --out file").exit_code, 0);
  const Outcome piped = run("cat", "map.npy | " DTOF_PROGRAM " " + frame + " --depth /dev/stdin --out pipe");
  ASSERT_EQ(piped.exit_code, 0) << piped.output;
  EXPECT_EQ(read_file(path("pipe/summary.csv")), read_file(path("file/summary.csv")));
  write_file(path("s.csv"), "acquisition,column,row,timestamp\n0,0,0,100\n2,1,0,101\n");
  ASSERT_EQ(dtof("replay s.csv -r ezpointer --out file").exit_code, 0);
  const Outcome replayed = run("cat", "s.csv | " DTOF_PROGRAM " replay /dev/stdin -r ezpointer --out pipe");
  ASSERT_EQ(replayed.exit_code, 0) << replayed.output;
  EXPECT_EQ(read_file(path("pipe/ezpointer.csv")), read_file(path("file/ezpointer.csv")));
}

TEST_F(Programs, RefusesBadStreams) {
  const std::string header = "acquisition,column,row,timestamp\n";
  expect_refused("replay nowhere.csv --out out", "nowhere.csv");
  expect_refused("replay " + file("empty.csv", "") + " --out out", "empty.csv");
  expect_refused("replay " + file("head.csv", "a,b\n") + " --out out", "head.csv:1:");
  expect_refused("replay " + file("text.csv", header + "0,0,0,1\n0,0,x,1\n") + " --out out", "text.csv:3:");
  expect_refused("replay " + file("cut.csv", header + "0,0,0,1\n0,0") + " --out out", "cut.csv:3:");
  expect_refused("replay " + file("range.csv", header + "0,0,0,1024\n") + " --out out", "range.csv:2:");
  expect_refused("replay " + file("slots.csv", header + "0,0,0,1\n0,0,0,2\n0,0,0,3\n") + " --out out",
                 "slots.csv:4:");
  expect_refused("replay " + file("late.csv", header + "7,0,0,1\n") + " -a 7 --out out", "late.csv:2:");
  expect_refused("replay " + file("data.xyz", "1") + " --out out", "--format");
  expect_refused("replay " + file("broken.json", "[{") + " --out out", "broken.json");
  expect_refused("replay " + file("broken.npy", "\x93NUMPY") + " --bin-width 100 --out out", "broken.npy");
  expect_refused("replay " + file("broken.mat", "not a MATLAB file") + " --out out", "broken.mat");
}

}  // namespace
}  // namespace dtof
