// SPDX-License-Identifier: Apache-2.0
#include "command_line/folder_result.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command_line/command_line.hpp"
#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(CsvRows, AreObjectsOfNumbersAndTexts) {
  EXPECT_EQ(csv_rows("name,count,share\na,3,0.25\n\"b, c\",-1,\n\"d \"\"e\"\"\",12 %,nan\n").dump(),
            R"([{"name":"a","count":3,"share":0.25},{"name":"b, c","count":-1,"share":null},)"
            R"({"name":"d \"e\"","count":"12 %","share":"nan"}])");
  EXPECT_EQ(csv_rows("a,b\r\n1,2").dump(), R"([{"a":1,"b":2}])");
  EXPECT_EQ(csv_rows("a\n").dump(), "[]");
  EXPECT_EQ(csv_rows("").dump(), "[]");
}

/// A program without commands, as dtof-faults is.
class OneCommand : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static Program program() {
    return {.name = "dtof-one",
            .description = "dtof-one: writes a table.",
            .examples = "",
            .add_commands = [](CLI::App& app, const std::string& command_line) {
              static std::string out;
              static std::string mode;
              app.add_option("-o,--out", out, "output folder");
              app.add_option("--mode", mode, "what to do")->check(CLI::IsMember({"write", "fail"}));
              add_folder_results(app, command_line, [] {
                if (mode == "fail") {
                  throw InputError("asked to fail");
                }
                std::ofstream(out + "/table.csv") << "a,b\n1,x\n";
                std::cout << "for people\n" << std::flush;
              });
            }};
  }
  /// Standard output of the program.
  [[nodiscard]] std::string run(std::vector<const char*> arguments, int exit_code = 0) const {
    arguments.insert(arguments.begin(), "dtof-one");
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_program(program(), static_cast<int>(arguments.size()), arguments.data()), exit_code);
    return testing::internal::GetCapturedStdout();
  }

  std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "dtof_one_command";
};

TEST_F(OneCommand, HasTheTablesThatItWrote) {
  const std::string out = folder_.string();
  std::ofstream(folder_ / "older.csv") << "a\n1\n";
  std::filesystem::last_write_time(folder_ / "older.csv",
                                   std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  EXPECT_EQ(run({"--out", out.c_str()}), "for people\n");
  const auto object = nlohmann::json::parse(run({"--out", out.c_str(), "--json"}));
  EXPECT_EQ(object.at("command"), "dtof-one");
  EXPECT_EQ(object.at("out"), out);
  EXPECT_EQ(object.at("files").dump(), R"(["table.csv"])");
  EXPECT_EQ(object.at("tables").dump(), R"({"table.csv":[{"a":1,"b":"x"}]})");
  EXPECT_EQ(run({"--out", out.c_str(), "--json", "--mode", "fail"}, 1), "");
}

TEST_F(OneCommand, SaysWhatItIs) {
  EXPECT_THAT(run({"--version", "--json"}), HasSubstr("\"program\": \"dtof-one\""));
  EXPECT_THAT(run({"--help"}), AllOf(HasSubstr("--mode"), HasSubstr("--json")));
  EXPECT_THAT(run({"--man"}),
              AllOf(HasSubstr("\\fBdtof\\-one\\fR [\\fIOPTIONS\\fR]"), Not(HasSubstr(".SH COMMANDS"))));
  EXPECT_THAT(run({"--completion", "bash"}), HasSubstr("--mode) COMPREPLY=($(compgen -W \"write fail\""));
  EXPECT_EQ(run({"--mood", "x"}, 1), "");
}

}  // namespace
}  // namespace dtof
