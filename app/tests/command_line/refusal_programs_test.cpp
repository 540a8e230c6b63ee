// SPDX-License-Identifier: Apache-2.0
// What the programs refuse: one line, and no file.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

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

TEST_F(Programs, RefusesPrecisionWithoutNoise) {
  expect_refused("frame --fidelity analytic --precision 1 --out out", "no noise");
  expect_refused("frame --fidelity auto --tolerance -1 --out out", "tolerance");
  expect_refused("frame --fidelity auto --tolerance nan --out out", "tolerance");
  expect_refused("frame --precision 0 --out out", "--precision");
  expect_refused("frame -r fifh --engine rtl --trace x.fst --precision 5 --out out", "--trace");
  expect_refused("frame --host-filter --precision 5 --out out", "--host-filter works on one frame");
  expect_refused("frame --host-filter --columns 0-3,5 --out out", "--columns must be one range");
  expect_refused("accuracy --distances 2 --fidelity analytic --out out", "no noise");
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

TEST_F(Programs, RefusesAnOptionThatIsGivenTwice) {
  expect_refused("frame --columns 0 --columns 1 --out out", "frame: --columns is given twice");
  expect_refused("frame --rows 0-3 --rows 4-5 --out out", "frame: --rows is given twice");
  expect_refused("frame -r ezpointer --readout=sifh --out out", "frame: --readout is given twice");
  expect_refused("frame --klux 1 --klux 2 -k 3 --out out", "frame: --klux is given 3 times");
  expect_refused("frame --gate 1 2 --gate 3 4 --out out", "frame: --gate is given twice");
  expect_refused("frame --np 9 --np 8 --out out", "frame: --np is given twice");
  expect_refused("scenes -r sifh -r fifh --out out", "scenes: --readout is given twice");
  expect_refused("frame --readout ezpointer,ezpointer --out out", "--readout: ezpointer is named twice");
}

TEST_F(Programs, RefusesARecordingInPlaceOfAResult) {
  std::filesystem::create_directories(path("there"));
  std::filesystem::create_directory_symlink("there", path("link"));
  const std::string small = fmt::format("frame -r ezpointer {}", kSmallScene);
  const std::string reason = " is a result of the command; choose another file";
  for (const std::string name : {"out/ezpointer.csv", "out/summary.csv", "./out/../out/errors.png"}) {
    expect_refused(fmt::format("{} --out out --record {}", small, name), "--record: " + name + reason);
  }
  expect_refused(fmt::format("{} --out link --record there/summary.md", small), reason);
  expect_refused(fmt::format("{} --engine rtl --trace a.fst --out out --record ./a.fst", small),
                 "--record and --trace are one file");
  EXPECT_FALSE(std::filesystem::exists(path("out")));
  EXPECT_EQ(dtof(fmt::format("{} --out there --record there/stream.csv", small)).exit_code, 0);
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
  constexpr int kUnwritable = 4;
  expect_refused(fmt::format("frame -r fifh {} --out blocked/out", kSmallScene), "blocked", kUnwritable);
  expect_refused(fmt::format("frame -r fifh {} --record nowhere/stream.csv --out out", kSmallScene),
                 "nowhere", kUnwritable);
  // before its work, which takes minutes
  expect_refused("design --sensor thesis --out blocked/out", "blocked", kUnwritable);
  EXPECT_EQ(read_file(blocked), "a file, not a folder");
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
  for (const std::string command : {"sensor", "design", "product -r sifh"}) {
    expect_refused(command + " --frame-rate 1e-300",
                   "--frame-rate: 1e-300 is not within 0.001 to 1000000 frames/s");
    expect_refused(command + " --frame-rate 30 --clock-mhz 1e308",
                   "--clock-mhz: 1e308 is not within 0.001 to 100000 MHz");
  }
  expect_refused("design --frames 1", "--frames: 1 is not within 2 to 1000: an interval needs two");
  expect_refused("replay a.csv --offset 1e300", "--offset: 1e300 is not within -100000000 to 100000000 mm");
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

TEST_F(Programs, WhatCanBeRefusedIsRefusedBeforeTheFirstFile) {
  expect_refused("frame -r ezpointer,sifh --nb 7 --engine rtl --out out", "no RTL is compiled for sifh");
  expect_refused("frame -r ezpointer --engine rtl -a 65536 --array-columns 1 --array-rows 1 --out out",
                 "the RTL counts 16 bits of them, to 65535");
  expect_refused("frame -r ezpointer --engine rtl --trace x.fst --record stream.csv --out out",
                 "record no waveforms");
  expect_refused("design --sensor thesis --max-mm2 0.001 --out out", "one of these would do");
  const Outcome wide =
      run(DTOF_WAVE_PROGRAM, "frame -r ezpointer --engine rtl --trace x.fst --record stream.csv --out out");
  EXPECT_EQ(wide.exit_code, 1);
  EXPECT_THAT(wide.output, HasSubstr("a waveform holds at most SRAM_NUM"));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
  EXPECT_FALSE(std::filesystem::exists(path("stream.csv")));
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
  expect_refused("measured a.json --from-tick 8", "--from-tick has no effect");
  expect_refused("measured a.mat --surfaces b.mat --bin-width 8", "--bin-width has no effect");
  expect_refused("measured " + file("t.npy", "\x93NUMPY") + " --tick 8", "--tick has no effect");
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

}  // namespace
}  // namespace dtof
