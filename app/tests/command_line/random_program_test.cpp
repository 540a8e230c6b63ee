// SPDX-License-Identifier: Apache-2.0
// dtof-random: JSON result, man page, completion, errors.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
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

class RandomProgram : public test::IoTest {
 protected:
  [[nodiscard]] Outcome run(const std::string& arguments) const {
    return run_shell(
        fmt::format("cd '{}' && DTOF_CACHE=cache {} {}", path("").string(), DTOF_RANDOM_PROGRAM, arguments));
  }
};

TEST_F(RandomProgram, AnArrayIsARowOfTheObject) {
  const Outcome outcome = run("--first 2 --count 1 --out r --json 2> said.txt");
  ASSERT_EQ(outcome.exit_code, 0) << contents(path("said.txt"));
  const nlohmann::json object = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(object.at("command"), "dtof-random");
  EXPECT_EQ(object.at("command_line"), "dtof-random --first 2 --count 1 --out r --json");
  EXPECT_EQ(object.at("files").get<std::vector<std::string>>(),
            (std::vector<std::string>{"configurations.toml", "table.csv", "table.md"}));
  const nlohmann::json& rows = object.at("tables").at("table.csv");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].at("array"), 2);
  EXPECT_EQ(rows[0].at("frames"), 7);
  EXPECT_GT(rows[0].at("clocks"), 0);
  EXPECT_EQ(rows[0].at("equal to the model"), "yes");
  EXPECT_THAT(contents(path("said.txt")), HasSubstr("none differ from the model"));
  EXPECT_THAT(contents(path("r/table.md")), HasSubstr(rows[0].at("parameters").get<std::string>()));
}

TEST_F(RandomProgram, HasTheTextsOfTheOthers) {
  EXPECT_THAT(run("--man").output, AllOf(HasSubstr(".TH"), HasSubstr("seed")));
  EXPECT_THAT(run("--completion bash").output, AllOf(HasSubstr("dtof-random"), HasSubstr("--seed")));
  EXPECT_EQ(run("--version").output.find("dtof-random "), 0U);
  EXPECT_THAT(run("--help").output, AllOf(HasSubstr("--json"), HasSubstr("Exit codes:")));
}

TEST_F(RandomProgram, RefusesInOneLineWithoutAnObject) {
  const Outcome option = run("--json --sed 3");
  EXPECT_EQ(option.exit_code, 1);
  EXPECT_EQ(option.output,
            "dtof-random: error: unknown option '--sed'; did you mean '--seed'? `dtof-random --help` lists "
            "the options\n");
}

}  // namespace
}  // namespace dtof
