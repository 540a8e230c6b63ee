// SPDX-License-Identifier: Apache-2.0
#include "on_demand/tool_run.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace dtof {
namespace {

std::optional<ToolRun> shell(const std::string& script, const std::filesystem::path& folder = {}) {
  const std::vector<std::string> command = {"sh", "-c", script};
  return run_tool(command, folder);
}

TEST(ToolRun, HasBothOutputsAndTheExitCode) {
  const auto run = shell("echo one; echo two >&2; exit 3");
  ASSERT_TRUE(run.has_value());
  EXPECT_EQ(run->output, "one\ntwo\n");
  EXPECT_EQ(run->exit_code, 3);
  EXPECT_EQ(shell("kill -9 $$")->exit_code, 128 + 9);
}

TEST(ToolRun, RunsInTheFolder) { EXPECT_EQ(shell("pwd", "/usr")->output, "/usr\n"); }

TEST(ToolRun, HasNothingOfAProgramThatIsNotThere) {
  const std::vector<std::string> command = {"no-such-program-of-dtof"};
  EXPECT_FALSE(run_tool(command, {}).has_value());
}

TEST(ToolRun, KeepsTheFirstMegabyte) {
  const auto run = shell("head -c 3000000 /dev/zero; exit 0");
  EXPECT_GE(run->output.size(), 1U << 20U);
  EXPECT_LT(run->output.size(), (1U << 20U) + 4096U);
  EXPECT_EQ(run->exit_code, 0);
}

}  // namespace
}  // namespace dtof
