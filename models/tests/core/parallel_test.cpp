// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/parallel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::StrEq;
using testing::ThrowsMessage;

TEST(ParallelFor, EveryIndexOnce) {
  for (const int threads : {0, 1, 2, 8}) {
    std::vector<std::atomic<int>> calls(1000);
    parallel_for(calls.size(), threads, [&calls](std::size_t index) { ++calls[index]; });
    EXPECT_TRUE(std::ranges::all_of(calls, [](const std::atomic<int>& count) { return count == 1; }))
        << threads;
  }
}

TEST(ParallelFor, NothingToDo) {
  parallel_for(0, 2, [](std::size_t /*index*/) { FAIL() << "called for an empty range"; });
}

TEST(ParallelFor, OneThreadStaysOnOneThread) {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  parallel_for(200, 1, [&](std::size_t /*index*/) {
    const std::scoped_lock lock(mutex);
    threads.insert(std::this_thread::get_id());
  });
  EXPECT_EQ(threads.size(), 1U);
}

TEST(ParallelFor, ExceptionsReachTheCaller) {
  for (const int threads : {1, 2, 8}) {
    EXPECT_THAT(
        [threads] {
          parallel_for(1000, threads, [](std::size_t index) {
            if (index == 321) {
              throw InputError("column 321 is bad");
            }
          });
        },
        ThrowsMessage<InputError>(StrEq("column 321 is bad")));
  }
}

TEST(ParallelFor, ExceptionsStopTheRest) {
  std::atomic<int> calls = 0;
  EXPECT_THROW(parallel_for(1000000, 2,
                            [&calls](std::size_t /*index*/) {
                              ++calls;
                              throw std::runtime_error("first");
                            }),
               std::runtime_error);
  EXPECT_LT(calls, 1000);
}

TEST(HardwareThreads, AtLeastOne) { EXPECT_GE(hardware_threads(), 1); }

}  // namespace
}  // namespace dtof
