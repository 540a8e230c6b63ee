// SPDX-License-Identifier: Apache-2.0
// `dtof frame` as a user runs it: engines, options, own maps, what is written.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
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

TEST_F(Programs, FrameThroughTheRtlEqualsTheModelAndIsWritten) {
  const Outcome outcome = dtof(fmt::format("frame --engine rtl --verify {} --out out", kSmallScene));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("every pixel equal to the model"));
  for (const char* name : {"summary.md", "summary.csv", "overview.png", "errors.png", "sifh.csv", "sifh.ply",
                           "sifh_depth_mm.png", "sifh_depth.png", "sifh_error.png"}) {
    EXPECT_GT(std::filesystem::file_size(path("out") + "/" + name), 0U) << name;
  }
}

TEST_F(Programs, FrameThroughTheSubsystemIsThatOfTheBareArray) {
  const std::string frame =
      "frame -r ezpointer,hispointer,poolpointer --verify --array-columns 34 --array-rows 5 --acquisitions "
      "300 ";
  for (const char* engine : {"rtl", "subsystem"}) {
    const Outcome outcome = run(DTOF_FULL_PROGRAM, frame + fmt::format("--engine {0} --out {0}", engine));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(fmt::format("engine {} (every pixel equal to the model)", engine)));
  }
  for (const char* name : {"ezpointer", "hispointer", "poolpointer"}) {
    EXPECT_EQ(read_file(path("subsystem") + "/" + name + ".csv"),
              read_file(path("rtl") + "/" + name + ".csv"));
  }
  // Its time gate is there, its array's is not.
  const Outcome gated = run(DTOF_FULL_PROGRAM, frame + "--engine subsystem --code-gate 200 600 --out gated");
  EXPECT_EQ(gated.exit_code, 0) << gated.output;
  const Outcome other = run(DTOF_FULL_PROGRAM, "frame --engine subsystem --readout sifh --out other");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.output, HasSubstr("no subsystem is compiled for sifh"));
}

TEST_F(Programs, TemplateTakesTheGlassAway) {
  const std::string frame =
      "frame -r poolpointer --sensor thesis+glass --array-columns 34 --array-rows 5 --acquisitions 1000 ";
  ASSERT_EQ(run(DTOF_FULL_PROGRAM, frame + "--out fooled").exit_code, 0);
  ASSERT_EQ(run(DTOF_FULL_PROGRAM, frame + "--template --out compensated").exit_code, 0);
  EXPECT_NE(read_file(path("compensated/poolpointer.csv")), read_file(path("fooled/poolpointer.csv")));
  const Outcome whole =
      run(DTOF_FULL_PROGRAM, frame + "--template --verify --engine subsystem --out subsystem");
  ASSERT_EQ(whole.exit_code, 0) << whole.output;
  EXPECT_EQ(read_file(path("subsystem/poolpointer.csv")), read_file(path("compensated/poolpointer.csv")));
  const auto refused = [&](const std::string& options, const char* sentence) {
    const Outcome outcome = dtof("frame --out refused --template " + options);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr(sentence));
  };
  refused("-r poolpointer", "--template has no effect: the sensor has neither cover glass nor fog");
  refused("-r sifh --sensor thesis+fog", "--template has no effect: sifh has no TEMPLATE");
}

TEST_F(Programs, ThreadsAndChosenColumnsDoNotChangeAResult) {
  ASSERT_EQ(dtof(fmt::format("frame -r fifh {} --threads 1 --out one", kSmallScene)).exit_code, 0);
  ASSERT_EQ(dtof(fmt::format("frame -r fifh {} --threads 2 --out two", kSmallScene)).exit_code, 0);
  ASSERT_EQ(dtof(fmt::format("frame -r fifh {} --columns 4 --out four", kSmallScene)).exit_code, 0);
  const std::string whole = read_file(path("one/fifh.csv"));
  EXPECT_EQ(whole, read_file(path("two/fifh.csv")));
  ASSERT_EQ(dtof(fmt::format("frame -r fifh {} --threads 1 --out two", kSmallScene)).exit_code, 0);
  const std::string overview = read_file(path("two/overview.png"));
  const std::string errors = read_file(path("two/errors.png"));
  ASSERT_EQ(dtof(fmt::format("frame -r fifh {} -j 2 --out two", kSmallScene)).exit_code, 0);
  EXPECT_EQ(overview, read_file(path("two/overview.png")));
  EXPECT_EQ(errors, read_file(path("two/errors.png")));
  std::ifstream part(path("four/fifh.csv"));
  std::string line;
  int lines = 0;
  for (std::getline(part, line); std::getline(part, line); ++lines) {
    EXPECT_THAT(whole, HasSubstr(line + "\n"));
  }
  EXPECT_EQ(lines, 5);
}

