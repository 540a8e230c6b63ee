// SPDX-License-Identifier: Apache-2.0
// The result of every command as JSON, apart from what is for people.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/io/io_test_support.hpp"
#include "tests/run_shell.hpp"

namespace dtof {
namespace {

using test::Outcome;
using test::run_shell;

using ::testing::HasSubstr;

constexpr const char* kSmall = "--array-columns 6 --array-rows 5 --acquisitions 200 -r sifh,poolpointer";

class JsonCommand : public test::IoTest {
 protected:
  [[nodiscard]] Outcome run(const std::string& arguments) const {
    return run_shell(fmt::format("cd '{}' && {} {}", path("").string(), DTOF_PROGRAM, arguments));
  }
  /// What stands on standard output alone.
  [[nodiscard]] nlohmann::json json(const std::string& arguments) const {
    const Outcome outcome = run(arguments + " --json 2> said.txt");
    EXPECT_EQ(outcome.exit_code, 0) << arguments << contents(path("said.txt"));
    return nlohmann::json::parse(outcome.output);
  }
};

TEST_F(JsonCommand, EveryCommandHasOneObject) {
  ASSERT_EQ(run(fmt::format("frame {} --record s.csv --out first", kSmall)).exit_code, 0);
  const std::map<std::string, std::string> calls = {
      {"frame", fmt::format("{} --out f", kSmall)},
      {"replay", "s.csv -r sifh --out r"},
      {"convert", "s.csv h.npz"},
      {"video", fmt::format("{} --frames 2 --out v", kSmall)},
      {"sensor", "tmf8829"},
      {"design", "--sensor thesis --frames 2 --scenes room --out d"},
      {"product", "--sensor thesis --readout sifh --vector-acquisitions 4 --out p"},
      {"list", ""}};
  const std::string help = run("--help").output;
  const std::string commands =
      help.substr(help.find("Subcommands:"), help.find("Try:") - help.find("Subcommands:"));
  std::size_t known = 0;
  for (std::size_t at = commands.find("\n  "); at != std::string::npos; at = commands.find("\n  ", at + 1)) {
    known += commands[at + 3] == ' ' ? 0 : 1;
  }
  EXPECT_EQ(known, calls.size()) << commands;
  for (const auto& [command, arguments] : calls) {
    SCOPED_TRACE(command);
    if (command == "design") {  // takes minutes; its option is the others'
      EXPECT_THAT(run("design --help").output, HasSubstr("--json"));
      continue;
    }
    const nlohmann::json object = json(command + " " + arguments);
    EXPECT_EQ(object.at("command"), command);
    EXPECT_THAT(object.at("command_line").get<std::string>(), HasSubstr("dtof " + command));
    EXPECT_NE(contents(path("said.txt")), "") << "what is for people is still said";
    if (object.contains("files")) {
      EXPECT_GT(object.at("files").size(), 0U);
      for (const auto& file : object.at("files")) {
        EXPECT_TRUE(
            std::filesystem::exists(path(object.at("out").get<std::string>()) / file.get<std::string>()));
      }
    }
  }
}

TEST_F(JsonCommand, AFramesFiguresAreThoseOfItsSummaryAndItsFilesTheSame) {
  ASSERT_EQ(run(fmt::format("frame {} --out plain", kSmall)).exit_code, 0);
  const nlohmann::json object = json(fmt::format("frame {} --out out_json", kSmall));
  const std::string summary = contents(path("plain/summary.csv"));
  EXPECT_EQ(contents(path("out_json/summary.csv")), summary);
  ASSERT_EQ(object.at("readouts").size(), 2U);
  for (const auto& readout : object.at("readouts")) {
    const std::string name = readout.at("readout");
    EXPECT_TRUE(readout.at("cycles").is_null());  // models have none
    EXPECT_EQ(contents(path("out_json") / (name + ".csv")), contents(path("plain") / (name + ".csv")));
    EXPECT_THAT(summary, HasSubstr(fmt::format("{},{:.0f},{:.0f},", readout.at("title").get<std::string>(),
                                               readout.at("rmse_m").get<double>() * 1e3,
                                               readout.at("bias_m").get<double>() * 1e3)));
    EXPECT_THAT(summary, HasSubstr(fmt::format("{:.2f} %",
                                               readout.at("share_above_3_percent").get<double>() * 100.0)));
  }
}

TEST_F(JsonCommand, TheListNamesWhatItPrints) {
  const nlohmann::json object = json("list");
  const std::string printed = contents(path("said.txt"));
  for (const char* kind : {"readouts", "presets", "conditions", "scenes"}) {
    EXPECT_FALSE(object.at(kind).empty()) << kind;
    for (const auto& one : object.at(kind)) {
      EXPECT_THAT(printed, HasSubstr("\n  " + one.at("name").get<std::string>() + " ")) << kind;
    }
  }
  for (const char* kind : {"hardware", "subsystems"}) {
    for (const auto& one : object.at(kind)) {
      EXPECT_THAT(printed, HasSubstr("\n  " + one.get<std::string>() + "\n")) << kind;
    }
  }
  EXPECT_FALSE(object.at("hardware").empty());
}

TEST_F(JsonCommand, EveryStudyHasTheOption) {
  const auto study = [&](const std::string& arguments) {
    return run_shell(fmt::format("cd '{}' && {} {}", path("").string(), DTOF_STUDY_PROGRAM, arguments));
  };
  const std::string help = study("--help").output;
  std::istringstream commands(help.substr(help.find("Subcommands:"), help.find("Try:") - help.find("Sub")));
  std::size_t known = 0;
  for (std::string line; std::getline(commands, line);) {
    if (line.starts_with("  ") && line[2] != ' ') {
      const std::string command = line.substr(2, line.find(' ', 2) - 2);
      EXPECT_THAT(study(command + " --help").output, HasSubstr("--json")) << command;
      ++known;
    }
  }
  EXPECT_GE(known, 18U);
  const Outcome outcome = study(
      "accuracy -r sifh --distances 1 2 --frames 4 --calibration-frames 2 --acquisitions 100 --out c --json "
      "2> said.txt");
  ASSERT_EQ(outcome.exit_code, 0) << contents(path("said.txt"));
  const auto object = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(object.at("command"), "accuracy");
  EXPECT_EQ(object.at("out"), "c");
  for (const auto& [name, rows] : object.at("tables").items()) {
    const std::string table = contents(path("c") / name);
    EXPECT_EQ(static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')), rows.size() + 1);
  }
  const auto& accuracy = object.at("tables").at("accuracy.csv");
  ASSERT_EQ(accuracy.size(), 4U) << "two distances, by sifh and by the matched filter";
  EXPECT_EQ(accuracy[1].at("distance_m"), 2);
  EXPECT_EQ(accuracy[1].at("readout"), "sifh");
  EXPECT_NE(contents(path("said.txt")), "") << "what is for people is still said";
}

TEST_F(JsonCommand, ARefusalHasNoObject) {
  const Outcome outcome = run("frame --sensor thesys --json 2> said.txt");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.output, "");
  EXPECT_THAT(contents(path("said.txt")), HasSubstr("did you mean 'thesis'"));
}

}  // namespace
}  // namespace dtof
