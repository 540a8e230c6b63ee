// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/io/atomic_file.hpp"
#include "tests/run_shell.hpp"

namespace dtof::test {

/// The program that has the command with which the arguments begin.
inline std::string_view program_of(std::string_view arguments) {
  constexpr std::array<std::string_view, 15> kStudies = {
      "claims",    "page",     "dynamic-range", "hostile-scenes", "frames",
      "enlarge",   "accuracy", "coverage",      "fidelity",       "measured",
      "reproduce", "scenes",   "walk",          "sensor-effects", "speed-error"};
  const std::string_view command = arguments.substr(0, arguments.find(' '));
  return std::ranges::find(kStudies, command) != kStudies.end() ? DTOF_STUDY_PROGRAM : DTOF_PROGRAM;
}

/// Runs the programs in a folder of its own.
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

  /// Exit code 1 (bad input) or another, and exactly one line, which holds `reason`; no output folder is
  /// filled.
  void expect_refused(const std::string& arguments, const std::string& reason, int exit_code = 1) const {
    SCOPED_TRACE(arguments);
    const Outcome outcome = dtof(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code);
    EXPECT_THAT(outcome.output, ::testing::HasSubstr(reason));
    EXPECT_THAT(outcome.output,
                ::testing::StartsWith(program_of(arguments) == DTOF_PROGRAM ? "dtof: error: "
                                                                            : "dtof-study: error: "));
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "summary.csv"));
  }

 private:
  std::filesystem::path folder_;
};

inline const std::string kSmallScene = "--array-columns 6 --array-rows 5 --acquisitions 300";

/// Cell of a CSV whose lines begin with the row's name: column `column` of the row that begins with `row`.
inline std::string csv_cell(const std::string& csv, const std::string& row, const std::string& column) {
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

}  // namespace dtof::test
