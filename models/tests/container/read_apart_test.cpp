// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/read_apart.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;

TEST(ReadApart, GivesTheAnswerOfTheOtherProcess) {
  std::vector<double> values(3'000'000);  // more than a pipe holds
  std::iota(values.begin(), values.end(), 0.0);
  const pid_t own = ::getpid();
  const ReadAnswer answer = read_apart("a", [&] {
    return ReadAnswer{.sizes = {7, ::getpid() == own ? 1U : 0U}, .values = values, .names = {"", "second"}};
  });
  EXPECT_THAT(answer.sizes, ElementsAre(7, 0));
  EXPECT_EQ(answer.values, values);
  EXPECT_THAT(answer.names, ElementsAre("", "second"));
}

TEST(ReadApart, ACrashIsARefusal) {
  testing::internal::CaptureStderr();
  for (const int signal : {SIGSEGV, SIGABRT, SIGKILL}) {
    test::expect_input_error(
        [&] {
          (void)read_apart("a", [&]() -> ReadAnswer {
            std::fputs("last words\n", stderr);
            std::raise(signal);
            return {};
          });
        },
        "a: damaged: the library that reads such files ended without an answer");
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  test::expect_input_error(
      [] { (void)read_apart("a", []() -> ReadAnswer { throw InputError("a: its own"); }); }, "a: its own");
}

TEST(ReadApart, PiecesComeInOrderUntilAnEnd) {
  constexpr std::uint64_t kPieces = 300;
  std::vector<std::uint64_t> taken;
  read_pieces_apart(
      "a",
      [](const GivePiece& give) {
        for (std::uint64_t piece = 0; piece < kPieces; ++piece) {
          give(ReadPiece(10'000, piece));
        }
      },
      [&](const ReadPiece& piece) {
        ASSERT_EQ(piece.size(), 10'000U);
        taken.push_back(piece.back());
      });
  std::vector<std::uint64_t> expected(kPieces);
  std::iota(expected.begin(), expected.end(), 0U);
  EXPECT_EQ(taken, expected);
}

TEST(ReadApart, ACrashBetweenPiecesIsARefusal) {
  std::size_t taken = 0;
  const auto read = [&](const std::function<void()>& end) {
    read_pieces_apart(
        "a",
        [&](const GivePiece& give) {
          give({1, 2});
          end();
        },
        [&](const ReadPiece& /*piece*/) { ++taken; });
  };
  test::expect_input_error([&] { read([] { std::raise(SIGKILL); }); },
                           "a: damaged: the library that reads such files ended without an answer");
  test::expect_input_error([&] { read([] { throw InputError("a: its own"); }); }, "a: its own");
  EXPECT_EQ(taken, 2U);
}

}  // namespace
}  // namespace dtof
