// SPDX-License-Identifier: Apache-2.0
// What the program says and leaves behind when it writes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"
#include "tests/io/io_test_support.hpp"
#include "tests/run_shell.hpp"

namespace dtof {
namespace {

using test::Outcome;
using test::run_shell;

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kSmall = "--array-columns 4 --array-rows 3 --acquisitions 100 --table none";
constexpr const char* kHeader = "acquisition,column,row,timestamp\n";

class Outputs : public test::IoTest {
 protected:
  [[nodiscard]] Outcome dtof(const std::string& arguments, const std::string& before = "") const {
    return run_shell(fmt::format("cd '{}' && {} {} {}", path("").string(), before, DTOF_PROGRAM, arguments));
  }
  /// This exit code, and one line that ends with the reason.
  void expect_error(int exit_code, const std::string& arguments, const std::string& reason,
                    const std::string& before = "") const {
    SCOPED_TRACE(arguments);
    const Outcome outcome = dtof(arguments, before);
    EXPECT_EQ(outcome.exit_code, exit_code);
    EXPECT_THAT(outcome.output, StartsWith("dtof: error: "));
    EXPECT_THAT(outcome.output, EndsWith(reason + "\n"));
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
  }
};

TEST_F(Outputs, WhatCannotBeWrittenIsAFailureAndNoBadInput) {
  const std::string frame = fmt::format("frame -r ezpointer {} ", kSmall);
  expect_error(4, frame + "--out out --record /dev/full", "/dev/full: cannot write: No space left on device");
  expect_error(4, frame + "--out out --record none/a.csv",
               "none/a.csv: cannot write: No such file or directory");
  expect_error(4, frame + "--out out --record a.csv.gz", "a.csv.gz: cannot write: File too large",
               "trap '' XFSZ; ulimit -f 0;");
  (void)write("file", "");
  expect_error(4, frame + "--out file/out", "file/out: cannot create the output folder: Not a directory");
  (void)write("a.csv", std::string(kHeader) + "0,0,0,5\n");
  expect_error(4, "replay a.csv -r sifh --out file/out",
               "file/out: cannot create the output folder: Not a directory");
  for (const char* name : {"none/a.npz", "none/a.npy"}) {
    expect_error(4, std::string("convert a.csv ") + name,
                 std::string(name) + ": cannot write: No such file or directory");
  }
  expect_error(1, "convert none.csv a.npz", "none.csv: cannot read: No such file or directory");
}

TEST_F(Outputs, APackedRecordingIsReplayedAsAPlainOne) {
  const std::string frame = fmt::format("frame -r ezpointer {} --out out --record ", kSmall);
  ASSERT_EQ(dtof(frame + "a.csv").exit_code, 0);
  ASSERT_EQ(dtof(frame + "a.csv.gz").exit_code, 0);
  EXPECT_EQ(contents(path("a.csv.gz")).substr(0, 2), "\x1f\x8b");
  EXPECT_EQ(read_file_or_gzip(path("a.csv.gz")), contents(path("a.csv")));
  for (const char* name : {"a.csv", "a.csv.gz"}) {
    const Outcome replay = dtof(fmt::format("replay {} -r ezpointer --out out_{}", name, name));
    ASSERT_EQ(replay.exit_code, 0) << replay.output;
  }
  EXPECT_EQ(contents(path("out_a.csv/ezpointer.csv")), contents(path("out_a.csv.gz/ezpointer.csv")));
  (void)write("rest.csv.gz", contents(path("a.csv.gz")) + "rest");
  expect_error(1, "replay rest.csv.gz -r ezpointer --out rest",
               "rest.csv.gz: damaged gzip data: other bytes follow");
}

TEST_F(Outputs, TimestampsOfAllOnesAreNoDetectionsInReplayAndConvert) {
  (void)write("a.csv", std::string(kHeader) + "0,0,0,1023\n0,1,0,100\n1,1,0,1023\n2,1,0,100\n");
  const Outcome replay = dtof("replay a.csv -r histogram --out out");
  EXPECT_THAT(replay.output, StartsWith("a.csv (recorded stream, 2 detections): 2 columns x 1 rows"));
  write_npy(path("truth.npy"), std::vector<std::size_t>{1, 2}, std::vector<double>{1.0, 1.0});
  EXPECT_THAT(dtof("replay a.csv -r histogram --truth truth.npy --out out").output,
              HasSubstr("1 pixel is without a detection and not judged."));
  EXPECT_THAT(dtof("convert a.csv a.npy").output, HasSubstr("recorded stream, 2 detections: histograms"));
  EXPECT_EQ(dtof("convert a.csv b.csv").exit_code, 0);
  EXPECT_EQ(contents(path("b.csv")), std::string(kHeader) + "0,1,0,100\n2,1,0,100\n");
}

TEST_F(Outputs, ReplayOfAPartCountsTheDetectionsOfThisPart) {
  (void)write("a.csv", std::string(kHeader) + "0,0,0,5\n0,1,0,6\n1,1,0,7\n2,1,1,8\n");
  EXPECT_THAT(dtof("replay a.csv -r histogram --out out").output,
              StartsWith("a.csv (recorded stream, 4 detections): 2 columns x 2 rows"));
  EXPECT_THAT(
      dtof("replay a.csv -r histogram --out out --columns 1 --rows 0").output,
      StartsWith("a.csv (recorded stream, 4 detections, 2 of them in the pixels read): 1 columns x 1 rows"));
}

TEST_F(Outputs, PicturesOfOneValueAreDrawnWithoutWarnings) {
  if (run_shell("gnuplot --version").exit_code != 0) {
    GTEST_SKIP() << "gnuplot is not installed";
  }
  const std::string one = "--array-columns 1 --array-rows 1 --acquisitions 100";
  const Outcome video = dtof(fmt::format("video --scene flat --motion still --frames 2 {} --out out", one));
  EXPECT_EQ(video.exit_code, 0);
  EXPECT_THAT(video.output, Not(HasSubstr("arning")));
  EXPECT_THAT(contents(path("out/flat_still.svg")), HasSubstr("</svg>"));
  (void)write("a.csv", std::string(kHeader) + "0,0,0,500\n1,0,0,500\n2,0,0,500\n");
  write_npy(path("truth.npy"), std::vector<std::size_t>{1, 1}, std::vector<double>{2.0});
  const Outcome replay = dtof("replay a.csv -r histogram --truth truth.npy --out out");
  EXPECT_EQ(replay.exit_code, 0);
  EXPECT_THAT(replay.output, Not(HasSubstr("arning")));
  EXPECT_THAT(contents(path("out/error.svg")), HasSubstr("</svg>"));
  // A gnuplot that fails: its last complaint is in the line, and nothing is left behind.
  (void)write("gnuplot", "#!/bin/sh\n[ \"$1\" = --version ] && exit\ncat >/dev/null\necho odd >&2\nexit 3\n");
  std::filesystem::permissions(path("gnuplot"), std::filesystem::perms::owner_all);
  const Outcome failed = dtof("replay a.csv -r histogram --truth truth.npy --out other",
                              fmt::format("PATH='{}':\"$PATH\"", path("").string()));
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.output,
            "dtof: error: other/error.svg: cannot plot: gnuplot failed (is it installed?): odd\n");
  EXPECT_FALSE(std::filesystem::exists(path("other/error.svg.gnuplot")));
  // One that a full disk stops, which gnuplot does not notice.
  for (const char* drawn : {"", "<svg"}) {
    (void)write("gnuplot", std::string("#!/bin/sh\n[ \"$1\" = --version ] && exit\n"
                                       "out=$(sed -n \"s/^set output '\\(.*\\)'/\\1/p\")\nprintf '") +
                               drawn + "' >\"$out\"\n");
    expect_error(4, "replay a.csv -r histogram --truth truth.npy --out other",
                 "other/error.svg: cannot write: gnuplot's picture is not whole",
                 fmt::format("PATH='{}':\"$PATH\"", path("").string()));
    EXPECT_FALSE(std::filesystem::exists(path("other/error.svg.gnuplot")));
    EXPECT_FALSE(std::filesystem::exists(path("other/error.svg")));
  }
}

TEST_F(Outputs, PicturesDoNotDependOnTheNumberOfThreads) {
  const std::string frame = fmt::format("frame -r ezpointer {} --out out ", kSmall);
  ASSERT_EQ(dtof(frame + "--threads 1").exit_code, 0);
  const std::string overview = contents(path("out/overview.png"));
  const std::string errors = contents(path("out/errors.png"));
  ASSERT_EQ(dtof(frame + "-j 2").exit_code, 0);
  EXPECT_EQ(contents(path("out/overview.png")), overview);
  EXPECT_EQ(contents(path("out/errors.png")), errors);
}

TEST_F(Outputs, ByteZeroOfAFileIsSeenInTheMessage) {
  (void)write("a.csv", kHeader + std::string("0,0,0,1\0\n", 9));
  expect_error(1, "replay a.csv -r sifh --out out", "a.csv:2: timestamp \"1\\0\" is not a decimal integer");
  (void)write("b.csv", kHeader + std::string("0,0,0,\0\0\n", 9));
  expect_error(1, "replay b.csv -r sifh --out out", "b.csv:2: timestamp \"\\0\\0\" is not a decimal integer");
}

TEST_F(Outputs, RecordingsHaveAcquisitions) {
  write_npy(path("a.npy"), std::vector<std::size_t>{1, 8}, std::vector<double>(8, 1.0));
  const std::string replay = "replay a.npy --bin-width 1000 -r sifh --out out ";
  EXPECT_EQ(dtof(replay + "--acquisitions 0").exit_code, 1);
  EXPECT_EQ(dtof(replay + "--acquisitions 1").exit_code, 0);
  expect_error(1, replay + "--shift 1e300",
               "--shift: 1e300 is not within -1000000000 to 1000000000 ns, a second");
  expect_error(1, replay + "--t-int 0", "--t-int: 0 is not above 0");
}

TEST_F(Outputs, OtherFilesOfTheOutputFolderDoNotMatter) {
  std::filesystem::create_symlink("self", path("self"));
  const std::string frame = fmt::format("frame -r ezpointer {} --out .", kSmall);
  const Outcome outcome = dtof(frame);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  const Outcome json = dtof(frame + " --json 2>/dev/null");
  EXPECT_EQ(json.exit_code, 0);
  EXPECT_THAT(json.output, HasSubstr("\"ezpointer.csv\""));
}

TEST_F(Outputs, OptionsWithoutSenseAreRefused) {
  const std::string frame = fmt::format("frame -r sifh {} --out out ", kSmall);
  expect_error(1, frame + "--code-gate 5 1", "--code-gate: no code is at least 5 and below 1");
  expect_error(1, frame + "--code-gate 5 5", "--code-gate: no code is at least 5 and below 5");
  expect_error(1, "--completion zsh", "--completion: zsh not in {bash}");
  expect_error(1, "--json", "`dtof --help` explains them");
}

TEST_F(Outputs, AnInterruptionEndsTheWaitForAPipe) {
  ASSERT_EQ(run_shell(fmt::format("mkfifo '{}'", path("pipe").string())).exit_code, 0);
  const std::string soon = "timeout --preserve-status --signal INT --kill-after 5 0.5";
  for (const char* command : {"convert pipe a.npz", "replay pipe -r sifh --format csv", "frame --depth pipe",
                              "replay pipe -r sifh --format picoquant"}) {
    expect_error(130, command, "interrupted", soon);
    expect_error(130, command, "interrupted",
                 "{ timeout 2 sh -c 'sleep 2 >pipe' >/dev/null 2>&1 & } && " + soon);
  }
}

}  // namespace
}  // namespace dtof
