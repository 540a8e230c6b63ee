// SPDX-License-Identifier: Apache-2.0
// What the program says of itself: version, completion, man page, beside its help.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/io/io_test_support.hpp"
#include "tests/run_shell.hpp"

namespace dtof {
namespace {

using test::Outcome;
using test::run_shell;

using ::testing::AllOf;
using ::testing::HasSubstr;

class TextsCommand : public test::IoTest {
 protected:
  [[nodiscard]] Outcome dtof(const std::string& arguments) const {
    return run_shell(fmt::format("cd '{}' && {} {}", path("").string(), DTOF_PROGRAM, arguments));
  }
  /// Names that begin the lines of a help page, "-r" and "--readout" of "  -r,--readout TEXT".
  [[nodiscard]] std::set<std::string> help_options(const std::string& command) const {
    std::set<std::string> names;
    std::istringstream help(dtof(command + " --help").output);
    for (std::string line; std::getline(help, line);) {
      std::smatch found;
      if (std::regex_search(line, found, std::regex("^ {2,4}(-[-a-z0-9,]+)"))) {
        std::istringstream all(found[1]);
        for (std::string name; std::getline(all, name, ',');) {
          names.insert(name);
        }
      }
    }
    return names;
  }
  [[nodiscard]] std::vector<std::string> help_commands() const {
    std::vector<std::string> names;
    std::istringstream help(dtof("--help").output);
    bool here = false;
    for (std::string line; std::getline(help, line);) {
      here = (here || line == "Subcommands:") && !line.empty();
      std::smatch found;
      if (here && std::regex_search(line, found, std::regex("^  ([a-z]+) "))) {
        names.push_back(found[1]);
      }
    }
    return names;
  }
  /// What bash offers behind these words, the last of which is being typed.
  [[nodiscard]] std::set<std::string> completed(const std::vector<std::string>& words) const {
    std::string line;
    for (const std::string& word : words) {
      line += fmt::format("'{}' ", word);
    }
    const Outcome outcome = run_shell(fmt::format(
        "bash -c 'set -eu; source <({} --completion bash); COMP_WORDS=(dtof {}); COMP_CWORD={}; _dtof; "
        "printf \"%s\\n\" \"${{COMPREPLY[@]}}\"'",
        DTOF_PROGRAM, std::regex_replace(line, std::regex("'"), "\""), words.size()));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    std::istringstream offered(outcome.output);
    std::set<std::string> found;
    for (std::string word; std::getline(offered, word);) {
      found.insert(word);
    }
    return found;
  }
};

TEST_F(TextsCommand, VersionHasAFormForReports) {
  const std::string line = dtof("--version").output;
  for (const char* const order : {"--version --json", "--json --version"}) {
    const Outcome outcome = dtof(order);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    const auto json = nlohmann::json::parse(outcome.output);
    EXPECT_EQ(
        fmt::format("{} {}\n", json.at("program").get<std::string>(), json.at("version").get<std::string>()),
        line);
    EXPECT_GE(json.at("cplusplus").get<long>(), 202002L);
    for (const char* const key : {"compiler", "build_type", "system", "machine"}) {
      EXPECT_NE(json.at(key).get<std::string>(), "") << key;
    }
    EXPECT_GE(json.at("processors").get<int>(), 1);
  }
  EXPECT_EQ(dtof("--json").exit_code, 1);
}

TEST_F(TextsCommand, CompletionOffersWhatHelpShows) {
  const std::vector<std::string> commands = help_commands();
  EXPECT_GE(commands.size(), 8U);
  std::set<std::string> first = help_options("");
  first.insert(commands.begin(), commands.end());
  EXPECT_EQ(completed({""}), first);
  for (const std::string& command : commands) {
    EXPECT_EQ(completed({command, "-"}), help_options(command)) << command;
  }
  EXPECT_EQ(completed({"frame", "--engine", "m"}), std::set<std::string>{"model"});
  EXPECT_EQ(completed({"frame", "--scene", "room", "--table", ""}), (std::set<std::string>{"flat", "none"}));
  EXPECT_EQ(completed({"frame", "--readout", "his"}),
            (std::set<std::string>{"hispointer", "hispointer1", "histogram"}));
  EXPECT_EQ(completed({"design", "--sensor", "tm"}), std::set<std::string>{"tmf8829"});
  EXPECT_EQ(dtof("--completion fish").exit_code, 1);
}

TEST_F(TextsCommand, ManPageHasEveryOption) {
  const Outcome outcome = dtof("--man > dtof.1");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const std::string page = contents(path("dtof.1"));
  const auto escaped = [](const std::string& text) {
    return std::regex_replace(text, std::regex("-"), "\\-");
  };
  EXPECT_THAT(page, HasSubstr(".TH DTOF 1"));
  for (const std::string& command : help_commands()) {
    const std::size_t begin = page.find(fmt::format(".SS dtof {}\n", command));
    ASSERT_NE(begin, std::string::npos) << command;
    const std::string section = page.substr(begin, page.find("\n.S", begin + 1) - begin);
    for (const std::string& option : help_options(command)) {
      EXPECT_TRUE(std::regex_search(
          section,
          std::regex("\\\\fB[^\n]*" + std::regex_replace(escaped(option), std::regex(R"(\\)"), R"(\\)") +
                     "(,|\\\\fR)")))
          << command << " " << option;
    }
  }
  if (run_shell("command -v groff").exit_code == 0) {
    EXPECT_EQ(
        run_shell(fmt::format("groff -man -Tutf8 -ww '{}' > /dev/null", path("dtof.1").string())).output, "");
  }
}

}  // namespace
}  // namespace dtof
