// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/progress.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <thread>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"

namespace dtof {
namespace {

TEST(Progress, SilentWhereStandardErrorIsNoTerminal) {
  testing::internal::CaptureStderr();
  {
    Progress progress("columns", 2);
    parallel_for(2, 2, [&progress](std::size_t /*index*/) { progress.advance(); });
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Progress, WritesALineAnIntervalWhereStandardErrorIsNoTerminal) {
  testing::internal::CaptureStderr();
  {
    Progress progress("columns", 4, std::chrono::seconds(0));
    progress.advance();
    progress.advance(3);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "columns 25 %\ncolumns 100 %\n");
}

TEST(Progress, TheIntervalIsTheWholeProgramsNotEachWorks) {
  constexpr auto kInterval = std::chrono::milliseconds(200);
  testing::internal::CaptureStderr();
  const auto start = std::chrono::steady_clock::now();
  int works = 0;
  while (std::chrono::steady_clock::now() - start < 2 * kInterval) {
    Progress progress("short work", 1, kInterval);
    progress.advance();
    ++works;
  }
  const std::string log = testing::internal::GetCapturedStderr();
  const auto lines = std::count(log.begin(), log.end(), '\n');
  EXPECT_GE(lines, 1);
  EXPECT_LE(lines, 3);
  EXPECT_GT(works, 3);
}

TEST(Progress, TheTimeLeftIsThatOfTheRestAtTheSameSpeed) {
  using std::chrono::seconds;
  EXPECT_EQ(progress_text("rows", 0, 10, seconds(9)), "rows 0 %");
  EXPECT_EQ(progress_text("rows", 1, 10, std::chrono::milliseconds(999)), "rows 10 %");
  EXPECT_EQ(progress_text("rows", 2, 10, seconds(10)), "rows 20 %, 40 s left");
  EXPECT_EQ(progress_text("rows", 1, 3, seconds(60)), "rows 33 %, 2 min left");
  EXPECT_EQ(progress_text("rows", 1, 100, seconds(100)), "rows 1 %, 2 h 45 min left");
  EXPECT_EQ(progress_text("rows", 10, 10, seconds(60)), "rows 100 %, 0 s left");
}

// The flag stays set for the rest of the process, so the signal is raised in a child.
[[noreturn]] void interrupt_parallel_work(int signal) {
  install_interruption_handler();
  int calls = 0;
  try {
    parallel_for(100, 1, [&calls, signal](std::size_t /*index*/) {
      if (++calls == 10) {
        static_cast<void>(std::raise(signal));
      }
    });
  } catch (const Interrupted&) {
    std::_Exit(calls);
  }
  std::_Exit(0);
}

TEST(InterruptionDeathTest, SignalsStopParallelWorkAfterTheCurrentIndex) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(interrupt_parallel_work(SIGINT), testing::ExitedWithCode(10), "");
  EXPECT_EXIT(interrupt_parallel_work(SIGTERM), testing::ExitedWithCode(10), "");
}

TEST(Progress, AnObserverReplacesStandardError) {
  testing::internal::CaptureStderr();
  std::size_t last = 0;
  int calls = 0;
  {
    Progress progress(100, [&](std::size_t done, std::size_t total) {
      EXPECT_EQ(total, 100U);
      EXPECT_EQ(done, last + 1);  // one after the other
      last = done;
      ++calls;
    });
    parallel_for(100, 2, [&progress](std::size_t /*index*/) { progress.advance(); });
  }
  EXPECT_EQ(calls, 100);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Interruption, AFlagStopsTheWorkOfItsScopeAlone) {
  const std::atomic<bool> stop = true;
  int bodies = 0;
  const auto work = [&] { parallel_for(4, 2, [](std::size_t /*index*/) { check_interruption(); }); };
  {
    const StopScope scope(&stop);
    EXPECT_THROW(check_interruption(), Interrupted);
    EXPECT_THROW(work(), Interrupted);
    EXPECT_THROW(parallel_for(4, 2, [&](std::size_t /*index*/) { ++bodies; }), Interrupted);
  }
  EXPECT_EQ(bodies, 0);
  EXPECT_NO_THROW(check_interruption());
  EXPECT_NO_THROW(work());
}

TEST(Interruption, TheFlagGoesWithTheWorkToItsThreads) {
  const std::atomic<bool> stop = false;
  std::atomic<int> with_flag = 0;
  const StopScope scope(&stop);
  parallel_for(50, 4, [&](std::size_t /*index*/) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // so that others take a share
    with_flag += StopScope::flag() == &stop ? 1 : 0;
  });
  EXPECT_EQ(with_flag, 50);
}

TEST(Interruption, NoneWithoutASignal) { EXPECT_NO_THROW(check_interruption()); }

}  // namespace
}  // namespace dtof