TEST_F(Programs, FrameTakesMoreFramesUntilPreciseEnoughAndSaysHowMany) {
  const std::string frame = fmt::format("frame -r hispointer {} --out out ", kSmallScene);
  const Outcome once = dtof(frame);
  ASSERT_EQ(once.exit_code, 0) << once.output;
  const std::string first = read_file(path("out/hispointer.csv"));
  const Outcome given_up = dtof(frame + "--precision 0.01 --max-frames 5");
  EXPECT_EQ(given_up.exit_code, 0) << given_up.output;
  EXPECT_THAT(given_up.output, HasSubstr("for 0 of 1 read-outs, with up to 5 frames"));
  EXPECT_THAT(given_up.output, HasSubstr("5+"));
  EXPECT_EQ(read_file(path("out/hispointer.csv")), first);
  const Outcome reached = dtof(frame + "--precision 50");
  EXPECT_EQ(reached.exit_code, 0) << reached.output;
  EXPECT_THAT(reached.output, HasSubstr("for 1 of 1 read-outs"));
  EXPECT_THAT(read_file(path("out/summary.md")), HasSubstr("for 1 of 1 read-outs"));
}

// A flat wall of pixels of their own noise: the filter makes its errors smaller. The results stay.
TEST_F(Programs, FrameFiltersTheMapAsAHostDoes) {
  const std::string frame =
      "frame -r hispointer --scene flat --distance 2 --array-columns 6 --array-rows 9 "
      "--acquisitions 1000 ";
  const Outcome plain = dtof(frame + "--out plain");
  ASSERT_EQ(plain.exit_code, 0) << plain.output;
  const Outcome filtered = dtof(frame + "--host-filter --json --out filtered");
  ASSERT_EQ(filtered.exit_code, 0) << filtered.output;
  const std::string before = read_file(path("plain/summary.csv"));
  const std::string after = read_file(path("filtered/summary.csv"));
  EXPECT_EQ(csv_cell(after, "hisPointer", "rmse mm"), csv_cell(before, "hisPointer", "rmse mm"));
  EXPECT_LT(std::stod(csv_cell(after, "hisPointer with host filter", "rmse mm")),
            0.6 * std::stod(csv_cell(before, "hisPointer", "rmse mm")));
  EXPECT_EQ(read_file(path("filtered/hispointer.csv")), read_file(path("plain/hispointer.csv")));
  EXPECT_NE(read_file(path("filtered/hispointer_depth_mm.png")),
            read_file(path("plain/hispointer_depth_mm.png")));
  EXPECT_NE(read_file(path("filtered/hispointer.ply")), read_file(path("plain/hispointer.ply")));
  EXPECT_THAT(filtered.output, HasSubstr("\"before_host_filter\""));
}

