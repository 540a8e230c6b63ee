// SPDX-License-Identifier: Apache-2.0
#include "core/progress.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include "core/error.hpp"
#include "core/parallel.hpp"

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

TEST(Interruption, NoneWithoutASignal) { EXPECT_NO_THROW(check_interruption()); }

}  // namespace
}  // namespace dtof
