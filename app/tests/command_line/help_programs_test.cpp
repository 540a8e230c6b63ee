// SPDX-License-Identifier: Apache-2.0
// What the programs say about themselves.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/scene/scene.hpp"
#include "tests/command_line/programs.hpp"

namespace dtof {
namespace {

using test::kSmallScene;
using test::Outcome;
using test::Programs;

using ::testing::HasSubstr;

TEST_F(Programs, HelpTeaches) {
  const Outcome outcome = dtof("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output, HasSubstr("dtof frame --scene room"));
  const Outcome frame = dtof("frame --help");
  EXPECT_EQ(frame.exit_code, 0);
  for (const Scene scene : kAllScenes) {
    EXPECT_THAT(frame.output.substr(frame.output.find("--scene"), 200), HasSubstr(scene_name(scene)));
  }
}

TEST_F(Programs, ListNamesReadoutsPresetsScenesAndHardware) {
  const Outcome outcome = dtof("list");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* word : {"hispointer1", "threesteps", "phone", "room", "PIXELS_PER_SRAM=160"}) {
    EXPECT_THAT(outcome.output, HasSubstr(word));
  }
}

TEST_F(Programs, TheVersionIsOneInTheWholeTree) {
  const Outcome outcome = dtof("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output, ::testing::MatchesRegex("dtof [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  const std::string version = outcome.output.substr(5, outcome.output.size() - 6);
  EXPECT_THAT(read_file(DTOF_CORE_FILE), HasSubstr("dtof_array:" + version + "\n"));
  EXPECT_THAT(read_file(DTOF_CITATION_FILE), HasSubstr("\nversion: " + version + "\n"));
}

TEST_F(Programs, TheCommandOnAPageRunsInAShell) {
  write_npy(path("a b&c.npy"), std::vector<std::size_t>{2, 2}, std::vector<double>{1.0, 1.5, 2.0, 2.5});
  ASSERT_EQ(dtof("frame -r ezpointer --table none --depth 'a b&c.npy' --out 'x y' " + kSmallScene).exit_code,
            0);
  const std::string page = read_file(path("x y/summary.md"));
  const std::size_t begin = page.find("Command: `dtof ") + std::string_view("Command: `dtof ").size();
  const std::string arguments = page.substr(begin, page.find('`', begin) - begin);
  EXPECT_THAT(arguments, HasSubstr("--depth 'a b&c.npy' --out 'x y'"));
  std::filesystem::rename(path("x y"), path("first"));
  ASSERT_EQ(dtof(arguments).exit_code, 0);
  EXPECT_EQ(read_file(path("x y/summary.md")), page);
}

TEST_F(Programs, ASensorFileMayBeginWithAByteOrderMark) {
  const Outcome preset = dtof("sensor thesis");
  const Outcome marked = dtof("sensor " + file("marked.toml", "\xEF\xBB\xBF" + preset.output));
  EXPECT_EQ(marked.exit_code, 0) << marked.output;
  EXPECT_THAT(marked.output, HasSubstr("# What follows:"));
}

}  // namespace
}  // namespace dtof