TEST_F(Programs, CyclesAreThoseOfTheWholeArrayWhateverIsRead) {
  const auto cycles = [&](const std::string& options, const char* title) {
    const Outcome outcome = dtof("frame --engine rtl --table none -a 20 --out out " + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return csv_cell(read_file(path("out/summary.csv")), title, "cycles");
  };
  const std::string one = cycles("-r ezpointer --columns 7", "ezPointer");
  EXPECT_EQ(cycles("-r ezpointer --columns 0-39", "ezPointer"), one);
  EXPECT_THAT(read_file(path("out/summary.md")),
              HasSubstr("\n\nCycles: clocks of a frame in an array of 200 columns of 160 rows.\n\n"));
  // 20 acquisitions of 160 pixels and 2 slots, and 200 results a row, five of them in seven clocks.
  EXPECT_GT(std::stoi(one), 160 * (2 * 20 + 280));
  EXPECT_LT(std::stoi(one), 160 * (2 * 20 + 300));
  EXPECT_LT(std::stoi(cycles("-r ezpointer --array-columns 20 --columns 7", "ezPointer")),
            std::stoi(one) - 160 * 170);
  // A pool read-out's last engine is narrower: its clocks are not those of the other engines.
  EXPECT_NE(cycles("-r poolpointer --columns 0", "poolPointer"), "-");
  EXPECT_EQ(cycles("-r poolpointer --columns 199", "poolPointer"), "-");
}

TEST_F(Programs, FrameSaysHowLongTheLookUpTableTook) {
  // 45 distances of 160 pixels take much longer than 2 x 2 pixels.
  const std::string frame = "frame -r histogram --array-columns 2 --array-rows 2 --out out ";
  const std::string text = dtof(frame).output;
  const std::size_t at = text.find("Look-up table in ");
  ASSERT_NE(at, std::string::npos) << text;
  double table = 0.0;
  double read_out = 1.0;
  ASSERT_EQ(std::sscanf(&text[at], "Look-up table in %lf s, read out in %lf s.", &table, &read_out), 2)
      << text;
  EXPECT_GT(table, read_out);
  EXPECT_THAT(dtof(frame + "--table none").output,
              ::testing::AllOf(HasSubstr("\nRead out in "), Not(HasSubstr("Look-up table in"))));
}

TEST_F(Programs, OwnMapsOfDepthAndReflectivityInFrame) {
  // 2 x 1 pixels: the left half of the array sees 1 m at half the reflectivity of the right half at 2 m.
  const std::array<double, 2> metres = {1.0, 2.0};
  const std::array<double, 2> reflectivity = {0.4, 0.8};
  const std::array<std::size_t, 2> shape = {1, 2};
  write_npy(path("depth.npy"), shape, metres);
  write_npy(path("reflectivity.npy"), shape, reflectivity);
  write_pfm(path("depth.pfm"), {.width = 2, .height = 1, .metres = {100.0F, 200.0F}});
  const std::string frame = fmt::format("frame -r histogram {} --table none ", kSmallScene);
  const Outcome npy = dtof(frame + "--depth depth.npy --reflectivity-map reflectivity.npy --out npy");
  ASSERT_EQ(npy.exit_code, 0) << npy.output;
  EXPECT_THAT(npy.output,
              HasSubstr("Depth map depth.npy: 2 x 1 pixels, resampled to 6 x 5 by nearest neighbour."));
  EXPECT_THAT(read_file(path("npy/summary.md")),
              HasSubstr("Reflectivity map reflectivity.npy: 2 x 1 pixels, resampled to 6 x 5"));
  const Outcome scaled = dtof(frame +
                              "--depth depth.pfm --depth-scale 0.01 --reflectivity-map "
                              "reflectivity.npy --out pfm");
  ASSERT_EQ(scaled.exit_code, 0) << scaled.output;
  EXPECT_EQ(read_file(path("npy/histogram.csv")), read_file(path("pfm/histogram.csv")));
  // One reflectivity everywhere is another scene, and the map that says so is the same as the option.
  ASSERT_EQ(dtof(frame + "--depth depth.npy --reflectivity 0.4 --out plain").exit_code, 0);
  EXPECT_NE(read_file(path("npy/histogram.csv")), read_file(path("plain/histogram.csv")));
  const std::array<double, 1> even = {0.8};
  write_npy(path("even.npy"), std::array<std::size_t, 2>{1, 1}, even);
  ASSERT_EQ(dtof(frame + "--depth depth.npy --reflectivity-map even.npy --reflectivity-scale 0.5 --out even")
                .exit_code,
            0);
  EXPECT_EQ(read_file(path("even/histogram.csv")), read_file(path("plain/histogram.csv")));

  expect_refused("frame --depth-scale 0.01 --out out", "--depth-scale needs --depth");
  expect_refused("frame --reflectivity-scale 0.01 --out out", "needs --reflectivity-map");
  expect_refused("frame --reflectivity 0.5 --reflectivity-map even.npy --out out", "choose one");
  expect_refused("frame --depth depth.npy --depth-scale 0 --out out", "--depth-scale");
}

TEST_F(Programs, ConditionsAreLaidOverTheSensorOfAFrame) {
  const std::string frame =
      "frame --scene flat --distance 3 --array-columns 4 --array-rows 8 -r coarsehistogram --fidelity exact ";
  const Outcome clear = dtof(frame + "--out clear");
  ASSERT_EQ(clear.exit_code, 0) << clear.output;
  EXPECT_THAT(clear.output, HasSubstr("0.00 % |     0.00 %"));
  const Outcome glass = dtof(frame + "--sensor thesis+glass --out glass");
  ASSERT_EQ(glass.exit_code, 0) << glass.output;
  EXPECT_THAT(glass.output, HasSubstr("100.00 % |   100.00 %"));
  const Outcome skew = dtof(frame + "--sensor thesis+column-skew --out skew");
  EXPECT_THAT(skew.output, HasSubstr("0.00 % |     0.00 %")) << "the host subtracts it";
  const Outcome late = dtof(frame + "--sensor thesis+late-laser --settle 734 --out late");
  EXPECT_THAT(late.output, HasSubstr("3333 acquisitions of which the first 734 are dropped, exact"));
  expect_refused("frame --settle 3333 --out out", "--settle");
  EXPECT_THAT(dtof("list").output, HasSubstr("other-laser-6ppm"));
  EXPECT_EQ(dtof("sensor thesis+fog").exit_code, 0);
  expect_refused("frame --sensor thesis+fgo --out out", "did you mean 'fog'");
  expect_refused("frame --sensor thesis+fog --fidelity fast --out out", "surroundings");
}

TEST_F(Programs, APartOfAPoolReadoutsColumnsIsReadAsInTheWholeArray) {
  ASSERT_EQ(dtof("frame -r poolpointer --columns 32-35 -a 200 --out whole").exit_code, 0);
  ASSERT_EQ(dtof("frame -r poolpointer --columns 35,33 -a 200 --out part").exit_code, 0);
  const std::string whole = read_file(path("whole/poolpointer.csv"));
  std::ifstream part(path("part/poolpointer.csv"));
  std::string line;
  int lines = 0;
  for (std::getline(part, line); std::getline(part, line); ++lines) {
    EXPECT_THAT(whole, HasSubstr("\n" + line + "\n"));
  }
  EXPECT_EQ(lines, 320);
}

TEST_F(Programs, APoolReadoutsRtlNeedsAnEngineOfTheColumns) {
  const std::string frame = "frame --array-columns 7 --array-rows 9 -a 20 --engine rtl --out out ";
  expect_refused(frame + "-r poolpointer",
                 "an engine of just 7 columns, which use each other's results; compiled are: poolpointer");
  const Outcome all = dtof(frame + "-r all");
  ASSERT_EQ(all.exit_code, 0) << all.output;
  EXPECT_THAT(all.output, HasSubstr("poolPointer is left out: its RTL is not compiled for 7 columns"));
  EXPECT_FALSE(std::filesystem::exists(path("out/poolpointer.csv")));
  EXPECT_TRUE(std::filesystem::exists(path("out/coarsehistogram.csv")));
}

TEST_F(Programs, AnOutputThatIsImpossibleIsLeftOutAndTheRestIsWritten) {
  // A point cloud has the sensor's degrees a pixel, not those of the thesis's 200 columns.
  const std::string frame = "frame -r ezpointer --table none -a 10 --scene flat ";
  const auto sensor = [&](const char* name, int columns, int range_ns, double signal) {
    return file(name, fmt::format(R"(name = "v"
[array]
columns = {}
rows = 2
field_of_view_deg = 60
[tdc]
range_ns = {}
timestamp_bits = 10
[laser]
acquisitions = 10
pulse_fwhm_ns = 2.0
[light]
signal_events_at_1m = {}
background_events_per_klux = 0.02
)",
                                  columns, range_ns, signal));
  };
  const Outcome wide = dtof(frame + "--out wide --sensor " + sensor("wide.toml", 640, 45, 0.12));
  EXPECT_EQ(wide.exit_code, 0) << wide.output;
  EXPECT_THAT(wide.output, Not(HasSubstr("left out")));
  EXPECT_TRUE(std::filesystem::exists(path("wide/ezpointer.ply")));

  // One from a frame before does not stay.
  ASSERT_EQ(dtof(frame + "--array-columns 3 --array-rows 1 --out line").exit_code, 0);
  ASSERT_TRUE(std::filesystem::exists(path("line/ezpointer.ply")));
  const Outcome line = dtof(frame + "--array-columns 375 --array-rows 1 --out line");
  EXPECT_EQ(line.exit_code, 0) << line.output;
  EXPECT_THAT(line.output,
              HasSubstr("line/ezpointer.ply is left out: a point cloud of 375 x 1 pixels of 0.48 degrees"));
  EXPECT_FALSE(std::filesystem::exists(path("line/ezpointer.ply")));
  EXPECT_TRUE(std::filesystem::exists(path("line/summary.csv")));

  const Outcome far =
      dtof("frame -r sifh --table none -a 500 --scene flat --distance 100 --out far --sensor " +
           sensor("far.toml", 4, 1500, 2e3));
  EXPECT_EQ(far.exit_code, 0) << far.output;
  EXPECT_THAT(far.output, HasSubstr("far/sifh_depth_mm.png is left out: column 0, row 0: a depth of "));
  EXPECT_THAT(far.output, HasSubstr("m does not fit 16 bits of millimetres"));
  EXPECT_FALSE(std::filesystem::exists(path("far/sifh_depth_mm.png")));
  EXPECT_TRUE(std::filesystem::exists(path("far/sifh.ply")));
  EXPECT_TRUE(std::filesystem::exists(path("far/summary.csv")));

  // Plots without gnuplot.
  ASSERT_EQ(dtof(frame + "--array-columns 4 --array-rows 2 --record stream.csv --out stream").exit_code, 0);
  write_pfm(path("truth.pfm"), {.width = 4, .height = 2, .metres = std::vector<float>(8, 1.0F)});
  const std::string bare = fmt::format("PATH=/nowhere {}", DTOF_PROGRAM);
  const Outcome replay = run(bare, "replay stream.csv -a 10 -r sifh --truth truth.pfm --out replay");
  EXPECT_EQ(replay.exit_code, 0) << replay.output;
  EXPECT_THAT(replay.output, HasSubstr("replay/error.svg is left out: gnuplot does not run"));
  EXPECT_THAT(read_file(path("replay/summary.md")), Not(HasSubstr("error.svg")));
  const Outcome video =
      run(bare,
          "video --scene flat --motion still --frames 2 -r sifh --array-columns 4 --array-rows 2 "
          "-a 10 --out video");
  EXPECT_EQ(video.exit_code, 0) << video.output;
  EXPECT_THAT(video.output, HasSubstr(".svg is left out: gnuplot does not run"));
  EXPECT_THAT(read_file(path("video/video.md")), Not(HasSubstr(".svg")));
}

