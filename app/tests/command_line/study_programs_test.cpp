// SPDX-License-Identifier: Apache-2.0
// Studies, as a user runs them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/scene/scene.hpp"
#include "tests/command_line/programs.hpp"

namespace dtof {
namespace {

using test::csv_cell;
using test::Outcome;
using test::Programs;

using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Programs, AccuracyPrintsTheSweep) {
  const Outcome outcome = dtof("accuracy -r hispointer,histogram --distances 1 2 --frames 20 --out out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("Relative precision"));
  EXPECT_THAT(outcome.output, HasSubstr("matched filter"));
  EXPECT_GT(std::filesystem::file_size(path("out/relative_precision_14klux.svg")), 0U);
  EXPECT_THAT(read_file(path("out/accuracy.csv")), HasSubstr("\n14,hispointer,2,20,1,"));
}

TEST_F(Programs, AccuracyTakesMoreFramesUntilPreciseEnoughAndSaysHowMany) {
  const std::string sweep = "accuracy -r hispointer --distances 2 --frames 50 --out out ";
  const Outcome reached = dtof(sweep + "--precision 20");
  EXPECT_EQ(reached.exit_code, 0) << reached.output;
  EXPECT_THAT(reached.output, HasSubstr("Precision reached at 2 of 2 points"));
  const Outcome given_up = dtof(sweep + "--precision 0.1 --max-frames 100");
  EXPECT_EQ(given_up.exit_code, 0) << given_up.output;
  EXPECT_THAT(given_up.output, HasSubstr("Precision reached at 0 of 2 points, with up to 100 frames"));
}

TEST_F(Programs, FidelityAutoTakesTheCheapestModelWithNoiseThatKeepsTheTolerance) {
  const auto photons = [&](const std::string& options) {
    const Outcome outcome =
        dtof("frame --scene flat --array-columns 4 --array-rows 4 --out out --fidelity auto " + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return outcome.output;
  };
  EXPECT_THAT(photons("-r hispointer --tolerance 0"), HasSubstr("exact photons"));
  EXPECT_THAT(photons("-r hispointer --tolerance 0.001"), HasSubstr("exact photons"));
  EXPECT_THAT(photons("-r hispointer"), HasSubstr("fast photons"));
  EXPECT_THAT(photons("-r hispointer --tolerance 9 --precision 50"), HasSubstr("fast photons"));
  EXPECT_THAT(photons("-r poolpointer --tolerance 9"), HasSubstr("exact photons")) << "it reads streams";
  EXPECT_THAT(photons("-r hispointer --tolerance 9 --record recording.csv"), HasSubstr("exact photons"));
  EXPECT_THAT(photons("-r hispointer --tolerance 9 --acquisitions 100"), HasSubstr("exact photons"))
      << "beyond what was measured";
  EXPECT_THAT(dtof("accuracy -r hispointer --distances 2 --frames 20 --out out --fidelity auto").output,
              HasSubstr("auto, which draws streams exactly"));
}

TEST_F(Programs, ScenesComparesReadoutsAndVariants) {
  const Outcome outcome = dtof(
      "scenes --preset thesis --klux 14 --scene planes --columns 2 -r poolpointer,hispointer "
      "--variant hispointer:COUNT_WIDTH=8 --out out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  const std::string table = read_file(path("out/scenes.csv"));
  for (const char* estimator : {"poolPointer", "hisPointer", "COUNT_WIDTH=8", "matched filter"}) {
    EXPECT_THAT(table, HasSubstr(estimator));
  }
  EXPECT_GT(std::filesystem::file_size(path("out/planes_14klux_thesis.png")), 0U);
}

/// A sensor of 24 x 20 pixels and short frames.
const std::string kSmallSensor =
    "[array]\ncolumns = 24\nrows = 20\n[tdc]\nrange_ns = 45.0\ntimestamp_bits = 10\nslots = 2\n"
    "[laser]\nacquisitions = 600\npulse_fwhm_ns = 2.0\n[light]\nsignal_events_at_1m = 0.3\n"
    "background_events_per_klux = 0.0107\ndefault_reflectivity = 0.5\n";

/// PNG of 8 bits, grey or RGB, `channels` values a pixel.
void write_png8(const std::string& path, int columns, int rows, int channels,
                const std::vector<std::uint8_t>& values) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(columns);
  image.height = static_cast<png_uint_32>(rows);
  image.format = channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
  ASSERT_NE(png_image_write_to_file(&image, path.c_str(), 0, values.data(), 0, nullptr), 0);
}

TEST_F(Programs, EnlargeComparesSmallArraysWithTheLargeOne) {
  // Near on the left, far on the right, and between them what the disparity map does not know.
  std::vector<std::uint8_t> disparity;
  std::vector<std::uint8_t> photograph;
  for (int i = 0; i < 24 * 20; ++i) {
    const int column = i % 24;
    disparity.push_back(column < 10 ? 200 : column < 12 ? 0 : 100);
    photograph.insert(photograph.end(), 3, column < 10 ? 220 : 120);
  }
  write_png8(path("disparity.png"), 24, 20, 1, disparity);
  write_png8(path("photograph.png"), 24, 20, 3, photograph);
  const std::string command = "enlarge --sensor " + file("small.toml", kSmallSensor) +
                              " --scene staircase -k 1 --photographed hut=disparity.png,photograph.png "
                              "--array 12x10 6x5 --picture-array 12x10 -r poolpointer hispointer --seeds 2 ";
  const Outcome outcome = dtof(command + "--out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(outcome.output, "The report is out/enlarge.md\n");
  const std::string csv = read_file(path("out/enlarge.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * (1 + 2 * 3 * 4));
  EXPECT_THAT(csv, HasSubstr("1,staircase,24 x 20,poolPointer,-,480,"));
  EXPECT_THAT(csv, HasSubstr("1,hut,12 x 10,hisPointer,learned,440,"));  // 40 pixels are not known
  const std::string report = read_file(path("out/enlarge.md"));
  EXPECT_THAT(report, HasSubstr("](enlarge_1klux.png)"));
  EXPECT_THAT(report, HasSubstr("has fewer pixels above 3 % than the map of the large array: **1 klux: "));
  EXPECT_THAT(report, HasSubstr("Seeds 1 to 2"));
  EXPECT_GT(std::filesystem::file_size(path("out/enlarge_1klux.png")), 1000U);
  ASSERT_EQ(dtof(command + "-j 1 --out again").exit_code, 0);
  EXPECT_EQ(read_file(path("again/enlarge.csv")), csv);
}

TEST_F(Programs, EnlargeRefusesWhatDoesNotFit) {
  const std::string sensor = "enlarge --seeds 2 --out out --sensor " + file("small.toml", kSmallSensor) + " ";
  const std::string arrays = "--array 12x10 --picture-array 12x10 ";
  expect_refused(sensor + "--array 12", "array '12': expected COLUMNSxROWS, such as 100x80");
  expect_refused(sensor + "--array 25x10", "a small array has 1 to 24 columns and 1 to 20 rows, not 25 x 10");
  expect_refused(sensor + "--array 24x20 --picture-array 24x20", "a small array of 24 x 20 is the large one");
  expect_refused(sensor + "--array 12x10 --picture-array 6x5", "--picture-array");
  expect_refused(sensor + arrays + "--picture-scene moon", "--picture-scene: no map has the name 'moon'");
  expect_refused(sensor + arrays + "--photographed hut=a.png", "expected NAME=DISPARITY,PHOTOGRAPH");
  expect_refused(sensor + arrays + "--photographed hut=a.png,b.png", "a.png: cannot read");
  expect_refused(sensor + arrays + "--weights none.txt", "none.txt: cannot read");
  expect_refused(sensor + arrays + "--weights " + file("w.txt", "dtof-enlarger 1\njoint_bilateral 1 x\n"),
                 "w.txt, line 2: a width of the joint bilateral filter is 'x', which is no number");
  expect_refused(sensor + arrays + "-r poolpointer hispinter", "hispinter");
  expect_refused(sensor + arrays + "--seeds 1", "--seeds");
  write_png8(path("dark.png"), 4, 4, 1, std::vector<std::uint8_t>(16));
  expect_refused(sensor + arrays + "--photographed dark=dark.png,dark.png", "dark.png: no known depth");
  EXPECT_FALSE(std::filesystem::exists(path("out/enlarge.md")));
}

TEST_F(Programs, FrameAndScenesGiveTheSameFiguresAndNameTheirTable) {
  for (const char* table : {"flat", "none"}) {
    SCOPED_TRACE(table);
    const Outcome frame =
        dtof(fmt::format("frame --scene poles -r hispointer,fifh --table {} --out frame", table));
    ASSERT_EQ(frame.exit_code, 0) << frame.output;
    const Outcome scenes = dtof(fmt::format(
        "scenes --preset thesis --klux 14 --scene poles -r hispointer,fifh --table {} --out scenes", table));
    ASSERT_EQ(scenes.exit_code, 0) << scenes.output;
    for (const char* title : {"hisPointer", "FiFH"}) {
      const std::string one = csv_cell(read_file(path("frame/summary.csv")), title, "above 3 %");
      const std::string other = csv_cell(read_file(path("scenes/scenes.csv")),
                                         fmt::format("thesis,14,poles,{}", title), "above_3_percent");
      EXPECT_EQ(one, fmt::format("{:.2f} %", std::stod(other) * 100.0)) << title;
    }
    const std::string named = fmt::format("(--table {})", table);
    EXPECT_THAT(read_file(path("frame/summary.md")), HasSubstr(named));
    EXPECT_THAT(read_file(path("scenes/scenes.md")), HasSubstr(named));
  }
  expect_refused("frame --table round --out out", "--table");
  expect_refused("scenes --table round --out out", "--table");
}

TEST_F(Programs, OwnMapsInScenesHaveTheirName) {
  const std::array<double, 2> metres = {1.5, 2.0};
  const std::array<double, 2> reflectivity = {0.4, 0.8};
  const std::array<std::size_t, 2> shape = {1, 2};
  write_npy(path("depth.npy"), shape, metres);
  write_npy(path("dim.npy"), shape, reflectivity);
  const Outcome outcome = dtof(
      "scenes --preset thesis --klux 14 -r hispointer --columns 2 --map hall=depth.npy --map "
      "'dim hall=depth.npy,dim.npy' --out out2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const std::string csv = read_file(path("out2/scenes.csv"));
  EXPECT_THAT(csv, HasSubstr("thesis,14,hall,hisPointer,320,"));
  EXPECT_THAT(csv, HasSubstr("thesis,14,dim hall,hisPointer,320,"));
  EXPECT_THAT(csv, ::testing::Not(HasSubstr("room")));
  EXPECT_THAT(read_file(path("out2/scenes.md")),
              HasSubstr("Scene dim hall: Depth map depth.npy: 2 x 1 pixels, resampled to 200 x 160"));
  EXPECT_GT(std::filesystem::file_size(path("out2/dim_hall_14klux_thesis.png")), 0U);

  for (const auto& [map, reason] :
       {std::pair("hall", "expected NAME=DEPTH"), std::pair("hall=", "expected NAME=DEPTH"),
        std::pair("=depth.npy", "expected NAME=DEPTH"), std::pair("hall=depth.npy,", "expected NAME=DEPTH"),
        std::pair("a/b=depth.npy", "a name has letters"),
        std::pair("room=depth.npy", "name of another scene"),
        std::pair("'flat 1 m=depth.npy'", "name of another scene"),
        std::pair("a=depth.npy --map a=depth.npy", "another map has this name"),
        std::pair("a=nowhere.npy", "nowhere.npy")}) {
    expect_refused(fmt::format("scenes --map {} --out out", map), reason);
  }
  expect_refused("scenes --depth-scale 2 --out out", "need --map");
}

TEST_F(Programs, AccuracyOverAMapIsByDistanceBand) {
  const std::array<double, 2> metres = {1.5, 2.5};
  write_npy(path("depth.npy"), std::array<std::size_t, 2>{1, 2}, metres);
  const std::string accuracy = "accuracy -r hispointer -a 200 --fidelity fast --depth depth.npy ";
  const Outcome outcome = dtof(accuracy + "--distances 1 2 3 --frames 4 --out map");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("2 x 1 pixels, resampled to 200 x 160 by nearest neighbour"));
  EXPECT_THAT(outcome.output, HasSubstr("(--table flat)"));
  const std::string csv = read_file(path("map/accuracy.csv"));
  for (const char* band : {"1.0000,2.0000,16000,4", "2.0000,3.0000,16000,4", "1.0000,3.0000,32000,4"}) {
    EXPECT_THAT(csv, HasSubstr(fmt::format("\n14,hispointer,{},", band)));
  }
  expect_refused(accuracy + "--precision 5 --out out", "--precision does not apply to a scene of your own");
  expect_refused(accuracy + "--distances 3 2 --out out", "ascending edges");
  expect_refused("accuracy --depth-scale 2 --out out", "need --depth");
}

// One column of the cube has a target at 1.5 m, the other one at 3 m behind a weaker return at 1.5 m.
TEST_F(Programs, AccuracyOverATransientCubeIsByDistanceBand) {
  std::vector<double> events(800, 0.0);
  events[100] = events[600] = 0.06;
  events[500] = 0.02;
  write_npy(path("cube.npy"), std::array<std::size_t, 3>{1, 2, 400}, events);
  const std::string accuracy = "accuracy -r coarsehistogram -a 300 -k 0 --cube cube.npy ";
  const Outcome outcome =
      dtof(accuracy + "--cube-bin-width 100e-12 --distances 1 2 4 --frames 4 --out cube --json 2> text");
  ASSERT_EQ(outcome.exit_code, 0) << read_file(path("text"));
  const std::string text = read_file(path("cube/accuracy.md"));
  EXPECT_THAT(text, HasSubstr("2 x 1 pixels, resampled to 200 x 160 by nearest neighbour"));
  EXPECT_THAT(text, HasSubstr("A pixel's distance is that of its strongest return."));
  const std::string csv = read_file(path("cube/accuracy.csv"));
  for (const char* band : {"1.0000,2.0000,16000,4", "2.0000,4.0000,16000,4", "1.0000,4.0000,32000,4"}) {
    EXPECT_THAT(csv, HasSubstr(fmt::format("\n0,coarsehistogram,{},", band)));
  }
  // Bin 100 is at 1.5 m, and nearly no pixel is more than 10 % off.
  const std::size_t line = csv.find("\n0,coarsehistogram,1.0000,4.0000,");
  ASSERT_NE(line, std::string::npos);
  const std::string last = csv.substr(line + 1, csv.find('\n', line + 1) - line - 1);
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= last.size();) {
    const std::size_t end = std::min(last.find(',', begin), last.size());
    cells.push_back(last.substr(begin, end - begin));
    begin = end + 1;
  }
  ASSERT_EQ(cells.size(), 18U) << last;
  EXPECT_LT(std::stod(cells[15]), 1.0) << last;
  expect_refused(accuracy + "--out out", "needs the width of its bins");
  expect_refused(accuracy + "--cube-bin-width 1e-10 --fidelity fast --out out", "exact");
  expect_refused(accuracy + "--cube-bin-width 1e-10 --reflectivity 0.5 --out out", "its own light");
  expect_refused(accuracy + "--depth depth.npy --out out", "contradict each other");
  expect_refused("accuracy --cube-scale 2 --out out", "need --cube");
}

TEST_F(Programs, WalkWritesItsReportAndPicture) {
  const Outcome outcome =
      dtof("walk -r sifh,ezpointer -a 300 --columns 4 --reflectivities 0.1 1 --distances 0.5 1 --out walk");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("walk before"));
  EXPECT_THAT(read_file(path("walk/walk_error.csv")), HasSubstr("\nsifh,0.1,0.5,"));
  EXPECT_THAT(read_file(path("walk/walk_error.md")), HasSubstr("## ezPointer"));
  EXPECT_GT(std::filesystem::file_size(path("walk/walk_error.svg")), 0U);
  expect_refused("walk --fidelity fast --out out", "--fidelity has no effect");
  expect_refused("walk --binning 2 --out out", "binning");
  expect_refused("walk --reflectivities 0 1 --out out", "reflectivity");
  expect_refused("walk --distances 0 --out out", "distance");
}

TEST_F(Programs, DynamicRangeWritesItsReportAndTakesCellsThatAreDone) {
  const std::string command =
      "dynamic-range -r coarsehistogram,poolpointer --count-width 4 -a 30 3000 -k 2 --signals 1 --seeds 2 "
      "--rows 8 "
      "--scene room --out range";
  const Outcome outcome = dtof(command);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("The report is"));
  const std::string report = read_file(path("range/dynamic_range.md"));
  EXPECT_THAT(report, HasSubstr("More acquisitions made a pool read-out worse"));
  EXPECT_THAT(report, HasSubstr("## Full counters"));
  EXPECT_THAT(read_file_or_gzip(path("range/data/dynamic_range.csv.gz")),
              HasSubstr("\npoolpointer,grid,1,2,3000,544,"));
  EXPECT_GT(std::filesystem::file_size(path("range/dynamic_range.svg")), 0U);

  std::filesystem::path cells;
  for (const auto& entry : std::filesystem::directory_iterator(path("range"))) {
    cells = entry.path().filename().string().starts_with("cells_") ? entry.path() : cells;
  }
  const std::filesystem::path cell = cells / "grid_1_2_3000_0.csv";
  const auto written = std::filesystem::last_write_time(cell);
  ASSERT_EQ(dtof(command).exit_code, 0);
  EXPECT_EQ(std::filesystem::last_write_time(cell), written);
  EXPECT_EQ(read_file(path("range/dynamic_range.md")), report);
  const Outcome other = dtof(command + " --seed 2");
  EXPECT_EQ(other.exit_code, 0) << other.output;
  EXPECT_EQ(std::filesystem::last_write_time(cell), written) << "other settings have other cells";
  EXPECT_NE(read_file(path("range/dynamic_range.md")), report);

  expect_refused("dynamic-range -a 65536 --out out", "acquisitions");
  expect_refused("dynamic-range --signals 0 --out out", "signals");
  expect_refused("dynamic-range --seeds 1 --out out", "seeds");
  expect_refused("dynamic-range --rows 161 --out out", "161 rows");
  expect_refused("dynamic-range --scene cellar --out out", "cellar");
}

TEST_F(Programs, HostileScenesWritesItsReportAndTakesCellsThatAreDone) {
  const std::string command =
      "hostile-scenes -r coarsehistogram --condition clear motion -k 2 --seeds 2 --rows 8 --scene sky --out "
      "hostile";
  const Outcome outcome = dtof(command);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const std::string report = read_file(path("hostile/hostile_scenes.md"));
  EXPECT_THAT(report, HasSubstr("# What each read-out survives"));
  EXPECT_THAT(report, HasSubstr("* motion: everything goes away at 10 m/s."));
  EXPECT_THAT(read_file_or_gzip(path("hostile/data/hostile_scenes.csv.gz")),
              HasSubstr("\ncoarsehistogram,motion,2,"));
  EXPECT_GT(std::filesystem::file_size(path("hostile/hostile_scenes.svg")), 0U);
  std::filesystem::path cells;
  for (const auto& entry : std::filesystem::directory_iterator(path("hostile"))) {
    cells = entry.path().filename().string().starts_with("cells_") ? entry.path() : cells;
  }
  const auto written = std::filesystem::last_write_time(cells / "motion_2.csv");
  ASSERT_EQ(dtof(command).exit_code, 0);
  EXPECT_EQ(std::filesystem::last_write_time(cells / "motion_2.csv"), written);
  EXPECT_EQ(read_file(path("hostile/hostile_scenes.md")), report);
  expect_refused("hostile-scenes --condition fog --out out", "clear");
  expect_refused("hostile-scenes --condition clear fgo --out out", "fgo");
  expect_refused("hostile-scenes --seeds 1 --out out", "seeds");
  expect_refused("hostile-scenes --false-alarms 0 --out out", "false alarms");
}

TEST_F(Programs, FramesAreReadSideBySideAndCheckedInRtl) {
  const auto sensor = [&](const std::string& name, int acquisitions) {
    return file(
        name + ".toml",
        fmt::format("name = \"{}\"\n[array]\ncolumns = 34\nrows = 16\n[tdc]\nrange_ns = 45.0\n"
                    "[laser]\nacquisitions = {}\npulse_fwhm_ns = 2.0\n[light]\nsignal_events_at_1m = 0.3\n"
                    "background_events_per_klux = 0.01\n",
                    name, acquisitions));
  };
  const std::string sensors = sensor("short", 40) + " " + sensor("long", 400);
  const Outcome outcome =
      dtof("frames --sensors " + sensors + " -r fifh,poolpointer --frames 2 --rtl poolpointer --out frames");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const std::string report = read_file(path("frames/frames.md"));
  EXPECT_THAT(report, HasSubstr("Scene room: 34 x 16 pixels, 14 klux"));
  EXPECT_THAT(report, HasSubstr("RTL with long: poolPointer, "));
  EXPECT_THAT(report, HasSubstr("every pixel equal to the model"));
  const std::string csv = read_file(path("frames/frames.csv"));
  EXPECT_THAT(csv, HasSubstr("\nshort,fifh,FiFH,40,1088,"));
  EXPECT_THAT(csv, HasSubstr("\nlong,poolpointer,poolPointer,400,1088,"));
  expect_refused("frames --frames 1 --out out", "frames");
  expect_refused("frames --sensors nosensor --out out", "nosensor");
  expect_refused("frames --rtl nothing --out out", "nothing");
}

TEST_F(Programs, VideoReadsItsDefaultReadoutsAndWritesItsReportAndPictures) {
  const Outcome outcome = dtof(
      "video --motion still light --frames 2 --array-columns 34 --array-rows 8 --acquisitions 300 --out out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("poolPointer, prior"));
  for (const char* file : {"video.csv", "video.md", "room_still.svg", "room_light.svg",
                           "room_still_depth.png", "room_light_depth.png"}) {
    EXPECT_TRUE(std::filesystem::exists(path("out") + "/" + file)) << file;
  }
  EXPECT_THAT(outcome.output, Not(HasSubstr("+-")));
  const Outcome seeds = dtof(
      "video --motion still --frames 2 --array-columns 34 --array-rows 32 --klux 80 --acquisitions 300 "
      "--seeds 2 --out out");
  EXPECT_THAT(seeds.output, HasSubstr("+-")) << "of two seeds a change has an interval";
  const Outcome without = dtof(
      "video --readout hispointer --frames 2 --array-columns 8 --array-rows 8 --acquisitions 300 --out out2");
  EXPECT_EQ(without.exit_code, 0) << without.output;
  EXPECT_THAT(without.output, Not(HasSubstr("prior")));
  expect_refused("video --scene planes --motion roll --out out3", "roll and object are motions of the room");
  expect_refused("video --motion spin --out out3", "unknown motion 'spin'");
  expect_refused("video --frames 1 --out out3", "--frames");
  expect_refused("video --fidelity fast --out out3", "videos are drawn with exact photons");
  EXPECT_FALSE(std::filesystem::exists(path("out3")));
}

TEST_F(Programs, ClaimsWritesItsReportAndPictures) {
  const Outcome outcome = dtof("claims --pixels 100 --out claims");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("Seed 1."));
  EXPECT_THAT(read_file(path("claims/claims.csv")), HasSubstr("\nnarrow,sketch,sketch M = 2,4,"));
  const std::string page = read_file(path("claims/claims.md"));
  EXPECT_THAT(page, HasSubstr("## sunlit photons"));
  EXPECT_THAT(page, HasSubstr("over the whole range; 100 pixels, seed 1. Claims about"));
  EXPECT_GT(std::filesystem::file_size(path("claims/even.svg")), 0U);
  expect_refused("claims --pixels 99 --out out", "--pixels");
}

TEST_F(Programs, APageIsMadeAgainFromItsValues) {
  ASSERT_EQ(dtof("claims --pixels 100 --out claims").exit_code, 0);
  const Outcome made = dtof("page " + path("claims/claims.page.json"));
  EXPECT_EQ(made.exit_code, 0);
  EXPECT_EQ(made.output, read_file(path("claims/claims.md")));
  expect_refused("page " + file("a.json", "{"), "a.json: this is no page's data");
  expect_refused("page " + file("a.json", R"({"template": "none", "data": {}})"), "no template 'none'");
  expect_refused("page " + file("a.json", R"({"template": "claims", "data": {}})"),
                 "the data has no 'pixels'");
}

}  // namespace
}  // namespace dtof
