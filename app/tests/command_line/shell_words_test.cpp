// SPDX-License-Identifier: Apache-2.0
#include "command_line/shell_words.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/run_shell.hpp"

namespace dtof {
namespace {

TEST(ShellWord, PlainWordsStayAsTheyAre) {
  for (const char* word : {"--depth", "a/b-c_d.npy", "0,2-3", "a=b", "1e+3", "50%", "x:y@z"}) {
    EXPECT_EQ(shell_word(word), word);
  }
}

TEST(ShellWord, OthersAreQuoted) {
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("a b&c.npy"), "'a b&c.npy'");
  EXPECT_EQ(shell_word("it's"), R"('it'\''s')");
  EXPECT_EQ(shell_word("m\u00fcng"), "'m\u00fcng'");
  EXPECT_EQ(shell_word("mess\xfcng.npy"), R"($'mess\374ng.npy')");
  EXPECT_EQ(shell_word("two\nlines\\'"), R"($'two\012lines\\\'')");
}

TEST(ShellCommand, TheNumberOfThreadsCanBeLeftOut) {
  const auto left = [](const auto& words) { return without_threads(shell_command("dtof", words)); };
  EXPECT_EQ(left(std::array{"frame", "--threads", "2", "--seed", "3"}), "dtof frame --seed 3");
  EXPECT_EQ(left(std::array{"frame", "-j", "2"}), "dtof frame");
  EXPECT_EQ(left(std::array{"frame", "-j2", "--threads=4", "--out", "a"}), "dtof frame --out a");
  const std::array quoted = {"frame", "a -j 3", "it's -j 3 \xfc", "it's -j 4"};
  EXPECT_EQ(left(quoted), shell_command("dtof", quoted));
}

TEST(ShellCommand, AShellTakesTheWordsBack) {
  const std::array<const char*, 7> words = {"plain", "a b", "it's", "$HOME", "`x`", "a\\b\xfc\n'!", "*"};
  const std::filesystem::path script = std::filesystem::path(::testing::TempDir()) / "dtof_shell_words.sh";
  std::ofstream(script, std::ios::binary)
      << shell_command("printf", std::array{"%s\\0"}) << shell_command("", words);
  const std::string output = test::run_shell("bash " + shell_word(script.string())).output;
  std::filesystem::remove(script);
  std::string expected;
  for (const char* word : words) {
    expected += word;
    expected += '\0';
  }
  EXPECT_EQ(output, expected);
}

}  // namespace
}  // namespace dtof
