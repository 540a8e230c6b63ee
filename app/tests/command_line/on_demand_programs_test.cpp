// SPDX-License-Identifier: Apache-2.0
// What a user sees of arrays that the program builds.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "dtof/io/input_file.hpp"
#include "tests/run_shell.hpp"

namespace dtof {
namespace {

using test::Outcome;
using test::run_shell;

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSensor = R"(name = "small"
[array]
columns = 8
rows = 6
field_of_view_deg = 40.0
[tdc]
range_ns = 45.0
timestamp_bits = {}
slots = 2
[laser]
acquisitions = 60
pulse_fwhm_ns = 2.0
[light]
signal_events_at_1m = 0.3
background_events_per_klux = 0.01
default_reflectivity = 1.0
)";

class OnDemandPrograms : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / fmt::format("dtof_on_demand_programs_{}", getpid());
    std::filesystem::create_directories(folder_);
    setenv("DTOF_CACHE", (folder_ / "cache").c_str(), 1);
    for (const int bits : {8, 12}) {
      std::ofstream(folder_ / fmt::format("bits{}.toml", bits)) << fmt::format(fmt::runtime(kSensor), bits);
    }
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// `before`: of the shell, such as NAME=value.
  [[nodiscard]] Outcome frame(const std::string& arguments, const std::string& before = "") const {
    return shell(fmt::format("{} {} frame --table none {}", before, DTOF_PROGRAM, arguments));
  }
  [[nodiscard]] Outcome shell(const std::string& command) const {
    return run_shell(fmt::format("cd '{}' && ( {} )", folder_.string(), command));
  }
  [[nodiscard]] std::string file(const std::string& name) const { return read_file(folder_ / name); }
  /// Names in the cache, without locks.
  [[nodiscard]] std::vector<std::string> kept() const {
    std::vector<std::string> names;
    if (std::filesystem::exists(folder_ / "cache")) {
      for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache")) {
        if (entry.path().extension() != ".lock") {
          names.push_back(entry.path().filename().string());
        }
      }
    }
    return names;
  }
  /// A folder to put in front of PATH, with a program of this name.
  [[nodiscard]] std::string with_program(const std::string& name, const std::string& script) const {
    const std::filesystem::path bin = folder_ / "bin";
    std::filesystem::create_directories(bin);
    std::ofstream(bin / name) << "#!/bin/sh\n" << script;
    std::filesystem::permissions(bin / name, std::filesystem::perms::owner_all);
    return bin.string();
  }

  std::filesystem::path folder_;
};

TEST_F(OnDemandPrograms, ASmallSensorsRtlIsBuiltOnceAndGivesTheModelsFiles) {
  for (const int bits : {8, 12}) {
    SCOPED_TRACE(bits);
    const std::string what = fmt::format("--sensor bits{}.toml -r sifh,poolpointer --own-rows ", bits);
    ASSERT_EQ(frame(what + "--out model").exit_code, 0);
    const Outcome first = frame(what + "--engine rtl --verify --out first");
    ASSERT_EQ(first.exit_code, 0) << first.output;
    EXPECT_THAT(first.output,
                AllOf(HasSubstr("Builds the RTL of sifh"), HasSubstr("Builds the RTL of poolpointer"),
                      HasSubstr("every pixel equal to the model")));
    const Outcome second = frame(what + "--engine rtl --out second");
    ASSERT_EQ(second.exit_code, 0) << second.output;
    EXPECT_THAT(second.output, Not(HasSubstr("Builds")));
    for (const char* name : {"sifh.csv", "poolpointer.csv"}) {
      EXPECT_EQ(file(fmt::format("first/{}", name)), file(fmt::format("model/{}", name)));
      EXPECT_EQ(file(fmt::format("second/{}", name)), file(fmt::format("model/{}", name)));
    }
  }
  // A region needs no array of its own.
  const Outcome region =
      frame("--sensor bits8.toml -r sifh --rows 2-4 --columns 1-3 --engine rtl --verify --out region");
  EXPECT_EQ(region.exit_code, 0) << region.output;
  EXPECT_THAT(region.output, Not(HasSubstr("Builds")));
}