TEST_F(Programs, APoolReadoutsWindowsFollowThePulse) {
  const std::string sensor = file("short.toml", R"(name = "short"
[array]
columns = 34
rows = 8
field_of_view_deg = 96.0
[tdc]
range_ns = 45.0
timestamp_bits = 10
slots = 2
[laser]
acquisitions = 20
pulse_fwhm_ns = 0.5
[light]
signal_events_at_1m = 0.3
background_events_per_klux = 0.01
default_reflectivity = 1.0
)");
  const std::string frame = "frame -r poolpointer --sensor " + sensor + " --scene room --out out ";
  expect_refused(frame + "--engine rtl",
                 "no RTL of poolpointer is compiled for CELL_SHIFT=8, the windows that the pulse asks for; "
                 "compiled: 9");
  expect_refused(frame + "--cell-shift 7", "CELL_SHIFT must be 8 to 10, not 7");
  EXPECT_EQ(dtof(frame).exit_code, 0);
  EXPECT_EQ(dtof(frame + "--engine rtl --cell-shift 9 --verify").exit_code, 0);
}

TEST_F(Programs, APixelThatSawNothingHasNoDistance) {
  const auto dead = [&](const char* name, const char* pixels) {
    return file(name, fmt::format(R"(name = "d"
[array]
columns = 4
rows = 3
field_of_view_deg = 20
[tdc]
range_ns = 45
timestamp_bits = 10
[laser]
acquisitions = 300
pulse_fwhm_ns = 2.0
[light]
signal_events_at_1m = 0.12
background_events_per_klux = 0.02
[detector]
{}
)",
                                  pixels));
  };
  const std::string frame =
      "frame -r ezpointer,hispointer1,hispointer,sifh,fifh,threesteps,pifh,histogram,coarsehistogram --scene "
      "flat "
      "--out out --sensor ";
  const Outcome all = dtof(frame + dead("all.toml", "dead_pixel_share = 1.0"));
  ASSERT_EQ(all.exit_code, 0) << all.output;
  EXPECT_THAT(all.output, HasSubstr("12 pixels are dead and not judged."));
  for (const Readout readout : kRtlReadouts) {
    if (is_pool_readout(readout)) {
      continue;  // a pixel of theirs may take its neighbours' word
    }
    const std::string name = path("out/") + std::string(readout_name(readout));
    EXPECT_THAT(read_depth_image(name + "_depth_mm.png").metres, ::testing::Each(0.0F)) << name;
    EXPECT_THAT(read_file(name + ".ply"), HasSubstr("\nelement vertex 0\n")) << name;
  }
  EXPECT_THAT(read_file(path("out/summary.csv")), HasSubstr("\nSiFH,-,-,-,-,-,-,-\n"));
  const Outcome one = dtof("frame -r histogram --table none --scene flat --out out --sensor " +
                           dead("one.toml", "dead_pixels = [[2, 1]]"));
  ASSERT_EQ(one.exit_code, 0) << one.output;
  EXPECT_THAT(one.output, HasSubstr("1 pixel is dead and not judged."));
  const DepthImage depth = read_depth_image(path("out/histogram_depth_mm.png"));
  EXPECT_EQ(std::ranges::count(depth.metres, 0.0F), 1);
  EXPECT_EQ(depth.at(2, 1), 0.0F);
  EXPECT_THAT(read_file(path("out/histogram.ply")), HasSubstr("\nelement vertex 11\n"));
}

