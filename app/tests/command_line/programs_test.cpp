// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/scene/scene.hpp"
#include "tests/run_shell.hpp"

namespace dtof {
namespace {

using test::Outcome;
using test::run_shell;

using ::testing::HasSubstr;
using ::testing::Not;

/// The program that has the command with which the arguments begin.
std::string_view program_of(std::string_view arguments) {
  constexpr std::array<std::string_view, 14> kStudies = {
      "claims",   "dynamic-range", "hostile-scenes", "frames", "enlarge", "accuracy",       "coverage",
      "fidelity", "measured",      "reproduce",      "scenes", "walk",    "sensor-effects", "speed-error"};
  const std::string_view command = arguments.substr(0, arguments.find(' '));
  return std::ranges::find(kStudies, command) != kStudies.end() ? DTOF_STUDY_PROGRAM : DTOF_PROGRAM;
}

class Programs : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / fmt::format("dtof_programs_{}", getpid());
    std::filesystem::create_directories(folder_);
    setenv("DTOF_CACHE", "off", 1);  // what is built on demand has its own test
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

  [[nodiscard]] std::string file(const std::string& name, const std::string& contents) const {
    write_file(folder_ / name, contents);
    return path(name);
  }

  [[nodiscard]] Outcome dtof(const std::string& arguments) const {
    return run(program_of(arguments), arguments);
  }

  [[nodiscard]] Outcome run(std::string_view program, const std::string& arguments) const {
    return run_shell(fmt::format("cd '{}' && {} {}", folder_.string(), program, arguments));
  }

  // Bad input: exit code 1 and exactly one line, which holds `reason`; no output folder is filled.
  void expect_refused(const std::string& arguments, const std::string& reason) const {
    SCOPED_TRACE(arguments);
    const Outcome outcome = dtof(arguments);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr(reason));
    EXPECT_THAT(outcome.output,
                ::testing::StartsWith(program_of(arguments) == DTOF_PROGRAM ? "dtof: error: "
                                                                            : "dtof-study: error: "));
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "summary.csv"));
  }

 private:
  std::filesystem::path folder_;
};

const std::string kSmallScene = "--array-columns 6 --array-rows 5 --acquisitions 300";