TEST_F(OnDemandPrograms, ADamagedArrayIsBuiltAgain) {
  const std::string what = "--sensor bits8.toml -r ezpointer --engine rtl --verify --out out";
  ASSERT_EQ(frame(what).exit_code, 0);
  ASSERT_EQ(kept().size(), 1U);
  {
    std::fstream library(folder_ / "cache" / kept().front() / "array.so",
                         std::ios::in | std::ios::out | std::ios::binary);
    library.seekp(5000);
    library.put('\x55');
    library.put('\xAA');
  }
  const Outcome again = frame(what);
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_THAT(again.output, AllOf(HasSubstr("is damaged and is built again"), HasSubstr("Builds the RTL")));
  EXPECT_THAT(frame(what).output, Not(HasSubstr("Builds")));
}

TEST_F(OnDemandPrograms, TwoProgramsAtOnceBuildAnArrayOnce) {
  const std::string what =
      fmt::format("{} frame --table none --sensor bits8.toml -r fifh --engine rtl --verify", DTOF_PROGRAM);
  const Outcome both = shell(
      fmt::format("{0} --out a > a.txt 2>&1 & {0} --out b > b.txt 2>&1; two=$?; wait $! && exit $two", what));
  EXPECT_EQ(both.exit_code, 0) << both.output;
  const std::string said = file("a.txt") + file("b.txt");
  const std::size_t first = said.find("Builds the RTL");
  ASSERT_NE(first, std::string::npos) << said;
  EXPECT_EQ(said.find("Builds the RTL", first + 1), std::string::npos) << said;
  EXPECT_EQ(file("a/fifh.csv"), file("b/fifh.csv"));
  EXPECT_EQ(kept().size(), 1U);
}

TEST_F(OnDemandPrograms, AnInterruptedBuildLeavesNothing) {
  const std::string slow = with_program(
      "slow-c++", "[ \"$1\" = --version ] && echo slow && exit\necho $$ > compiler\nsleep 300\n");
  const Outcome stopped = shell(fmt::format(
      "CXX={}/slow-c++ {} frame --table none --sensor bits8.toml -r fifh --engine rtl --out out & "
      "for i in $(seq 300); do sleep 0.1; found=$(find cache -name compiler 2> /dev/null) && [ -n \"$found\" "
      "] && [ -s $found ] && break; "
      "done; compiler=$(cat $found); kill -INT $!; wait $!; code=$?; sleep 0.2; kill -0 $compiler 2> "
      "/dev/null && echo lives; exit $code",
      slow, DTOF_PROGRAM));
  EXPECT_NE(stopped.exit_code, 0);
  EXPECT_THAT(stopped.output, AllOf(HasSubstr("interrupted"), Not(HasSubstr("lives"))));
  EXPECT_THAT(kept(), testing::IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(OnDemandPrograms, WhatIsMissingIsSaidInOneLine) {
  const std::string what = "--sensor bits8.toml -r fifh --engine rtl --out out";
  const auto refused = [&](const std::string& before, const std::string& reason, int exit_code = 1) {
    SCOPED_TRACE(reason);
    const Outcome outcome = frame(what, before);
    EXPECT_EQ(outcome.exit_code, exit_code);
    EXPECT_THAT(outcome.output, HasSubstr(reason));
    const std::size_t error = outcome.output.find("dtof: error:");
    ASSERT_NE(error, std::string::npos) << outcome.output;
    EXPECT_EQ(std::ranges::count(outcome.output.substr(error), '\n'), 1);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  };
  refused("PATH=/nowhere", "none is built: verilator does not run here");
  refused("CXX=/nowhere/c++", "none is built: no C++ compiler runs here");
  refused("DTOF_CACHE=off", "none is built: DTOF_CACHE is off");
  refused("DTOF_CACHE=/proc/none", "/proc/none: cannot make the folder");
  const std::string bin =
      with_program("verilator", "[ \"$1\" = --version ] && echo 'Verilator 4.038 2020-07-11' && exit\n");
  refused(fmt::format("PATH={}:$PATH", bin),
          "but verilator is Verilator 4.038 2020-07-11: build the program again");
  // Files of at most some blocks: what a full disk does.
  refused("trap '' XFSZ; ulimit -f 20;", "cannot write: File too large", 4);
  const std::string full = with_program(
      "full-c++",
      "[ \"$1\" = --version ] && echo full && exit\n"
      "echo 'model.cc: warning: error-like words'; echo 'as: No space left on device'; exit 1\n");
  refused(fmt::format("CXX={}/full-c++", full), "full-c++ failed: as: No space left on device");
}

}  // namespace
}  // namespace dtof