TEST_F(Programs, ALatin1NameLeavesPicturesWhole) {
  const std::string name = "mess\xfcng.npy";
  write_npy(path(name), std::vector<std::size_t>{2, 2}, std::vector<double>{1.0, 1.5, 2.0, 2.5});
  write_npy(path("messung.npy"), std::vector<std::size_t>{2, 2}, std::vector<double>{1.0, 1.5, 2.0, 2.5});
  const std::string frame = "frame -r ezpointer --table none " + kSmallScene;
  ASSERT_EQ(dtof(frame + " --depth messung.npy --out plain").exit_code, 0);
  ASSERT_EQ(dtof(frame + " --depth " + name + " --out latin").exit_code, 0);
  // A white picture has a tenth of the bytes.
  EXPECT_GT(std::filesystem::file_size(path("latin/ezpointer_depth.png")),
            std::filesystem::file_size(path("plain/ezpointer_depth.png")) * 9 / 10);
}

TEST_F(Programs, RecordAWaveform) {
  const Outcome outcome =
      run(DTOF_WAVE_PROGRAM, "frame -r fifh -e rtl --columns 0 --acquisitions 5 --trace x.fst --out out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  ASSERT_TRUE(std::filesystem::exists(path("x.fst")));
  EXPECT_GT(std::filesystem::file_size(path("x.fst")), 10'000U);
}

}  // namespace
}  // namespace dtof