TEST_F(Programs, RecordAWaveform) {
  const Outcome outcome =
      run(DTOF_WAVE_PROGRAM, "frame -r fifh -e rtl --columns 0 --acquisitions 5 --trace x.fst --out out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  ASSERT_TRUE(std::filesystem::exists(path("x.fst")));
  EXPECT_GT(std::filesystem::file_size(path("x.fst")), 10'000U);
}

TEST_F(Programs, HelpTeaches) {
  const Outcome outcome = dtof("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output, HasSubstr("dtof frame --scene room"));
  const Outcome frame = dtof("frame --help");
  EXPECT_EQ(frame.exit_code, 0);
  for (const Scene scene : kAllScenes) {
    EXPECT_THAT(frame.output.substr(frame.output.find("--scene"), 200), HasSubstr(scene_name(scene)));
  }
}

TEST_F(Programs, ListNamesReadoutsPresetsScenesAndHardware) {
  const Outcome outcome = dtof("list");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* word : {"hispointer1", "threesteps", "phone", "room", "PIXELS_PER_SRAM=160"}) {
    EXPECT_THAT(outcome.output, HasSubstr(word));
  }
}

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
  ASSERT_EQ(run(DTOF_FULL_PROGRAM, frame + "--template --out told").exit_code, 0);
  EXPECT_NE(read_file(path("told/poolpointer.csv")), read_file(path("fooled/poolpointer.csv")));
  const Outcome whole =
      run(DTOF_FULL_PROGRAM, frame + "--template --verify --engine subsystem --out subsystem");
  ASSERT_EQ(whole.exit_code, 0) << whole.output;
  EXPECT_EQ(read_file(path("subsystem/poolpointer.csv")), read_file(path("told/poolpointer.csv")));
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
  std::ifstream part(path("four/fifh.csv"));
  std::string line;
  int lines = 0;
  for (std::getline(part, line); std::getline(part, line); ++lines) {
    EXPECT_THAT(whole, HasSubstr(line + "\n"));
  }
  EXPECT_EQ(lines, 5);
}

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

TEST_F(Programs, RefusesPrecisionWithoutNoise) {
  expect_refused("frame --fidelity analytic --precision 1 --out out", "no noise");
  expect_refused("frame --fidelity auto --tolerance -1 --out out", "tolerance");
  expect_refused("frame --fidelity auto --tolerance nan --out out", "tolerance");
  expect_refused("frame --precision 0 --out out", "--precision");
  expect_refused("frame -r fifh --engine rtl --trace x.fst --precision 5 --out out", "--trace");
  expect_refused("accuracy --distances 2 --fidelity analytic --out out", "no noise");
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

TEST_F(Programs, RefusesBadFlagsAndPhysics) {
  expect_refused("frame --readout ezpionter --out out", "unknown read-out 'ezpionter'");
  expect_refused("frame --readout sifh --nb 11 --out out", "NB");
  expect_refused("frame --readout ezpointer --pointer-step 512 --out out", "POINTER_STEP");
  expect_refused("frame --scene moon --out out", "moon");
  expect_refused("frame --preset sun --out out", "sun");
  expect_refused("frame --klux nan --out out", "klux");
  expect_refused("frame --klux -1 --out out", "klux");
  expect_refused("frame --dead-time -2 --out out", "dead");
  expect_refused("frame --scene flat --distance nan --out out", "distance");
  expect_refused("frame --reflectivity -0.5 --out out", "reflectivity");
  expect_refused("frame --columns 0-999 --out out", "column");
  expect_refused("frame --rows 5-2 --out out", "--rows '5-2': range '5-2' runs backwards");
  expect_refused("frame --rows 0-999 --out out", "row 999 is outside 0 to 159");
  expect_refused("frame --rows abc --out out", "'abc' is not a row number");
  expect_refused("frame --rows 0-3,7 --out out", "one range");
  expect_refused(
      "replay " + file("one.csv", "acquisition,column,row,timestamp\n0,0,1,1\n") + " --rows 0-2 --out out",
      "row 2 is outside 0 to 1");
  expect_refused("accuracy --rows 0-3 --distances 2 --out out", "--rows");
  expect_refused("scenes --rows 0-3 --out out", "--rows");
  expect_refused("frame --engine rtl --readout ezpointer --np 9 --out out", "compiled");
  expect_refused("frame --engine subsystem --readout hispointer --out out",
                 "this program has no subsystems, dtof-full has them (make full)");
  expect_refused("frame --engine subsystem -r ezpointer -a 65536 --out out", "to 65535");
  expect_refused("frame --engine subsystem -r ezpointer --trace x.fst --out out", "--engine rtl");
  expect_refused("accuracy --engine subsystem --distances 2 --out out", "subsystem");
  expect_refused("frame --verify --out out", "--engine rtl");
  expect_refused("frame --trace x.fst --engine rtl --out out", "one read-out");
  expect_refused("frame -r ezpointer --trace x.fst --engine rtl --columns 0 --out out",
                 "arrays of ezpointer record no waveforms, those of dtof-wave do");
  expect_refused("frame -r poolpointer --trace x.fst --engine rtl --columns 0-9 --out out",
                 "arrays of poolpointer record no waveforms, those of dtof-wave-pool do");
  expect_refused("frame --frobnicate --out out", "--frobnicate");
  expect_refused("accuracy --distances 0 --out out", "distances");
  expect_refused("", "no command is given; known are frame,");
  expect_refused("frame --frobnicate '' -a 3 --out out", "the value of --frobnicate is empty");
  expect_refused("frame '' --out out", "argument 2 is empty");
  expect_refused("frame --out ''", "the value of --out is empty");
  expect_refused("frame --out= -r sifh", "the value of --out is empty");
  expect_refused("frame --precision 0 --out out", "frame: --precision: 0 is not above 0");
  expect_refused("frame --gate 10 5 --out out", "the time gate, 10 to 5 ns, must be inside 0 to 45 ns");
  expect_refused("frame --sensor /dev/zero --out out", "/dev/zero: cannot read: it is a device");
  expect_refused("frame --depth /dev/zero --out out", "/dev/zero: cannot read: it is a device");
}

TEST_F(Programs, RefusesBadImages) {
  // The smallest possible 8-bit greyscale PNG is not a depth image.
  const std::string png8(
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\0\0\0\0\x3a\x7e\x9b\x55\0\0\0\nIDAT\x78\x9c\x63\x68"
      "\0\0\0"
      "\x82\0\x81\x77\xcd\x72\xb6\0\0\0\0IEND\xae\x42\x60\x82",
      67);
  expect_refused("frame --depth " + file("eight.png", png8) + " --out out", "eight.png");
  expect_refused("frame --depth nowhere.png --out out", "nowhere.png");
  expect_refused("frame --depth " + file("cut.pfm", "Pf\n4 4\n-1\nabc") + " --out out", "cut.pfm");
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
  EXPECT_THAT(outcome.output,
              HasSubstr("has fewer pixels above 3 % than the map of the large array: **1 klux: "));
  const std::string csv = read_file(path("out/enlarge.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * (1 + 2 * 3 * 4));
  EXPECT_THAT(csv, HasSubstr("1,staircase,24 x 20,poolPointer,-,480,"));
  EXPECT_THAT(csv, HasSubstr("1,hut,12 x 10,hisPointer,learned,440,"));  // 40 pixels are not known
  const std::string report = read_file(path("out/enlarge.md"));
  EXPECT_THAT(report, HasSubstr("](enlarge_1klux.png)"));
  EXPECT_THAT(report, HasSubstr("Seeds 1 to 2"));
  EXPECT_THAT(outcome.output, HasSubstr(report.substr(report.find("Small arrays whose map"), 80)));
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

/// Cell of a CSV whose lines begin with the row's name: column `column` of the row that begins with `row`.
std::string csv_cell(const std::string& csv, const std::string& row, const std::string& column) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const auto cells = [](const std::string& text) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, ',');) {
      parts.push_back(part);
    }
    return parts;
  };
  const std::vector<std::string> head = cells(line);
  const auto index = static_cast<std::size_t>(std::find(head.begin(), head.end(), column) - head.begin());
  while (std::getline(lines, line)) {
    if (line.starts_with(row + ",")) {
      return cells(line).at(index);
    }
  }
  return "no such row";
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
  expect_refused(accuracy + "--precision 5 --out out", "--precision does not apply to a map");
  expect_refused(accuracy + "--distances 3 2 --out out", "ascending edges");
  expect_refused("accuracy --depth-scale 2 --out out", "need --depth");
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
  EXPECT_THAT(read_file(path("claims/claims.md")), HasSubstr("## sunlit photons"));
  EXPECT_GT(std::filesystem::file_size(path("claims/even.svg")), 0U);
  expect_refused("claims --pixels 99 --out out", "--pixels");
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

TEST_F(Programs, RefusesBadScenesAndMeasurements) {
  expect_refused("scenes --variant hispointer --out out", "expected READOUT:PARAMETER=NUMBER");
  expect_refused("scenes --variant hispointer:COUNT_WIDTH=x --out out", "expected READOUT:PARAMETER=NUMBER");
  expect_refused("scenes --variant hispointer:GUARD=3 --out out", "hispointer has no GUARD to change");
  expect_refused("scenes --scene moon --out out", "moon");
  expect_refused("scenes --disparity nowhere.png --out out", "nowhere.png");
  expect_refused("measured nowhere.json.gz --out out", "nowhere.json.gz");
  expect_refused("measured " + file("broken.mat", "not a MATLAB file") + " --out out", "broken.mat");
  expect_refused("measured " + file("broken.json", "[{") + " --out out", "broken.json");
}

TEST_F(Programs, RefusesAnUnwritableOutput) {
  const std::string blocked = file("blocked", "a file, not a folder");
  expect_refused(fmt::format("frame -r fifh {} --out blocked/out", kSmallScene), "blocked");
  expect_refused(fmt::format("frame -r fifh {} --record nowhere/stream.csv --out out", kSmallScene),
                 "nowhere");
  EXPECT_EQ(read_file(blocked), "a file, not a folder");
}

TEST_F(Programs, TheVersionIsOneInTheWholeTree) {
  const Outcome outcome = dtof("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output, ::testing::MatchesRegex("dtof [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  const std::string version = outcome.output.substr(5, outcome.output.size() - 6);
  EXPECT_THAT(read_file(DTOF_CORE_FILE), HasSubstr("dtof_array:" + version + "\n"));
  EXPECT_THAT(read_file(DTOF_CITATION_FILE), HasSubstr("\nversion: " + version + "\n"));
}

TEST_F(Programs, UnknownWordsSuggestTheNearest) {
  expect_refused("fram --klux 3", "unknown command 'fram'; did you mean 'frame'? Known are frame, replay,");
  expect_refused("sensro", "did you mean 'sensor'?");
  expect_refused("frobnicate", "unknown command 'frobnicate'; known are frame,");
  expect_refused("frame --klxu 3",
                 "frame: unknown option '--klxu'; did you mean '--klux'? `dtof frame --help`");
  expect_refused("frame --xyzzy", "frame: unknown option '--xyzzy'; `dtof frame --help` lists the options");
  expect_refused("--versoin", "unknown option '--versoin'; did you mean '--version'?");
  expect_refused("frame --scene rom", "unknown scene 'rom'; did you mean 'room'?");
  expect_refused("frame -r sfih", "unknown read-out 'sfih'; did you mean 'sifh'?");
  expect_refused("replay a.csv b.csv", "unexpected argument 'b.csv'");
}

TEST_F(Programs, WhatIsNoNumberIsSaidSo) {
  expect_refused("frame --klux abc", "frame: --klux: 'abc' is not a number");
  expect_refused("frame --klux inf", "frame: --klux: 'inf' is not a number");
  expect_refused("frame --gate 1 x", "frame: --gate: 'x' is not a number");
  expect_refused("frame --np 9.5", "frame: --np: '9.5' is not a whole number");
  expect_refused("frame --np 99999999999", "--np = 99999999999 is beyond what the option can hold");
  expect_refused("frame --np 100", "NP must be 3 to 16, not 100");
  expect_refused("frame --seed -1", "frame: --seed: '-1' is negative");
  expect_refused("frame --seed 99999999999999999999", "'99999999999999999999' is too large");
  expect_refused("walk --seed -1", "walk: --seed: '-1' is negative");
  expect_refused("frame --threads 010", "'010' begins with 0");
}

TEST_F(Programs, NonsenseIsRefusedWithAReason) {
  expect_refused("frame --klux 1e30",
                 "1e30 is not within 0 to 200 klux: the brightest sunlight is about 130");
  expect_refused("accuracy --klux 14 300", "300 is not within 0 to 200 klux");
  expect_refused("scenes --klux 300", "300 is not within 0 to 200 klux");
  expect_refused("frame --reflectivity 4.1", "a white matt surface is 1");
  expect_refused("accuracy --reflectivity 4.1", "a white matt surface is 1");
  expect_refused("frame --scene flat --distance 6.75", "beyond the sensor's range, 6.75 m");
  expect_refused("frame --scene plane --far 7", "--far: 7 m is beyond the sensor's range");
  expect_refused("accuracy --distances 1 7", "--distances: 7 m is beyond the sensor's range");
}

TEST_F(Programs, MemoryIsRefusedBeforeItIsSpent) {
  for (const char* command : {"frame", "accuracy"}) {
    expect_refused(std::string(command) + " -a 4294967295", "4294967295 is not within 1 to 1048575");
    expect_refused(std::string(command) + " -a 4294967296", "4294967296 is not within 1 to 1048575");
  }
  expect_refused("frame --array-columns 1 --array-rows 4096 -a 1000000 --out out",
                 "a column could have 8.2e+09 detections");
  std::string captures = R"([{"dist_to_plane": 1, "reference_hist": [)";
  const auto append_bins = [&](std::string_view first) {
    captures += first;
    for (int bin = 1; bin < 128; ++bin) {
      captures += ",0";
    }
    captures += "]";
  };
  append_bins("0");
  captures += R"(, "hists": [)";
  for (int zone = 0; zone < 9; ++zone) {
    captures += zone == 0 ? "[" : ",[";
    append_bins("4294967295");
  }
  captures += "]}]";
  expect_refused("replay " + file("many.json", captures) + " --out out",
                 "column 0, row 0: 4294967295 photons are more than the 1e+07");
  const std::vector<std::size_t> shape = {1, 2};
  write_npy(path("many.npy"), shape, std::vector<double>{0.0, 4294967296.0});
  expect_refused("replay many.npy --bin-width 100 --out out", "give a photon budget (--photons)");
  EXPECT_EQ(dtof("replay many.npy --bin-width 100 --photons 50 -r sifh --out out").exit_code, 0);
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
                 "an engine of just 7 columns, which hear each other; compiled are: poolpointer");
  const Outcome all = dtof(frame + "-r all");
  ASSERT_EQ(all.exit_code, 0) << all.output;
  EXPECT_THAT(all.output, HasSubstr("poolPointer is left out: its RTL is not compiled for 7 columns"));
  EXPECT_FALSE(std::filesystem::exists(path("out/poolpointer.csv")));
  EXPECT_TRUE(std::filesystem::exists(path("out/coarsehistogram.csv")));
}

TEST_F(Programs, WhatCanBeRefusedIsRefusedBeforeTheFirstFile) {
  expect_refused("frame -r ezpointer,sifh --nb 7 --engine rtl --out out", "no RTL is compiled for sifh");
  expect_refused("frame -r ezpointer --engine rtl -a 65536 --array-columns 1 --array-rows 1 --out out",
                 "the RTL counts 16 bits of them, to 65535");
  expect_refused("frame -r ezpointer --engine rtl --trace x.fst --record stream.csv --out out",
                 "record no waveforms");
  const Outcome wide =
      run(DTOF_WAVE_PROGRAM, "frame -r ezpointer --engine rtl --trace x.fst --record stream.csv --out out");
  EXPECT_EQ(wide.exit_code, 1);
  EXPECT_THAT(wide.output, HasSubstr("a waveform holds at most SRAM_NUM"));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
  EXPECT_FALSE(std::filesystem::exists(path("stream.csv")));
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

TEST_F(Programs, WhatTheSensorCannotReachIsRefusedOrCountedApart) {
  const auto map = [&](const char* name, std::vector<double> values) {
    const std::array<std::size_t, 2> shape = {1, values.size()};
    write_npy(path(name), shape, values);
    return std::string(name);
  };
  const std::string frame = "frame -r histogram --table none --array-columns 4 --array-rows 2 --out out ";
  expect_refused(
      frame + "--depth " + map("mm.npy", {1000.0, 2257.0}),
      "mm.npy: every pixel is beyond the sensor's range, 6.75 m (light there and back in 45 ns), the "
      "nearest at 1000 m; if these are millimetres, use --depth-scale 0.001");
  expect_refused(frame + "--depth " + map("far.npy", {10.0, 12.0}), "range, 6.75 m");
  expect_refused(frame + "--depth " + map("nan.npy", {std::nan(""), std::nan("")}),
                 "no pixel has a distance");
  expect_refused(frame + "--depth " + map("huge.npy", {1.0, 1e39}),
                 "huge.npy: column 1, row 0: a depth of 1e+39 m is too large a number");
  expect_refused(
      frame + "--reflectivity-map " + map("glint.npy", {1.0, 4.5}),
      "glint.npy: column 1, row 0: a reflectivity of 4.5 is not within 0 to 4: a white matt surface");
  EXPECT_EQ(dtof(frame + "--depth mm.npy --depth-scale 0.001").exit_code, 0);

  // Half of the pixels are in range; the figures are theirs alone.
  const Outcome half = dtof(frame + "--depth " + map("half.npy", {1.0, 10.0}));
  ASSERT_EQ(half.exit_code, 0) << half.output;
  EXPECT_THAT(half.output,
              HasSubstr("4 pixels are beyond the sensor's range, 6.75 m (light there and back in "
                        "45 ns), and not judged."));
  const std::string figures = read_file(path("out/summary.csv"));
  ASSERT_EQ(dtof(frame + "--columns 0-1 --depth half.npy").exit_code, 0);
  EXPECT_EQ(read_file(path("out/summary.csv")), figures);
  const Outcome known = dtof(frame + "--depth " + map("known.npy", {1.0, 0.0, 10.0, 2.0}));
  EXPECT_THAT(known.output,
              HasSubstr("2 pixels are without a true distance and not judged. 2 pixels are beyond"));

  // A scene of the program's own, with a sensor that ends before its far walls.
  ASSERT_EQ(dtof("sensor thesis > short.toml").exit_code, 0);
  std::string text = read_file(path("short.toml"));
  const std::size_t range = text.find("range_ns");
  text.replace(range, text.find('\n', range) - range, "range_ns = 20");
  const std::string short_range = file("short.toml", text);
  const Outcome room = dtof("frame -r coarsehistogram --table none --out room --sensor " + short_range);
  ASSERT_EQ(room.exit_code, 0) << room.output;
  EXPECT_THAT(room.output, HasSubstr("pixels are beyond the sensor's range, 3.00 m"));
  EXPECT_LT(std::stod(csv_cell(read_file(path("room/summary.csv")), "coarse histogram", "above 10 %")), 20.0);
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

TEST_F(Programs, OptionsWithoutEffectAreErrors) {
  expect_refused("frame --cell-shift 8 -r sifh", "--cell-shift has no effect: sifh has no CELL_SHIFT");
  expect_refused("frame --guard 3 -r sifh", "--guard has no effect: sifh has no GUARD");
  expect_refused("frame --nb 5 -r ezpointer", "--nb has no effect: ezpointer has no NB");
  expect_refused("frame --window-centred -r ezpointer,fifh",
                 "--window-centred has no effect: ezpointer,fifh");
  expect_refused("frame --pointer-step 2 -r poolpointer", "--pointer-step has no effect");
  expect_refused("frame --distance 3 --scene room", "--distance has no effect: only --scene flat");
  expect_refused("frame --near 1 --scene flat", "--near has no effect");
  expect_refused("frame --steps 3 --scene plane", "--steps has no effect");
  expect_refused("frame --depth a.png --scene room", "--scene has no effect: --depth takes its place");
  expect_refused("frame --depth a.png --distance 2", "--distance has no effect");
  expect_refused("frame --max-frames 9", "--max-frames has no effect");
  expect_refused("accuracy --max-frames 9", "--max-frames has no effect");
  expect_refused("frame --tolerance 0.1", "--tolerance has no effect: only --fidelity auto has one");
  expect_refused("scenes --variant ezpointer:COUNT_WIDTH=8", "ezpointer has no COUNT_WIDTH to change");
  expect_refused("scenes --nearest 2", "--nearest has no effect");
  expect_refused("scenes --surface a.mat", "--surface has no effect");
  expect_refused("measured a.json --tick 8", "--tick has no effect");
  const std::string stream = file("one.csv", "acquisition,column,row,timestamp\n0,0,1,1\n");
  expect_refused("replay " + stream + " --photons 3", "--photons has no effect");
  expect_refused("replay " + stream + " --tick 3", "--tick has no effect");
  expect_refused("replay " + stream + " --bin-width 3", "--bin-width has no effect");
  expect_refused("replay " + file("a.npy", "\x93NUMPY") + " --bin-width 3 --array-rows 3",
                 "--array-rows has no effect");
  // The same options where they have one, also for one read-out of several.
  const std::string small = kSmallScene + " --out out ";
  EXPECT_EQ(dtof("frame -r sifh,hispointer --guard 3 --scene flat --distance 3 " + small).exit_code, 0);
  EXPECT_EQ(dtof("frame -r sifh,ezpointer --nb 5 --scene staircase --near 1 --steps 3 " + small).exit_code,
            0);
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

TEST_F(Programs, AStandardOutputThatIsFullIsAFailure) {
  for (const char* command : {"sensor thesis", "list"}) {
    const Outcome outcome = dtof(std::string(command) + " 2>said >/dev/full; code=$?; cat said; exit $code");
    EXPECT_EQ(outcome.exit_code, 4) << command;
    EXPECT_EQ(outcome.output, "dtof: error: standard output: cannot write: No space left on device\n");
  }
  EXPECT_EQ(dtof("sensor thesis 2>/dev/null >&-; exit $?").exit_code, 4);
}

TEST_F(Programs, ClosedStreamsGiveNoFileTheirNumbers) {
  const Outcome refused = dtof("frame --sensor nothere 2>&- >/dev/null");
  EXPECT_EQ(refused.exit_code, 1);
  const Outcome outcome =
      dtof("frame -r ezpointer --scene flat --table none --out out " + kSmallScene + " 2>&- <&- >/dev/null");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(read_file(path("out/summary.csv")), ::testing::StartsWith("read-out,"));
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

TEST_F(Programs, TheCommandOnAPageRunsInAShell) {
  write_npy(path("a b&c.npy"), std::vector<std::size_t>{2, 2}, std::vector<double>{1.0, 1.5, 2.0, 2.5});
  ASSERT_EQ(dtof("frame -r ezpointer --table none --depth 'a b&c.npy' --out 'x y' " + kSmallScene).exit_code,
            0);
  const std::string page = read_file(path("x y/summary.md"));
  const std::size_t begin = page.find("Command: `dtof ") + std::string_view("Command: `dtof ").size();
  const std::string arguments = page.substr(begin, page.find('`', begin) - begin);
  EXPECT_THAT(arguments, HasSubstr("--depth 'a b&c.npy' --out 'x y'"));
  std::filesystem::rename(path("x y"), path("first"));
  ASSERT_EQ(dtof(arguments).exit_code, 0);
  EXPECT_EQ(read_file(path("x y/summary.md")), page);
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

TEST_F(Programs, ASensorFileMayBeginWithAByteOrderMark) {
  const Outcome preset = dtof("sensor thesis");
  const Outcome marked = dtof("sensor " + file("marked.toml", "\xEF\xBB\xBF" + preset.output));
  EXPECT_EQ(marked.exit_code, 0) << marked.output;
  EXPECT_THAT(marked.output, HasSubstr("# What follows:"));
}

}  // namespace
}  // namespace dtof
