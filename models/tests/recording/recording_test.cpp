// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/recording.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "dtof/io/atomic_file.hpp"
#include "dtof/io/npy.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;

class RecordingTest : public test::IoTest {
 protected:
  static std::string format_of(const std::filesystem::path& file) {
    return read_recording({.file = file}).format;
  }
  static Recording open(const RecordingOptions& options) {
    return open_recording(options, read_recording(options));
  }
};

TEST_F(RecordingTest, ContentSaysWhatAFileIsAndElseTheName) {
  const std::string stream = "acquisition,column,row,timestamp\n0,0,0,5\n";
  for (const char* name : {"a.csv", "a.CSV", "a.txt", "a"}) {
    EXPECT_EQ(format_of(write(name, stream)), "csv") << name;
    EXPECT_EQ(format_of(write(name, "\xEF\xBB\xBF \n {}")), "tmf8829") << name;
    EXPECT_EQ(format_of(write(name, " [{}]")), "tmf8820") << name;
    EXPECT_EQ(format_of(write(name, "started\n#Raw,65,0,1\n")), "tmf8820") << name;
    EXPECT_EQ(format_of(write(name, "started\nAgg,  0, Ambient\n")), "vl53l8ch") << name;
    EXPECT_EQ(format_of(write(name, "\xEF\xBB\xBFstreamcount,cnh__hist_bin_0_a0\n")), "vl53l8ch") << name;
    EXPECT_EQ(format_of(write(name, "\x93NUMPY...")), "npy") << name;
    EXPECT_EQ(format_of(write(name, "MATLAB 5.0")), "mat") << name;
  }
  for (const auto& [name, format] : {std::pair{"a.Csv", "csv"},
                                     {"a.csv.gz", "csv"},
                                     {"a.NPY", "npy"},
                                     {"a.mat", "mat"},
                                     {"a.json", "tmf8820"}}) {
    EXPECT_EQ(format_of(write(name, "what?")), format);
  }
  test::expect_input_error([&] { (void)format_of(write("a.txt", "what?")); },
                           EndsWith("a.txt: unknown kind of recording; name it with --format"));
  EXPECT_EQ(read_recording({.file = write("a.txt", "what?"), .format = "npy"}).format, "npy");
}

TEST_F(RecordingTest, PipesAndGzipAreReadOnce) {
  const std::string stream = "acquisition,column,row,timestamp\n0,0,0,5\n2,1,0,7\n";
  write_gzip_file(path("a.csv.gz"), stream);
  for (const std::filesystem::path& file :
       {path("a.csv.gz"), pipe_of(stream), pipe_of(contents(path("a.csv.gz")))}) {
    const Recording recording = open({.file = file});
    EXPECT_EQ(recording.source->acquisitions(), 3U);
    EXPECT_THAT(recording.source->column(1).row(0), ElementsAre(Detection{2, 7}));
  }
  write_npy(path("a.npy"), std::vector<std::size_t>{2, 1}, std::vector<double>{3, 4});
  const Recording histograms = open({.file = pipe_of(contents(path("a.npy"))), .bin_width_s = 1e-9});
  EXPECT_EQ(histograms.source->columns(), 2);
  EXPECT_EQ(histograms.source->column(1).row(0).size(), 4U);
}

TEST_F(RecordingTest, LogsOfLinesAreReadInPiecesAndFromPipes) {
  const std::string log = "cnh__hist_bin_0_a0,cnh__hist_bin_1_a0\n3,0\n0,5\n";
  write_gzip_file(path("a.gz"), log);
  EXPECT_EQ(read_recording({.file = path("a.gz")}).contents, "");
  for (const std::filesystem::path& file : {write("a.csv", log), path("a.gz"), pipe_of(log)}) {
    const Recording recording = open({.file = file, .bin_width_s = 1e-9});
    EXPECT_EQ(recording.description, "ST VL53L8CH, 2 frames of 1 histograms");
    EXPECT_EQ(recording.source->column(0).row(0).size(), 3U);
    EXPECT_EQ(recording.source->column(1).row(0).size(), 5U);
  }
  EXPECT_EQ(open({.file = pipe_of(log), .format = "vl53l8ch", .bin_width_s = 1e-9}).source->columns(), 2);
  test::expect_input_error([&] { (void)open({.file = write("b.csv", "what?\n"), .format = "tmf8828"}); },
                           EndsWith("b.csv: no whole capture: one has 30 lines \"#Raw\""));
  test::expect_input_error([&] { (void)open({.file = pipe_of("[]"), .format = "tmf8820"}); },
                           EndsWith(": no captures"));
}

TEST_F(RecordingTest, RefusalsNameTheFile) {
  write_npy(path("a.npy"), std::vector<std::size_t>{2, 1}, std::vector<double>{3, 0.5});
  test::expect_input_error(
      [&] { (void)open({.file = path("a.npy"), .bin_width_s = 1e-9}); },
      path("a.npy").string() +
          ": column 1, row 0, bin 0: count 0.5 is not an integer; give a photon budget (--photons)");
  test::expect_input_error(
      [&] { (void)open({.file = path("a.npy"), .bin_width_s = -1e-9}); },
      path("a.npy").string() + ": bin width is -1e-09, must be a positive number of seconds");
}

TEST_F(RecordingTest, WhatIsLeftOutIsSaid) {
  std::string log;
  for (int index = 0; index < 30; ++index) {
    log += fmt::format("#Raw,65,{}", index);
    for (int bin = 0; bin < 128; ++bin) {
      log += index == 1 && bin == 4 ? ",9" : ",0";
    }
    log += "\n";
  }
  EXPECT_EQ(open({.file = write("a.log", log)}).description, "ams TMF8820, 1 captures of 9 zones");
  EXPECT_EQ(open({.file = pipe_of(log)}).description, "ams TMF8820, 1 captures of 9 zones");
  const std::string results = log + log + "#Obj,65,0\n" + log + log + "#Obj,65,1\n";
  EXPECT_EQ(open({.file = write("r.log", results), .format = "tmf8821", .bin_width_s = 1e-10}).description,
            "ams TMF8821, 2 captures of 16 zones");
  const std::string map = "#Conf,KIter=9 SPAD=15\n";
  EXPECT_EQ(
      open({.file = write("m.log", map + results + log + log + "#Obj,65,2\n" + log + log + "#Obj,65,3\n"),
            .bin_width_s = 1e-10})
          .description,
      "ams-OSRAM TMF8828, 1 frames of 8 x 8 zones");
  const Recording cut = open({.file = write("b.log", log + log.substr(0, 2000))});
  EXPECT_EQ(cut.description, "ams TMF8820, 1 captures of 9 zones, 1 incomplete left out");
  EXPECT_EQ(cut.source->column(0).row(0).size(), 9U);
  std::string bins = "5";
  for (int bin = 1; bin < 64; ++bin) {
    bins += ",0";
  }
  const std::string frame = R"({"results": [[{}]], "mp_histo": [[{"bin": [)" + bins + "]}]]}";
  const Recording frames =
      open({.file = write("a.json", R"({"Result_Set": [)" + frame + R"(, {"info": {}}, )" + frame + "]}")});
  EXPECT_EQ(frames.description, "ams TMF8829, 2 frames, 1 without results or histograms left out");
  EXPECT_EQ(frames.source->columns(), 2);
  EXPECT_EQ(frames.source->column(1).row(0).size(), 5U);
}

}  // namespace
}  // namespace dtof
